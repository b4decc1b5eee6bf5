#pragma once
/// \file
/// Problem: a minimisation problem, stated: mesh, fields, energies and loads, boundary data, load steps, solver, what is measured and written. Problem files, C++
/// programs (karcher/karcher.hpp) and other languages fill it; discrete_problem.hpp builds it on its mesh, run.hpp solves it.
///
/// Data are functions of the mesh point and the load parameter. Names of regions are resolved when the mesh is there. Places say where something was stated, for
/// messages; problems that were not read from a file have none.

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/energy/energy_info.hpp"
#include "karcher/field/field.hpp"
#include "karcher/math/dual.hpp"
#include "karcher/place.hpp"
#include "karcher/solve/continuation.hpp"

namespace karcher {

/// A point of the mesh at which data are asked for.
struct MeshPoint {
  Vec3<double> x;
  Vec3<double> normal;  ///< of a surface (Orientation), where the data ask for it; else 0
  operator const Vec3<double>&() const { return x; }
};

/// A map into a manifold: initial and boundary values, exact solutions.
struct PointFunction {
  /// Writes the ambient coordinates of the point. \throws InputError where there is none
  std::function<void(const MeshPoint& s, double t, double* point)> value;
  bool depends_on_t = false, asks_for_normal = false;
  /// ManifoldOps::error_coordinates with their derivatives in x, y, z: of exact solutions.
  std::function<std::vector<Dual<double, 3>>(const Vec3<double>& x, double t)> with_derivatives;

  explicit operator bool() const { return static_cast<bool>(value); }
};

struct MeshSpec {
  Place place;
  std::function<Mesh()> make;
  int refine = 0;  ///< times
};

struct RegionSpec {
  std::string name;
  Place place{};
  int dim = 0;
  bool boundary = false;
  std::function<bool(const Vec3<double>&)> where{};
  std::optional<Vec3<double>> near{};  ///< instead of `where`, with dim 0: the node nearest to this point
};

/// The stress-free configuration, where it is not the mesh.
struct ReferenceSpec {
  std::function<Vec3<double>(const Vec3<double>&)> position;  ///< of the mesh point; empty: the mesh itself
  int order = 0;                                              ///< of its Lagrange interpolant; 0: the deformation's, else 2
};

/// A load step of earlier results that a field starts from.
struct StartSpec {
  Place place;
  std::filesystem::path results;  ///< directory, absolute
  std::optional<int> step;        ///< none: the last one written
  std::string field;              ///< its name there
};

struct FieldSpec {
  std::string name;
  Place place, on_place;
  const ManifoldOps* manifold = nullptr;
  int order = 0;  ///< 0: the mesh's
  Rule rule = Rule::projection;
  std::string on = "all";
  PointFunction initial;  ///< empty: the reference position (R^n), or
  bool normal = false;    ///< the unit normal of the stress-free surface (nodal_normals.hpp)
  /// Where the solver starts instead. All that is measured from the initial values (stress-free frames, supports that keep them) stays with those above.
  std::optional<StartSpec> start;
};

/// An energy or a load.
struct TermSpec {
  EnergyInfo info;
  std::function<std::unique_ptr<Term>(TermInput)> make;
  std::string path;  ///< for messages: "energies.0"
  Place place, on_place;
  std::string on = "all";
  std::vector<int> fields;  ///< for every slot of info
  ParameterValues parameters;
  std::map<std::string, std::string> choices;
};

struct DirichletSpec {
  /// current: stays where it is when the condition sets in.
  enum class Component { value, initial, current, free };
  std::string path;  ///< for messages: "dirichlet.0"
  Place place, on_place;
  std::string name;  ///< of the condition; several entries make one, where a support in a word holds several fields
  int field = 0;
  std::string on;
  std::vector<Component> components;  ///< one entry for each tangent coordinate of the manifold
  /// Of linear manifolds: writes the components that have a value, and no other; else the whole point. Empty: nothing has a value.
  PointFunction value;
  /// Holds in load steps that end at t with from < t <= to.
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
  /// An axis of space (0, 1, 2): the nodes must lie in one plane normal to it. Of a manifold with body axes, points turn about it only, whatever `components` says:
  /// one axis of the body must lie along it.
  int normal = -1;
  bool may_be_absent = false;  ///< where the field has no node on the region, nothing is meant
};

struct ProbeSpec {
  std::string name, quantity = "value";
  Place place;
  int field = 0;
  Vec3<double> at{};
};

struct OutputSpec {
  std::filesystem::path directory;  ///< absolute
  bool vtu = true, report = true;
  int every = 1;  ///< load steps
};

/// A field of a problem that C++ code states, with its type.
template <class M>
struct FieldOf {
  using Manifold = M;
  int index = 0;       ///< in Problem::fields
  bool moves = false;  ///< FieldSlot::moves
};

struct FieldOptions {
  int order = 0;                 ///< 0: the mesh's
  Rule rule = Rule::projection;  ///< geodesic where a manifold has no projection
  std::string on = "all";
  bool moves = false;  ///< its values are the places of the points, where pictures show them
};

class Solution;

struct Problem {
  Problem() = default;
  // What C++ programs state with: defined in problem_impl.hpp, which karcher.hpp includes.
  explicit Problem(Mesh on, std::string name = "problem");
  /// \param initial  a Point<M> as function of a MeshPoint (or of its Vec3<double>) \throws InputError when it is built, where it gives no point of M
  template <class M, class F>
  FieldOf<M> field(const std::string& name, const FieldOptions& options, F initial);
  /// Starts at the reference position (R^n) or at the manifold's standard point.
  template <class M>
  FieldOf<M> field(const std::string& name, const FieldOptions& options = {});
  void add(TermSpec term) { terms.push_back(std::move(term)); }
  /// The nodes of a region keep their initial values.
  template <class M>
  void fix(FieldOf<M> field, const std::string& region);
  /// The nodes of a region have the values f(s, t), a Point<M> each, s a MeshPoint.
  template <class M, class F>
  void prescribe(FieldOf<M> field, const std::string& region, F f);
  template <class M>
  void probe(const std::string& name, FieldOf<M> field, const Vec3<double>& at, const std::string& quantity = "value");

  std::filesystem::path file;  ///< empty: not from a file
  std::string title;
  MeshSpec mesh;
  std::vector<RegionSpec> regions;
  ReferenceSpec reference;
  std::vector<FieldSpec> fields;
  std::vector<TermSpec> terms;
  std::vector<DirichletSpec> dirichlet;
  ContinuationOptions continuation;
  SolverOptions solver;
  std::map<CellKind, int> quadrature;  ///< degrees, instead of the energies' own
  std::map<int, PointFunction> exact;  ///< by field
  std::vector<ProbeSpec> probes;
  OutputSpec output;
  std::string resolved;               ///< the whole problem as TOML, every default filled in; may be empty
  std::vector<std::string> identity;  ///< texts that two runs must share for one to continue the other

  /// Whether an energy takes the field's values for the places of the points.
  bool is_deformation(int field) const;
  /// The first such field; -1 if there is none.
  int deformation() const;
};

}  // namespace karcher
