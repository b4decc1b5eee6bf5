#pragma once
/// \file
/// A problem file, read: every key known, every type right, every name of a field resolved, every default filled in. Names of regions are resolved when the mesh
/// is there (model.hpp).

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/point_value.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/field/field.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/solve/continuation.hpp"

namespace karcher::app {

struct MeshSpec {
  Place place;
  std::filesystem::path file;  ///< absolute; empty: generator
  GeneratorOptions generator;
  int refine = 0;
};

struct RegionSpec {
  std::string name;
  Place place;
  int dim = 0;
  bool boundary = false;
  Expression where;
};

struct ReferenceSpec {
  std::vector<Expression> position;  ///< of the mesh point; empty: the mesh itself
  int order = 2;
};

enum class InitialKind { values, reference };

struct FieldSpec {
  std::string name;
  Place place, on_place;
  const ManifoldOps* manifold = nullptr;
  int order = 1;
  Rule rule = Rule::projection;
  std::string on = "all";
  InitialKind initial_kind = InitialKind::values;
  PointValue initial;
};

/// An energy or a load.
struct TermSpec {
  std::string path;  ///< "energies.0"
  Place place, on_place;
  const EnergyInfo* info = nullptr;
  std::string on = "all";
  std::vector<int> fields;
  ParameterValues parameters;
  std::map<std::string, std::string> choices;
};

struct DirichletSpec {
  enum class Component { value, initial, free };
  std::string path;
  Place place, on_place;
  int field = 0;
  std::string on;
  /// One entry for each tangent coordinate of the manifold. value: the ambient coordinate of R^n (where tangent and ambient coordinates agree).
  std::vector<Component> components;
  std::vector<Expression> entries;  ///< R^n: of the components with a value
  PointValue point;                 ///< other manifolds: the whole point; not given: the initial value
  bool uses_t() const;
};

struct ProbeSpec {
  std::string name, quantity;
  Place place;
  int field = 0;
  Vec3<double> at{};
};

struct OutputSpec {
  std::filesystem::path directory;  ///< absolute
  bool vtu = true, report = true;
  int every = 1;
};

struct Problem {
  std::filesystem::path file;
  std::string title;
  Scope scope;
  MeshSpec mesh;
  std::vector<RegionSpec> regions;
  ReferenceSpec reference;
  std::vector<FieldSpec> fields;
  std::vector<TermSpec> terms;
  std::vector<DirichletSpec> dirichlet;
  ContinuationOptions continuation;
  SolverOptions solver;
  std::map<CellKind, int> quadrature;
  std::map<int, PointValue> exact;  ///< by field
  std::vector<ProbeSpec> probes;
  OutputSpec output;
  Value resolved;  ///< the file with all defaults, for to_toml

  int deformation() const;  ///< first field that an energy uses as its deformation; -1 if there is none
};

struct ReadOptions {
  std::vector<std::string> overrides;  ///< --set
  std::filesystem::path output;        ///< --output; empty: as the file says
};

/// \throws InputError with file, line and column of what is wrong
Problem read_problem(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace karcher::app
