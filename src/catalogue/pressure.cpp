#include "karcher/energy/pressure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catalogue/entry.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/error.hpp"
#include "karcher/interpolation/linear.hpp"
#include "karcher/manifold/euclidean.hpp"

namespace karcher::catalogue {
namespace {

/// Exact for the volume, a polynomial in the reference coordinates: a lower degree would push closed surfaces away.
void integrate_exactly(TermInput& input) {
  const int order = input.field(0).space->order();
  for (const CellKind kind : {CellKind::line, CellKind::triangle, CellKind::quadrilateral}) {
    int& degree = input.quadrature_degree[kind];
    degree = std::max(degree, kind == CellKind::quadrilateral ? 3 * order - 1 : kind == CellKind::triangle ? 3 * order - 2 : 2 * order - 1);
  }
}

template <template <class> class Density, class M, int D>
std::unique_ptr<Term> term(const EnergyInfo& info, const TermInput& given) {
  TermInput input = given;
  integrate_exactly(input);
  std::vector<std::string> keys = parameter_keys(info, input);
  for (const auto& [name, standard] : {std::pair("share", 1.0 / M::dim), std::pair("origin", 0.0)})
    for (int i = 0; i < M::dim; ++i) input.parameters.try_emplace(keys.emplace_back(fmt::format("{}[{}]", name, i)), standard);
  return std::make_unique<DensityTerm<VaryingDensity<Density>, D, LinearInterpolation<M, D, NativeScalar>>>(term_info(info, input), input,
                                                                                                            VaryingDensity<Density>{}, keys);
}

std::unique_ptr<Term> make_pressure(const EnergyInfo& info, const TermInput& input) {
  const bool plane = input.field(0).manifold == &manifold_ops<Euclidean<2>>();
  if (input.region.dim != (plane ? 1 : 2))
    throw InputError(
        fmt::format("A pressure works on surfaces of a deformation in R3 and on curves of one in R2; \"{}\" has values in {}, and region "
                    "\"{}\" has dimension {}.",
                    input.field(0).name, input.field(0).manifold->name, input.region.name, input.region.dim));
  if (plane && input.mesh->dim != 2)
    throw InputError(fmt::format("A pressure on a deformation in R2 works on curves of a plane mesh; this one has dimension {}.", input.mesh->dim));
  return plane ? term<PlanePressure, Euclidean<2>, 1>(info, input) : term<Pressure, Euclidean<3>, 2>(info, input);
}

}  // namespace

std::vector<Entry> pressure_entries() {
  EnergyInfo e;
  e.type = "pressure";
  e.load = true;
  e.description =
      "Pressure that follows the motion: traction -value n per current area, n outwards on the boundary of a solid, on a shell the cells' own normal "
      "(that of the first cell of a connected part, all others agree). The potential is value * V, V the volume between the surface and the centre "
      "of "
      "its rim; of a closed surface V = 1/3 int m.(m_1 x m_2).\n"
      "An open surface has one only where its rim is clamped or held in planes. In R2: on boundary curves, per thickness; V is an area.\n"
      "Quadrature: exact.";
  e.dimensions = {1, 2};
  e.fields = {{.key = "field", .manifolds = accepted(ManifoldList<Euclidean<2>, Euclidean<3>>{}), .description = "the deformation", .moves = true}};
  e.parameters = {{.name = "value",
                   .unit = "force/length^2",
                   .description = "the pressure, positive against the normal; of t, the same everywhere",
                   .default_value = {},
                   .uniform = true}};
  e.choices = {{"force", {"false", "true"}, "accepts a rim that can move, with forces along it that are no pressure"}};
  e.enclosure = true;
  return {{e, &make_pressure}};
}

}  // namespace karcher::catalogue
