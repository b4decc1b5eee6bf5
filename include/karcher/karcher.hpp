#pragma once
/// \file
/// The library's front door: one field with values in a manifold, an energy that is a sum of integrals of densities, its minimiser, a file to look at.
///
///     GeometricSpace<Sphere<2>, 2> space(read_gmsh("square.msh"), 2, Rule::geodesic);         maps of a surface into S^2, second order
///     auto u = space.interpolate([](const Vec3<double>& x) { return ...; });                   a point of the sphere at every node
///     u.fix("boundary");                                                                      nodes of a named region keep their values
///     StepReport report = minimize(integral(space, Density{}), u);
///     write_vtu("u.vtu", u);
///
/// A density is a type with `template <class Jet> auto operator()(const Jet& u) const`: u.value is the value and u.d[0], ..., u.d[D - 1] are its derivatives in
/// orthonormal directions of the domain (for a domain of the full dimension of its space: d/dx, d/dy, d/dz), all in ambient coordinates. With
/// `operator()(const X& x, const Jet& u)` it knows its place x[0], x[1], x[2], too. All derivatives that a minimiser needs come from jets, exactly.
/// Problems of several fields, load steps, other regions: the types below this header's, from which it is made (docs/architecture.md).
///
/// On several ranks every function here is collective and every rank holds all values.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/functional.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/energy/harmonic.hpp"
#include "karcher/error.hpp"
#include "karcher/interpolation/evaluator.hpp"
#include "karcher/io/vtu.hpp"
#include "karcher/manifold/every_manifold.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/gmsh.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/problem/problem_impl.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/minimize.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/version.hpp"

namespace karcher {

template <class M, int D>
class GeometricFunction;

/// Geometric finite elements: maps of a D-dimensional domain into M by their values at Lagrange nodes of some order.
template <class M, int D>
class GeometricSpace {
 public:
  using Manifold = M;
  static_assert(CheckManifold<M>::passed);

  /// \param order  1, 2 or 3
  /// \throws InputError if the mesh has another dimension than D, or for the projection rule on a manifold that has no projection.
  GeometricSpace(Mesh mesh, int order, Rule rule = HasProjection<M> ? Rule::projection : Rule::geodesic) {
    if (mesh.dim != D) throw InputError(fmt::format("The mesh has dimension {}, the space is one of maps of {}-dimensional domains.", mesh.dim, D));
    with_rule<M, D>(Field{"u", &manifold_ops<M>(), rule, nullptr}, []<class>() { return 0; });
    register_evaluator(manifold_ops<M>(), field_evaluator<M>());
    const auto shared = std::make_shared<const Mesh>(std::move(mesh));
    field_ = {"u", &manifold_ops<M>(), rule, std::make_shared<const Space>(shared, shared->region("all"), order)};
  }

  /// The function that has the value f(x), a Point<M>, at every node x. \throws InputError where f(x) is no point of M.
  template <class F>
  GeometricFunction<M, D> interpolate(F f) const;

  const Field& field() const { return field_; }
  const Space& nodes() const { return *field_.space; }

 private:
  Field field_;
};

/// A function of a GeometricSpace.
template <class M, int D>
class GeometricFunction {
 public:
  GeometricFunction(GeometricSpace<M, D> space, Configuration values)
      : space_(std::move(space)), values_(std::move(values)), fixed_(static_cast<std::size_t>(space_.nodes().node_count() * M::dim), 0) {}

  /// The nodes of a region of the mesh, of any dimension, keep their values. \throws InputError naming the known regions.
  void fix(const std::string& region) {
    for (const Cell& entity : space_.nodes().mesh().region(region).cells)
      for (const int node : space_.nodes().entity_nodes(entity)) std::fill_n(fixed_.begin() + node * M::dim, M::dim, char{1});
  }

  Point<M> operator[](int node) const { return manifold_detail::read<M::ambient>(values_.at(0, node, M::ambient)); }
  const GeometricSpace<M, D>& space() const { return space_; }
  const std::vector<char>& fixed() const { return fixed_; }  ///< [node * dim + tangent coordinate]
  const Configuration& values() const { return values_; }
  Configuration& values() { return values_; }

