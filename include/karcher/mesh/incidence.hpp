#pragma once
/// \file
/// Which cells of a mesh contain given vertices.

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// The mesh cells around every vertex, ascending, in compressed rows.
class VertexCells {
 public:
  /// \param first_copies Mesh::first_copies where copies of a vertex count as one
  explicit VertexCells(const Mesh& mesh, std::vector<int> first_copies = {})
      : first_copies_(std::move(first_copies)), begin_(mesh.nodes.size() + 1, 0) {
    const auto for_vertices = [&](auto visit) {
      for (std::size_t i = 0; i < mesh.cells.size(); ++i)
        for (int v = 0; v < vertex_count(mesh.cells[i].kind); ++v) visit(number(mesh.cells[i].nodes[static_cast<std::size_t>(v)]), i);
    };
    for_vertices([&](std::size_t vertex, std::size_t) { ++begin_[vertex + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    cells_.resize(static_cast<std::size_t>(begin_.back()));
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for_vertices([&](std::size_t vertex, std::size_t cell) { cells_[static_cast<std::size_t>(next[vertex]++)] = static_cast<int>(cell); });
  }

  std::span<const int> around(int vertex) const {
    const std::size_t v = number(vertex);
    return std::span<const int>(cells_).subspan(static_cast<std::size_t>(begin_[v]), static_cast<std::size_t>(begin_[v + 1] - begin_[v]));
  }

  /// Calls visit(cell) for the cells that have all the vertices, in ascending order, until it returns false.
  template <class Visit>
  void containing(std::span<const int> vertices, Visit visit) const {
    for (int c : around(vertices[0])) {
      const bool has_all = std::all_of(vertices.begin() + 1, vertices.end(), [&](int v) {
        const auto cells = around(v);
        return std::binary_search(cells.begin(), cells.end(), c);
      });
      if (has_all && !visit(c)) return;
    }
  }

 private:
  std::size_t number(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return first_copies_.empty() ? v : static_cast<std::size_t>(first_copies_[v]);
  }

  std::vector<int> first_copies_, begin_, cells_;
};

/// The vertices of a cell, in its order.
inline std::span<const int> vertices(const Cell& cell) {
  return std::span<const int>(cell.nodes).first(static_cast<std::size_t>(vertex_count(cell.kind)));
}

}  // namespace karcher
