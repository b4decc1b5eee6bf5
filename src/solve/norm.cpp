#include "karcher/solve/norm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "karcher/error.hpp"
#include "karcher/mesh/quadrature.hpp"

namespace karcher {
namespace {

/// sqrt(det(J^T J)) of the cell's geometry at a reference point: length, area or volume per reference measure.
double measure_factor(const GeometryJet& g, int dim) {
  const auto &a = g.d[0], &b = g.d[1], &c = g.d[2];
  switch (dim) {
    case 0:
      return 1;
    case 1:
      return std::sqrt(norm2(a));
    case 2:
      return std::sqrt(std::max(0.0, norm2(a) * norm2(b) - dot(a, b) * dot(a, b)));
    default:
      return std::abs(dot(a, cross(b, c)));
  }
}

double length_of(const Mesh& mesh) {
  const double size = diagonal(mesh);
  return size > 0 ? 0.5 * size : 1.0;
}

}  // namespace

std::vector<double> lumped_mass(const Space& space) {
  std::vector<double> mass(static_cast<std::size_t>(space.node_count()), 0.0);
  std::map<CellKind, std::vector<Shape>> shapes;  // at the points of the rule
  const Region& region = space.region();
  for (std::size_t c = 0; c < region.cells.size(); ++c) {
    const Cell& cell = region.cells[c];
    const std::vector<int>& nodes = space.cell_nodes(static_cast<int>(c));
    if (cell.kind == CellKind::vertex) {
      mass[static_cast<std::size_t>(nodes[0])] += 1;
      continue;
    }
    const Quadrature& rule = quadrature(cell.kind, 2 * space.order());
    std::vector<Shape>& at = shapes[cell.kind];
    if (at.empty())
      for (const auto& xi : rule.points) at.push_back(lagrange(cell.kind, space.order(), xi));
    std::vector<double> diagonal(nodes.size(), 0.0);
    double measure = 0;
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      const double w = rule.weights[q] * measure_factor(geometry(space.mesh(), cell, rule.points[q]), dimension(cell.kind));
      measure += w;
      for (std::size_t i = 0; i < nodes.size(); ++i) diagonal[i] += w * at[q].value[i] * at[q].value[i];
    }
    const double scale = measure / std::accumulate(diagonal.begin(), diagonal.end(), 0.0);
    for (std::size_t i = 0; i < nodes.size(); ++i) mass[static_cast<std::size_t>(nodes[i])] += scale * diagonal[i];
  }
  return mass;
}

std::vector<double> step_mass(const Layout& layout) {
  std::vector<double> mass(static_cast<std::size_t>(layout.local_dofs()), 1.0);
  for (std::size_t f = 0; f < layout.fields().size(); ++f) {
    const Field& field = layout.fields()[f];
    std::vector<double> nodal = lumped_mass(*field.space);
    const double measure = std::accumulate(nodal.begin(), nodal.end(), 0.0);
    const double size = length_of(field.space->mesh());
    for (int node = 0; node < field.space->node_count(); ++node) {  // the same on all ranks
      const double part = nodal[static_cast<std::size_t>(node)] / measure, least = part / (size * size);
      const Vec3<double>& x = field.space->position(node);
      if (!(part > 0 && std::isfinite(part) && least > 0 && std::isfinite(least)))
        throw InputError(
            fmt::format("The mesh cannot be computed with: around the node ({:.6g}, {:.6g}, {:.6g}) of the field \"{}\" its cells have no area or "
                        "volume, or lengths too large or too small to be squared.",
                        x[0], x[1], x[2], field.name));
    }
    for (int node : layout.local_nodes(static_cast<int>(f)))
      for (int k = 0; k < field.manifold->dim; ++k) {
        const double length = field.manifold->lengths[static_cast<std::size_t>(k)] ? size : 1.0;
        mass[static_cast<std::size_t>(layout.first_dof(static_cast<int>(f), node) + k)] =
            nodal[static_cast<std::size_t>(node)] / (measure * length * length);
      }
  }
  return mass;
}

}  // namespace karcher
