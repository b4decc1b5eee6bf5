#include "karcher/mesh/orientation.hpp"

#include <algorithm>
#include <array>

#include "karcher/mesh/incidence.hpp"

namespace karcher {
namespace {

std::vector<int> key_of(const Cell& cell) {
  const auto v = vertices(cell);
  std::vector<int> key(v.begin(), v.end());
  std::sort(key.begin(), key.end());
  return key;
}

/// Own normal of the polygon of the vertices, of any length.
Vec3<double> own_normal(const Mesh& mesh, const Cell& cell) {
  const auto x = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(cell.nodes[i])]; };
  return cell.kind == CellKind::triangle ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1));
}

/// A way through an edge: the cell, and whether from the smaller vertex to the larger.
struct Passage {
  std::size_t cell;
  bool upwards;
};

}  // namespace

Orientation::Orientation(const Mesh& mesh, const Region& region) {
  const std::vector<Cell>& cells = region.cells;
  if (mesh.dim == 3) {  // outwards, if every cell is a face of one solid cell
    const VertexCells around(mesh);
    bool boundary = true;
    std::map<std::vector<int>, int> outwards;
    for (const Cell& cell : cells) {
      std::vector<int> solids;
      around.containing(vertices(cell), [&](int c) { return solids.push_back(c), true; });
      boundary = boundary && solids.size() == 1;
      if (!boundary) break;
      const Vec3<double> out = middle(mesh, cell) - middle(mesh, mesh.cells[static_cast<std::size_t>(solids.front())]);
      outwards[key_of(cell)] = dot(own_normal(mesh, cell), out) < 0 ? -1 : 1;
    }
    if (boundary) {
      sign_ = std::move(outwards);
      return;
    }
  }

  std::map<std::array<int, 2>, std::vector<Passage>> passages;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const auto& e : edges(cells[c].kind)) {
      const int a = cells[c].nodes[static_cast<std::size_t>(e[0])], b = cells[c].nodes[static_cast<std::size_t>(e[1])];
      passages[{std::min(a, b), std::max(a, b)}].push_back({c, a < b});
    }
  std::vector<int> sign(cells.size(), 0);
  for (std::size_t first = 0; first < cells.size(); ++first) {
    if (sign[first] != 0) continue;
    sign[first] = 1;
    std::vector<std::size_t> todo{first};
    while (!todo.empty()) {
      const std::size_t c = todo.back();
      todo.pop_back();
      for (const auto& e : edges(cells[c].kind)) {
        const int a = cells[c].nodes[static_cast<std::size_t>(e[0])], b = cells[c].nodes[static_cast<std::size_t>(e[1])];
        const std::vector<Passage>& through = passages[{std::min(a, b), std::max(a, b)}];
        if (through.size() > 2) exists_ = false;
        for (const Passage& other : through) {
          if (other.cell == c) continue;
          const int wanted = other.upwards == (a < b) ? -sign[c] : sign[c];
          if (sign[other.cell] == 0) {
            sign[other.cell] = wanted;
            todo.push_back(other.cell);
          } else if (sign[other.cell] != wanted) {
            exists_ = false;
          }
        }
      }
    }
  }
  if (exists_)
    for (std::size_t c = 0; c < cells.size(); ++c) sign_[key_of(cells[c])] = sign[c];
}

int Orientation::sign(const Cell& cell) const {
  const auto found = sign_.find(key_of(cell));
  return found == sign_.end() ? 1 : found->second;
}

}  // namespace karcher
