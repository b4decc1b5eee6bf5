#include "karcher/problem/topological_charge.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/orientation.hpp"
#include "karcher/mesh/reference_cell.hpp"

namespace karcher {
namespace {

/// The triangles between neighbouring nodes that a cell of order p falls into, each right-handed like the cell.
std::vector<std::array<std::size_t, 3>> triangles_of(CellKind kind, int p) {
  std::map<std::array<int, 2>, std::size_t> node;
  const std::vector<Vec3<double>> places = lagrange_nodes(kind, p);
  for (std::size_t n = 0; n < places.size(); ++n)
    node[{static_cast<int>(std::lround(places[n][0] * p)), static_cast<int>(std::lround(places[n][1] * p))}] = n;
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& [at, n] : node) {
    const auto right = node.find({at[0] + 1, at[1]}), up = node.find({at[0], at[1] + 1}), across = node.find({at[0] + 1, at[1] + 1});
    if (right == node.end() || up == node.end()) continue;
    triangles.push_back({n, right->second, up->second});
    if (across != node.end()) triangles.push_back({right->second, across->second, up->second});
  }
  return triangles;
}

/// Area of the triangle between three points of the sphere, with sign (Van Oosterom, Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125).
double solid_angle(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c) {
  return 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

}  // namespace

std::map<std::string, double> topological_charges(const DiscreteProblem& model, const Configuration& u) {
  std::map<std::string, double> charges;
  for (std::size_t f = 0; f < model.fields().size(); ++f) {
    const Field& field = model.fields()[f];
    const Region& region = field.space->region();
    if (field.manifold != &manifold_ops<Sphere<2>>() || region.dim != 2) continue;
    const Orientation orientation(*model.discretisation.mesh, region);
    if (!orientation.exists()) continue;
    std::map<CellKind, std::vector<std::array<std::size_t, 3>>> triangles;
    double area = 0;
    for (std::size_t c = 0; c < region.cells.size(); ++c) {
      const CellKind kind = region.cells[c].kind;
      auto& list = triangles[kind];
      if (list.empty()) list = triangles_of(kind, field.space->order());
      const std::vector<int>& nodes = field.space->cell_nodes(static_cast<int>(c));
      const auto value = [&](std::size_t n) {
        const double* p = u.at(static_cast<int>(f), nodes[n], 3);
        return Vec3<double>{{p[0], p[1], p[2]}};
      };
      for (const auto& [i, j, k] : list) area += orientation.sign(region.cells[c]) * solid_angle(value(i), value(j), value(k));
    }
    charges[field.name] = area / (4 * std::numbers::pi);
  }
  return charges;
}

}  // namespace karcher
