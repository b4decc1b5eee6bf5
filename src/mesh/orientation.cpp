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

/// Own normal of the polygon, or the line, of the vertices, of any length.
Vec3<double> own_normal(const Mesh& mesh, const Cell& cell) {
  const auto x = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(cell.nodes[i])]; };
  if (cell.kind == CellKind::line) return cross(x(1) - x(0), Vec3<double>{{0, 0, 1}});
  return cell.kind == CellKind::triangle ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1));
}

/// A way through an edge: the cell, and whether from the smaller vertex to the larger; of a line through an end: whether it ends there.
struct Passage {
  std::size_t cell;
  bool upwards;
};

/// The facets of a cell in the order of facets(), as keys, with the senses in which the cell runs through them.
std::vector<std::pair<std::array<int, 2>, bool>> passages_of(const Cell& cell) {
  const auto node = [&](int i) { return cell.nodes[static_cast<std::size_t>(i)]; };
  if (cell.kind == CellKind::line) return {{{node(0), node(0)}, false}, {{node(1), node(1)}, true}};
  std::vector<std::pair<std::array<int, 2>, bool>> list;
  for (const auto& e : edges(cell.kind))
    list.push_back({{std::min(node(e[0]), node(e[1])), std::max(node(e[0]), node(e[1]))}, node(e[0]) < node(e[1])});
  return list;
}

}  // namespace

Orientation::Orientation(const Mesh& mesh, const Region& region) {
  const std::vector<Cell>& cells = region.cells;
  if (mesh.dim == region.dim + 1) {  // outwards, if every cell is a facet of one cell of the mesh
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
    for (const auto& [facet, upwards] : passages_of(cells[c])) passages[facet].push_back({c, upwards});
  std::vector<int> sign(cells.size(), 0);
  for (std::size_t first = 0; first < cells.size(); ++first) {
    if (sign[first] != 0) continue;
    sign[first] = 1;
    std::vector<std::size_t> todo{first};
    while (!todo.empty()) {
      const std::size_t c = todo.back();
      todo.pop_back();
      for (const auto& [facet, upwards] : passages_of(cells[c])) {
        const std::vector<Passage>& through = passages[facet];
        if (through.size() > 2) exists_ = false;
        for (const Passage& other : through) {
          if (other.cell == c) continue;
          const int wanted = other.upwards == upwards ? -sign[c] : sign[c];
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
