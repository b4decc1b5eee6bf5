#include "mesh/elevate.hpp"

#include <algorithm>

#include "karcher/mesh/node_key.hpp"
#include "mesh/lattice.hpp"

namespace karcher {

Vec3<double> combine(const std::vector<double>& weights, const std::vector<Vec3<double>>& points) {
  const auto largest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  const Vec3<double> base = points[largest];
  Vec3<double> p = base;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (weights[i] != 0) p += weights[i] * (points[i] - base);
  return p;
}

Mesh elevate(std::vector<Cell> cells, int order, const Map& map) {
  Mesh mesh;
  int vertices = 0;
  for (const Cell& c : cells)
    for (int v : c.nodes) vertices = std::max(vertices, v + 1);
  // Vertices keep their numbers.
  NodeNumbering numbering(cells.size() + static_cast<std::size_t>(vertices));
  for (int v = 0; v < vertices; ++v) {
    NodeKey key;
    key.vertices[0] = v;
    numbering.insert(key);
  }
  mesh.nodes.resize(static_cast<std::size_t>(vertices));
  std::vector<char> placed(static_cast<std::size_t>(vertices), 0);
  for (Cell& c : cells) {
    mesh.dim = std::max(mesh.dim, dimension(c.kind));
    const auto& points = lattice(c.kind, order);
    const std::vector<NodeKey> keys = lattice_keys(c, order);
    std::vector<int> nodes;
    nodes.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const int n = numbering.insert(keys[i]).number;
      nodes.push_back(n);
      const auto place = static_cast<std::size_t>(n);
      if (place == placed.size()) {
        placed.push_back(0);
        mesh.nodes.emplace_back();
      }
      if (placed[place]) continue;
      placed[place] = 1;
      mesh.nodes[place] = map(i < c.parameters.size() ? c.parameters[i] : combine(vertex_functions(c.kind, points[i], order), c.parameters));
    }
    c.order = order;
    c.nodes = std::move(nodes);
  }
  mesh.cells = std::move(cells);
  check_identity(mesh);
  mesh.parametrisation = map;
  mesh.regions["all"] = {"all", mesh.dim, mesh.cells};
  return mesh;
}

}  // namespace karcher
