#include "karcher/problem/mesh_points.hpp"

#include <cmath>

#include "karcher/mesh/orientation.hpp"

namespace karcher {

std::vector<MeshPoint> mesh_points(const Space& space, bool with_normals) {
  std::vector<MeshPoint> points;
  for (int node = 0; node < space.node_count(); ++node) points.push_back({space.position(node), {}});
  const Region& region = space.region();
  if (!with_normals || region.dim != 2) return points;
  const Orientation orientation(space.mesh(), region);
  std::vector<char> known(points.size(), 0);
  for (std::size_t c = 0; c < region.cells.size(); ++c) {
    const Cell& cell = region.cells[c];
    const std::vector<int>& nodes = space.cell_nodes(static_cast<int>(c));
    const std::vector<Vec3<double>>& places = lagrange_nodes(cell.kind, space.order());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto n = static_cast<std::size_t>(nodes[i]);
      if (known[n]) continue;
      known[n] = 1;
      const GeometryJet g = geometry(space.mesh(), cell, places[i]);
      const Vec3<double> normal = cross(g.d[0], g.d[1]);
      points[n].normal = (orientation.sign(cell) / std::sqrt(norm2(normal))) * normal;
    }
  }
  return points;
}

}  // namespace karcher
