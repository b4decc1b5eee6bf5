#include "karcher/mesh/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "karcher/error.hpp"

namespace karcher {
namespace {

struct MetisOptions {
  std::array<idx_t, METIS_NOPTIONS> values;
  MetisOptions() {
    METIS_SetDefaultOptions(values.data());
    values[METIS_OPTION_SEED] = 1;
    values[METIS_OPTION_NUMBERING] = 0;
  }
};

void check(int status, const char* what) {
  if (status != METIS_OK) throw Error(std::string("METIS could not ") + what + " (out of memory, or a graph that is not symmetric).");
}

Graph graph_of_edges(int size, std::vector<std::pair<int, int>> edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Graph graph;
  graph.begin.assign(static_cast<std::size_t>(size) + 1, 0);
  graph.adjacent.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++graph.begin[static_cast<std::size_t>(from) + 1];
    graph.adjacent.push_back(to);
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  return graph;
}

}  // namespace

Graph cell_graph(const Mesh& mesh) {
  // A facet is known by its vertices: at most four, sorted, padded with -1.
  struct FacetOfCell {
    std::array<int, 4> vertices;
    int cell;
  };
  std::vector<FacetOfCell> all;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Cell& cell = mesh.cells[c];
    for (const ReferenceFace& facet : facets(cell.kind)) {
      FacetOfCell f{{-1, -1, -1, -1}, static_cast<int>(c)};
      for (std::size_t v = 0; v < facet.vertices.size(); ++v) {
        const int vertex = cell.nodes[static_cast<std::size_t>(facet.vertices[v])];
        f.vertices[v] = mesh.first_copies.empty() ? vertex : mesh.first_copies[static_cast<std::size_t>(vertex)];
      }
      std::sort(f.vertices.begin(), f.vertices.end());
      all.push_back(f);
    }
  }
  std::sort(all.begin(), all.end(),
            [](const FacetOfCell& a, const FacetOfCell& b) { return std::tie(a.vertices, a.cell) < std::tie(b.vertices, b.cell); });

  std::vector<std::pair<int, int>> edges;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].vertices == all[begin].vertices) ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = begin; j < end; ++j)
        if (all[i].cell != all[j].cell) edges.emplace_back(all[i].cell, all[j].cell);
  }
  return graph_of_edges(static_cast<int>(mesh.cells.size()), std::move(edges));
}

std::vector<int> partition(const Graph& graph, int parts) {
  std::vector<int> part(static_cast<std::size_t>(graph.size()), 0);
  if (parts <= 1) return part;
  if (graph.size() <= parts) {
    std::iota(part.begin(), part.end(), 0);
    return part;
  }
  MetisOptions options;
  // METIS takes pointers to non-const, and changes nothing behind them.
  idx_t size = graph.size(), constraints = 1, wanted = parts, cut = 0;
  idx_t *begin = const_cast<idx_t*>(graph.begin.data()), *adjacent = const_cast<idx_t*>(graph.adjacent.data());
  const auto cutter = parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  check(cutter(&size, &constraints, begin, adjacent, nullptr, nullptr, nullptr, &wanted, nullptr, nullptr, options.values.data(), &cut, part.data()),
        "partition the mesh");
  return part;
}

std::vector<int> partition_cells(const Mesh& mesh, int ranks) {
  if (ranks <= 1) return std::vector<int>(mesh.cells.size(), 0);
  return partition(cell_graph(mesh), ranks);
}

std::vector<int> fill_reducing_order(const Graph& graph) {
  std::vector<int> place(static_cast<std::size_t>(graph.size()));
  std::iota(place.begin(), place.end(), 0);
  if (graph.size() < 3 || graph.adjacent.empty()) return place;
  MetisOptions options;
  idx_t size = graph.size();
  idx_t *begin = const_cast<idx_t*>(graph.begin.data()), *adjacent = const_cast<idx_t*>(graph.adjacent.data());
  std::vector<int> vertex_at(place.size());
  check(METIS_NodeND(&size, begin, adjacent, nullptr, options.values.data(), vertex_at.data(), place.data()), "order the unknowns");
  return place;
}

}  // namespace karcher
