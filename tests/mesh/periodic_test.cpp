#include "karcher/mesh/periodic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/gmsh.hpp"
#include "karcher/mesh/node_key.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/mesh/refine.hpp"
#include "mesh/contains.hpp"
#include "mesh/msh_writer.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

/// The nodes at x_axis = 1, each with that at x_axis = 0, for the first `axes` axes of a mesh of the unit cube.
std::vector<PeriodicSide> sides_of(const Mesh& mesh, int axes) {
  std::vector<PeriodicSide> sides;
  for (int axis = 0; axis < axes; ++axis) {
    PeriodicSide& side = sides.emplace_back();
    for (int a = 0; a < static_cast<int>(mesh.nodes.size()); ++a)
      for (int b = 0; b < static_cast<int>(mesh.nodes.size()); ++b) {
        Vec3<double> way = mesh.nodes[static_cast<std::size_t>(a)] - mesh.nodes[static_cast<std::size_t>(b)];
        way[axis] -= 1;
        if (norm2(way) < 1e-20) side.emplace_back(a, b);
      }
  }
  return sides;
}

Mesh cube(const std::string& shape, int n, int order = 1) {
  const double c = n;
  return generate({"box", {{"cells", {c, c, c}}, {"order", {static_cast<double>(order)}}}, {{"shape", shape}}});
}

/// Places of order q that fields see.
std::size_t places(const Mesh& mesh, int q) {
  std::set<NodeKey> keys;
  for (const Cell& c : mesh.cells)
    for (const NodeKey& key : joined_lattice_keys(mesh, c, q)) keys.insert(key);
  return keys.size();
}

TEST(Periodic, SidesAreReadInAllFourFormats) {
  for (int order = 1; order <= 3; ++order) {
    const Mesh mesh = generate({"rectangle", {{"cells", {4, 3}}, {"order", {static_cast<double>(order)}}}, {}});
    Mesh joined = mesh;
    join_nodes(joined, sides_of(mesh, 2));
    for (int version : {2, 4})
      for (bool binary : {false, true}) {
        const TemporaryDirectory directory;
        const std::string path = (directory / "square.msh").string();
        std::ofstream(path, std::ios::binary) << MshWriter(version, binary).write(mesh, {{"left", 1}}, sides_of(mesh, 2));
        const Mesh read = read_gmsh(path);
        EXPECT_EQ(read.first_copies, joined.first_copies);
        EXPECT_TRUE(read.warnings.empty());
        EXPECT_TRUE(read_gmsh(path, PeriodicSides::apart).first_copies.empty());
        for (int q = 1; q <= 3; ++q) EXPECT_EQ(places(read, q), static_cast<std::size_t>(12 * q * q));
      }
  }
}

TEST(Periodic, ACubeOfCellsHasTheNodesOfATorusInEveryOrderAndAfterRefinement) {
  for (const char* shape : {"tetrahedron", "hexahedron"})
    for (int order : {1, 2}) {
      Mesh mesh = cube(shape, 3, order);
      join_nodes(mesh, sides_of(mesh, 3));
      for (int q = 1; q <= 3; ++q) EXPECT_EQ(places(mesh, q), static_cast<std::size_t>(27 * q * q * q)) << shape << q;
      const Mesh fine = refine(mesh).mesh;
      ASSERT_EQ(fine.first_copies.size(), fine.nodes.size());
      EXPECT_EQ(places(fine, 1), 216u) << shape;
      for (std::size_t n = 0; n < fine.nodes.size(); ++n) {
        const Vec3<double> way = fine.nodes[n] - fine.nodes[static_cast<std::size_t>(fine.first_copies[n])];
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(way[i], std::round(way[i]), 1e-14) << "copies are one period apart";
      }
    }
}

TEST(Periodic, CellsAtTheTwoSidesAreNeighboursForThePartition) {
  Mesh mesh = generate({"rectangle", {{"cells", {4, 4}}}, {{"shape", "quadrilateral"}}});
  EXPECT_EQ(cell_graph(mesh).adjacent.size(), 48u);
  join_nodes(mesh, sides_of(mesh, 2));
  EXPECT_EQ(cell_graph(mesh).adjacent.size(), 64u) << "every cell has four neighbours";
}

TEST(Periodic, WhatDoesNotFitTogetherIsRefused) {
  const auto refusal = [](Mesh mesh, const std::vector<PeriodicSide>& sides) -> std::string {
    try {
      join_nodes(mesh, sides);
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing is refused";
  };
  for (const char* shape : {"tetrahedron", "hexahedron"}) {
    const Mesh one = cube(shape, 1), two = cube(shape, 2), three = cube(shape, 3);
    EXPECT_TRUE(contains(refusal(one, sides_of(one, 1)), "meets itself")) << refusal(one, sides_of(one, 1));
    EXPECT_TRUE(contains(refusal(two, sides_of(two, 1)), "at least three cells around")) << refusal(two, sides_of(two, 1));
    EXPECT_EQ(refusal(three, sides_of(three, 1)), "nothing is refused");
    // The mirror image of a side: its diagonals of triangles run the other way.
    const std::vector<PeriodicSide> sides = sides_of(three, 1);
    std::vector<PeriodicSide> mirrored{{}};
    for (const auto& [a, b] : sides[0])
      for (int c = 0; c < static_cast<int>(three.nodes.size()); ++c) {
        Vec3<double> way = three.nodes[static_cast<std::size_t>(c)] - three.nodes[static_cast<std::size_t>(b)];
        way[1] += 2 * three.nodes[static_cast<std::size_t>(b)][1] - 1;
        if (norm2(way) < 1e-20) mirrored[0].emplace_back(a, c);
      }
    if (std::string(shape) == "tetrahedron")
      EXPECT_TRUE(contains(refusal(three, mirrored), "the periodic sides do not match")) << refusal(three, mirrored);
    else
      EXPECT_EQ(refusal(three, mirrored), "nothing is refused") << "a twisted torus";
  }
}

}  // namespace
}  // namespace karcher
