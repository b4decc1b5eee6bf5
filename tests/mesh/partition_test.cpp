#include "karcher/mesh/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "karcher/mesh/generators.hpp"

namespace karcher {
namespace {

Mesh moebius() {
  GeneratorOptions options;
  options.name = "moebius";
  options.numbers["cells"] = {24, 4};
  return generate(options);
}

TEST(CellGraph, JoinsCellsThatShareAFacet) {
  // Three triangles around the edge 0-1 (not a manifold), and one that touches a vertex only.
  Mesh mesh;
  mesh.dim = 2;
  for (int i = 0; i < 7; ++i) mesh.nodes.push_back({{static_cast<double>(i), static_cast<double>(i * i), 0}});
  for (auto nodes : {std::vector<int>{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {4, 5, 6}}) {
    Cell c;
    c.kind = CellKind::triangle;
    c.nodes = nodes;
    mesh.cells.push_back(c);
  }
  const Graph graph = cell_graph(mesh);
  EXPECT_EQ(graph.begin, (std::vector<int>{0, 2, 4, 6, 6}));
  EXPECT_EQ(graph.adjacent, (std::vector<int>{1, 2, 0, 2, 0, 1}));
}

TEST(Partition, GivesPartsOfEqualSizeWithShortCuts) {
  const Mesh mesh = moebius();
  const Graph graph = cell_graph(mesh);
  for (int ranks : {2, 3, 4}) {
    const std::vector<int> rank = partition_cells(mesh, ranks);
    ASSERT_EQ(rank.size(), mesh.cells.size());
    for (int r = 0; r < ranks; ++r) {
      const auto size = static_cast<double>(std::count(rank.begin(), rank.end(), r));
      EXPECT_NEAR(size / (static_cast<double>(rank.size()) / ranks), 1, 0.1);
    }
    int cut = 0;
    for (int c = 0; c < graph.size(); ++c)
      for (int k = graph.begin[static_cast<std::size_t>(c)]; k < graph.begin[static_cast<std::size_t>(c) + 1]; ++k)
        cut += rank[static_cast<std::size_t>(c)] != rank[static_cast<std::size_t>(graph.adjacent[static_cast<std::size_t>(k)])];
    EXPECT_LE(cut / 2, ranks * 3 * 8);  // a straight cut across the strip of four cells crosses at most 8 edges
  }
}

TEST(Partition, IsTheSameEveryTime) {
  const Mesh mesh = moebius();
  EXPECT_EQ(partition_cells(mesh, 3), partition_cells(mesh, 3));
}

TEST(Partition, WorksWithMorePartsThanCells) {
  Mesh mesh = moebius();
  mesh.cells.resize(2);
  const auto rank = partition_cells(mesh, 5);
  for (int r : rank) EXPECT_LT(r, 5);
  EXPECT_EQ(partition_cells(mesh, 1), (std::vector<int>{0, 0}));
}

TEST(FillReducingOrder, IsAPermutationThatEliminatesSeparatorsLast) {
  // On a path of n vertices, fill-free orders exist; nested dissection puts a vertex near the middle last.
  const int n = 1001;
  Graph graph;
  for (int v = 0; v < n; ++v) {
    if (v > 0) graph.adjacent.push_back(v - 1);
    if (v + 1 < n) graph.adjacent.push_back(v + 1);
    graph.begin.push_back(static_cast<int>(graph.adjacent.size()));
  }
  const std::vector<int> place = fill_reducing_order(graph);
  EXPECT_EQ(std::set<int>(place.begin(), place.end()).size(), static_cast<std::size_t>(n));
  EXPECT_EQ(*std::min_element(place.begin(), place.end()), 0);
  EXPECT_EQ(*std::max_element(place.begin(), place.end()), n - 1);
  const auto last = std::max_element(place.begin(), place.end()) - place.begin();
  EXPECT_GT(last, n / 4);
  EXPECT_LT(last, 3 * n / 4);
}

TEST(FillReducingOrder, TakesGraphsWithoutEdges) {
  Graph graph;
  graph.begin = {0, 0, 0, 0, 0};
  EXPECT_EQ(fill_reducing_order(graph), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(fill_reducing_order(Graph{}).empty());
}

}  // namespace
}  // namespace karcher
