#pragma once
/// \file
/// Who computes what, and in which order the unknowns are eliminated: both are questions about graphs, answered by METIS (Karypis, Kumar 1998), which
/// knows neither geometry nor orientation, so any topology is welcome. Answers depend on the input alone, never on the run.

#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Undirected graph in compressed rows: the neighbours of v are adjacent[begin[v]] .. adjacent[begin[v + 1] - 1]; every edge is listed at both ends, loops are not.
struct Graph {
  std::vector<int> begin{0};
  std::vector<int> adjacent;
  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// The cells of a mesh; two of them are neighbours if they share a facet (any number of cells may share one).
Graph cell_graph(const Mesh& mesh);

/// Part (0 .. parts - 1) of every vertex: parts of nearly equal size with few edges between them. Parts may be empty if there are more parts than vertices.
std::vector<int> partition(const Graph& graph, int parts);

/// Rank of every cell of the mesh: partition(cell_graph(mesh), ranks).
std::vector<int> partition_cells(const Mesh& mesh, int ranks);

/// Place of every vertex in an elimination order with little fill (multilevel nested dissection).
std::vector<int> fill_reducing_order(const Graph& graph);

}  // namespace karcher
