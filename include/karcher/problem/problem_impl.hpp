#pragma once
/// \file
/// How C++ programs state problems: fields with their types, densities over them, loads, boundary data as functions.

#include <fmt/format.h>

#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/error.hpp"
#include "karcher/interpolation/evaluator.hpp"
#include "karcher/problem/problem.hpp"
#include "karcher/problem/solution.hpp"

namespace karcher {

namespace statement_detail {

/// f(s, t), or f(s) for what does not depend on t.
template <class M, class F>
PointFunction point_function(F f) {
  PointFunction p;
  p.asks_for_normal = true;
  p.depends_on_t = std::invocable<const F&, const MeshPoint&, double>;
  p.value = [f](const MeshPoint& s, double t, double* point) {
    Point<M> x;
    if constexpr (std::invocable<const F&, const MeshPoint&, double>)
      x = f(s, t);
    else
      x = f(s);
    if (!manifold_ops<M>().make_point(x.e.data(), point))
      throw InputError(fmt::format("The value at ({:.6g}, {:.6g}, {:.6g}) is no point of {}.", s.x[0], s.x[1], s.x[2], M::name));
  };
  return p;
}

template <class M>
FieldSlot slot(FieldOf<M> field) {
  return {.key = "field", .manifolds = {&manifold_ops<M>()}, .description = "", .moves = field.moves};
}

}  // namespace statement_detail

inline Problem::Problem(Mesh on, std::string name) : title(std::move(name)) {
  mesh.make = [shared = std::make_shared<const Mesh>(std::move(on))] { return *shared; };
}

template <class M, class F>
FieldOf<M> Problem::field(const std::string& name, const FieldOptions& options, F initial) {
  const FieldOf<M> handle = field<M>(name, options);
  fields.back().initial = statement_detail::point_function<M>(std::move(initial));
  return handle;
}

template <class M>
FieldOf<M> Problem::field(const std::string& name, const FieldOptions& options) {
  static_assert(CheckManifold<M>::passed);
  register_evaluator(manifold_ops<M>(), field_evaluator<M>());
  FieldSpec& spec = fields.emplace_back();
  spec.name = name;
  spec.manifold = &manifold_ops<M>();
  spec.order = options.order;
  spec.rule = HasProjection<M> || is_linear<M> ? options.rule : Rule::geodesic;
  spec.on = options.on;
  if constexpr (!is_linear<M>)
    spec.initial.value = [](const MeshPoint&, double, double* point) {
      const std::vector<double>& standard = manifold_ops<M>().standard_point;
      if (standard.empty()) throw InputError(fmt::format("A field with values in {} needs initial values.", M::name));
      std::copy(standard.begin(), standard.end(), point);
    };
  return {static_cast<int>(fields.size()) - 1, options.moves};
}

template <class M>
void Problem::fix(FieldOf<M> field, const std::string& region) {
  DirichletSpec& spec = dirichlet.emplace_back();
  spec.path = fmt::format("condition {}", dirichlet.size());
  spec.field = field.index;
  spec.on = region;
  spec.components.assign(M::dim, DirichletSpec::Component::initial);
}

template <class M, class F>
void Problem::prescribe(FieldOf<M> field, const std::string& region, F f) {
  fix(field, region);
  dirichlet.back().components.assign(M::dim, DirichletSpec::Component::value);
  dirichlet.back().value = statement_detail::point_function<M>(std::move(f));
}

template <class M>
void Problem::probe(const std::string& name, FieldOf<M> field, const Vec3<double>& at, const std::string& quantity) {
  probes.push_back({name, quantity, {}, field.index, at});
}

/// The integral of a density (density_term.hpp) of the fields over a region of dimension D. Fields of any manifolds and rules, in the order of the density's
/// arguments; where it takes one argument more, that is the reference configuration (energy/reference_point.hpp).
template <int D, class Density, class... M>
TermSpec integral(Density density, FieldOf<M>... fields) {
  TermSpec term;
  term.info.type = "integral";
  term.info.dimensions = {D};
  term.info.fields = {statement_detail::slot(fields)...};
  term.fields = {fields.index...};
  term.path = "the integral";
  term.make = [density](TermInput input) {
    return with_rules<D, M...>(input, [&]<class... I>() -> std::unique_ptr<Term> {
      return std::make_unique<DensityTerm<FixedDensity<Density>, D, I...>>(TermInfo{"integral", {}, {}, false, {}}, input,
                                                                           FixedDensity<Density>{density}, std::vector<std::string>{});
    });
  };
  return term;
}
/// The same over a named region.
inline TermSpec on(const std::string& region, TermSpec term) {
  term.on = region;
  return term;
}

/// A dead load f(x, t), a Vec of as many entries as the field has ambient coordinates, per measure of the region (at nodes: a force): the potential - int f . u.
template <class M, class F>
TermSpec load(FieldOf<M> field, const std::string& region, F f) {
  TermSpec term;
  term.info.type = "dead";
  term.info.load = true;
  term.info.dimensions = {0, 1, 2, 3};
  term.info.fields = {statement_detail::slot(field)};
  term.fields = {field.index};
  term.on = region;
  term.path = "the load";
  for (int c = 0; c < M::ambient; ++c) {
    ParameterValue& value = term.parameters[fmt::format("value[{}]", c)];
    value.depends_on_t = true;
    value.function = [f, c](const Vec3<double>& x, double t) { return f(x, t)[c]; };
  }
  term.make = [](TermInput input) {
    const int dim = input.region.dim;
    const std::string name = dim == 0 ? "point-load" : dim == input.mesh->dim ? "volume-load" : "traction-load";
    return make_term(name, std::move(input));
  };
  return term;
}

}  // namespace karcher
