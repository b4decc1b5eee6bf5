#include "karcher/problem/probes.hpp"

#include <limits>

#include "karcher/interpolation/evaluate.hpp"
#include "karcher/mesh/locate.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {
namespace {

std::vector<double> quantity(const ProbeSpec& probe, const ManifoldOps& m, const std::vector<double>& value, const Vec3<double>& reference) {
  if (probe.quantity == "displacement") {
    std::vector<double> u = value;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= reference[static_cast<int>(i)];
    return u;
  }
  for (const Quantity& q : m.quantities) {
    if (q.name != probe.quantity) continue;
    std::vector<double> v(static_cast<std::size_t>(q.components));
    q.value(value.data(), v.data());
    return v;
  }
  return value;
}

}  // namespace

std::vector<double> probe_value(const ProbeSpec& probe, const Problem& problem, const DiscreteProblem& model, const Configuration& u) {
  const auto index = static_cast<std::size_t>(probe.field);
  const Field& field = model.fields()[index];
  const Space& space = *field.space;
  const Mesh& mesh = *model.discretisation.mesh;
  const Location where = at_place(probe.place, [&] { return locate(mesh, space.region(), probe.at); });
  const Cell& cell = space.region().cells[static_cast<std::size_t>(where.cell)];
  const Shape shape = lagrange(cell.kind, space.order(), where.xi);
  std::vector<double> nodes;
  const int n = field.manifold->ambient;
  for (const int node : space.cell_nodes(where.cell))
    nodes.insert(nodes.end(), u.values[index].begin() + node * n, u.values[index].begin() + (node + 1) * n);
  const FieldAtPoint at = evaluate_field(*field.manifold, field.rule, nodes, shape.value);
  if (!at.defined) return std::vector<double>(static_cast<std::size_t>(n), std::numeric_limits<double>::quiet_NaN());
  const ReferenceSpec stress_free = reference(problem, mesh);
  const Vec3<double> place = ReferenceGeometry(mesh, stress_free.position, stress_free.order).at(cell, {where.xi}).front().x;
  return quantity(probe, *field.manifold, at.value, place);
}

std::map<std::string, std::vector<double>> probe_values(const Problem& problem, const DiscreteProblem& model, const Configuration& u) {
  std::map<std::string, std::vector<double>> values;
  for (const ProbeSpec& probe : problem.probes) values[probe.name] = probe_value(probe, problem, model, u);
  return values;
}

}  // namespace karcher