 private:
  GeometricSpace<M, D> space_;
  Configuration values_;
  std::vector<char> fixed_;
};

template <class M, int D>
template <class F>
GeometricFunction<M, D> GeometricSpace<M, D>::interpolate(F f) const {
  Configuration values;
  values.values.emplace_back(static_cast<std::size_t>(nodes().node_count() * M::ambient));
  for (int node = 0; node < nodes().node_count(); ++node) {
    const Vec3<double>& x = nodes().position(node);
    const Point<M> p = f(x);
    if (!field_.manifold->make_point(p.e.data(), values.at(0, node, M::ambient)))
      throw InputError(fmt::format("The value at ({:.6g}, {:.6g}, {:.6g}) is no point of {}.", x[0], x[1], x[2], M::name));
  }
  return {*this, std::move(values)};
}

namespace front_detail {

template <class Density, class M, int D>
concept OfJets = requires(const Density& w, const FieldJet<M, D, Jet<double, 2>>& u) {
  { w(u) } -> std::convertible_to<Jet<double, 2>>;
};
template <class Density, class M, int D>
concept OfPlacesAndJets = requires(const Density& w, const ReferencePoint<D, double>& x, const FieldJet<M, D, Jet<double, 2>>& u) {
  { w(x, u) } -> std::convertible_to<Jet<double, 2>>;
};

}  // namespace front_detail

/// A sum of integrals of densities of a function of one space.
template <class M, int D>
class Energy {
 public:
  using MakeTerm = std::function<std::unique_ptr<Term>(TermInput)>;
  Energy(GeometricSpace<M, D> space, MakeTerm term) : space_(std::move(space)), terms_{std::move(term)} {}

  friend Energy operator+(Energy a, const Energy& b) {
    a.terms_.insert(a.terms_.end(), b.terms_.begin(), b.terms_.end());
    return a;
  }

  /// As the solver takes it. The layout is that of u, with u's fixed nodes.
  Functional functional(const GeometricFunction<M, D>& u) const {
    const Mesh& mesh = space_.nodes().mesh();
    const auto layout = std::make_shared<const Layout>(std::vector<Field>{u.space().field()}, std::vector<std::vector<char>>{u.fixed()},
                                                       partition_cells(mesh, world_size()), world_rank(), world_size());
    TermInput input;
    input.mesh = space_.nodes().mesh_ptr();
    input.region = {"all", D, {}};
    for (const Cell& cell : mesh.cells)
      if (layout->cell_rank(cell) == layout->rank()) input.region.cells.push_back(cell);
    input.all_fields = {u.space().field()};
    input.fields = {0};
    std::vector<std::unique_ptr<Term>> terms;
    for (const MakeTerm& make : terms_) terms.push_back(make(input));
    return Functional(layout, std::move(terms));
  }

 private:
  GeometricSpace<M, D> space_;
  std::vector<MakeTerm> terms_;
};

/// The integral of a density (see the head of this file) over the domain of a space.
template <class M, int D, class Density>
Energy<M, D> integral(const GeometricSpace<M, D>& space, Density density) {
  static_assert(
      front_detail::OfPlacesAndJets<Density, M, D> || front_detail::OfJets<Density, M, D>,
      "A density needs `template <class Jet> auto operator()(const Jet& u) const` (or `(const X& x, const Jet& u)`) that returns a number of the "
      "scalar type of u.value.");
  return {space, [density](TermInput input) {
            const Field& field = input.all_fields.front();
            return with_rule<M, D>(field, [&]<class Interpolation>() -> std::unique_ptr<Term> {
              return std::make_unique<DensityTerm<FixedDensity<Density>, D, Interpolation>>(
                  TermInfo{"integral", {}, {}, false, {}}, input, FixedDensity<Density>{density}, std::vector<std::string>{});
            });
          }};
}

/// Minimises the energy from u over the nodes that are not fixed; u becomes the best function found, whatever the outcome. The report says what was reached, and
/// whether it is a local minimum. \throws InputError for options that make no sense.
template <class M, int D>
StepReport minimize(const Energy<M, D>& energy, GeometricFunction<M, D>& u, const SolverOptions& options = {},
                    std::span<Observer* const> observers = {}) {
  Functional functional = energy.functional(u);
  const StepReport report = minimize(functional, u.values(), options, observers);
  complete(functional.layout(), u.values());
  return report;
}

/// The function for ParaView (vtu.hpp), written atomically by rank 0.
template <class M, int D>
void write_vtu(const std::filesystem::path& file, const GeometricFunction<M, D>& u) {
  if (world_rank() != 0) return;
  OutputModel model;
  model.fields = {u.space().field()};
  write_vtu(file, OutputSampler(model).sample(u.values()).front(), u.values().t);
}

}  // namespace karcher
