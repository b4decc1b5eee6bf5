#include "karcher/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"
#include "mesh/contains.hpp"
#include "mesh/measure.hpp"

namespace karcher {
namespace {

std::string message(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

Mesh box(const char* shape, double order = 1) { return generate({"box", {{"cells", {2, 3, 4}}, {"order", {order}}}, {{"shape", shape}}}); }

TEST(Mesh, CountsTheEntitiesOfAGridOfHexahedra) {
  const Mesh mesh = box("hexahedron", 2);
  EXPECT_EQ(entities(mesh, 3, false).size(), 2u * 3 * 4);
  EXPECT_EQ(entities(mesh, 2, false).size(), 3u * 3 * 4 + 2 * 4 * 4 + 2 * 3 * 5);
  EXPECT_EQ(entities(mesh, 1, false).size(), 2u * 4 * 5 + 3 * 3 * 5 + 3 * 4 * 4);
  EXPECT_EQ(entities(mesh, 0, false).size(), 3u * 4 * 5);
  EXPECT_EQ(mesh.nodes.size(), 5u * 7 * 9);
}

TEST(Mesh, BoundaryOfABoxIsItsSurface) {
  for (const char* shape : {"tetrahedron", "hexahedron"})
    for (double order : {1.0, 2.0, 3.0}) {
      const Mesh mesh = box(shape, order);
      EXPECT_NEAR(measure(mesh, boundary_facets(mesh)), 6, 1e-13);
      const int quads = 2 * (3 * 4 + 2 * 4 + 2 * 3);
      EXPECT_EQ(entities(mesh, 2, true).size(), static_cast<std::size_t>(shape[0] == 't' ? 2 * quads : quads));
      EXPECT_EQ(entities(mesh, 0, true).size(), 60u - 1 * 2 * 3);  // all but the inner vertices
    }
}

TEST(Mesh, FacetsOfAnEdgeWithThreeTrianglesAreNoBoundary) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.nodes = {{{0, 0, 0}}, {{0, 0, 1}}, {{1, 0, 0}}, {{-1, 1, 0}}, {{-1, -1, 0}}};
  for (int wing : {2, 3, 4}) mesh.cells.push_back({CellKind::triangle, 1, {0, 1, wing}, {}});
  EXPECT_NO_THROW(check_identity(mesh));
  EXPECT_EQ(entities(mesh, 1, false).size(), 7u);
  EXPECT_EQ(boundary_facets(mesh).size(), 6u);
}

TEST(Mesh, SelectsTheEntitiesAllOfWhoseNodesSatisfyThePredicate) {
  const Mesh mesh = box("hexahedron", 2);
  const auto low_x = [](const Vec3<double>& x) { return x[0] < 1e-9; };
  EXPECT_NEAR(measure(mesh, select(mesh, "wall", 2, true, low_x).cells), 1, 1e-14);
  EXPECT_EQ(select(mesh, "wall", 2, false, low_x).cells.size(), 12u);
  EXPECT_EQ(select(mesh, "edges", 1, true, low_x).cells.size(), 3u * 5 + 4 * 4);
  EXPECT_EQ(select(mesh, "corner", 0, false, [](const Vec3<double>& x) { return norm2(x) < 1e-9; }).cells.size(), 1u);
  const auto half = [](const Vec3<double>& x) { return x[2] < 0.5 + 1e-9; };
  EXPECT_NEAR(measure(mesh, select(mesh, "half", 3, false, half).cells), 0.5, 1e-13);
  // A cell that reaches into the set with its middle node only does not belong to it.
  EXPECT_EQ(select(mesh, "quarter", 3, false, [](const Vec3<double>& x) { return x[2] < 0.375 + 1e-9; }).cells.size(), 6u);
}

TEST(Mesh, RefusesEmptyAndImpossibleRegions) {
  const Mesh mesh = box("tetrahedron");
  const auto nowhere = [](const Vec3<double>&) { return false; };
  EXPECT_TRUE(contains(message([&] { select(mesh, "film", 2, true, nowhere); }), "Region \"film\" is empty: no face of the boundary"));
  EXPECT_TRUE(contains(message([&] { select(mesh, "film", 4, false, nowhere); }), "dimension 4"));
  EXPECT_TRUE(contains(message([&] { select(mesh, "film", 3, true, nowhere); }), "cells on the boundary"));
}

TEST(Mesh, SelectsTheNodeNearestToAPoint) {
  const Mesh mesh = box("hexahedron", 2);
  for (const bool boundary : {false, true}) {
    const Region corner = nearest_node(mesh, "corner", boundary, {{1.01, 0.98, 1}});
    ASSERT_EQ(corner.cells.size(), 1u);
    EXPECT_EQ(corner.dim, 0);
    EXPECT_LT(norm2(mesh.nodes[static_cast<std::size_t>(corner.cells[0].nodes[0])] - Vec3<double>{{1, 1, 1}}), 1e-20);
  }
  EXPECT_TRUE(contains(message([&] {
                         nearest_node(mesh, "tip", true, {{0, 0.5 / 3, 0}});
                       }),
                       "Region \"tip\": the nodes at (0, 0, 0) and (0, 0.333333, 0) are"));
  EXPECT_TRUE(contains(message([&] { nearest_node(mesh, "tip", false, {{10, 1, 1}}); }), "is at (1, 1, 1), 9 away, which is more than the size"));
}

TEST(Mesh, NamesTheNearestRegion) {
  const std::string what = message([] { box("tetrahedron").region("botom"); });
  EXPECT_TRUE(contains(what, "There is no region \"botom\""));
  EXPECT_TRUE(contains(what, "Did you mean \"bottom\"?"));
}

TEST(Mesh, RefusesCellsWithAVertexTwice) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.nodes.resize(3);
  mesh.cells = {{CellKind::triangle, 1, {0, 1, 0}, {}}};
  EXPECT_TRUE(contains(message([&] { check_identity(mesh); }), "twice"));
}

TEST(Mesh, RefusesTwoCellsWithTheSameVertices) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.nodes.resize(3);
  mesh.cells = {{CellKind::triangle, 1, {0, 1, 2}, {}}, {CellKind::triangle, 1, {2, 1, 0}, {}}};
  EXPECT_TRUE(contains(message([&] { check_identity(mesh); }), "same vertices"));
}

TEST(Mesh, RefusesTwoDifferentEdgesBetweenTheSameVertices) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.nodes.resize(10);
  mesh.cells = {{CellKind::triangle, 2, {0, 1, 2, 4, 5, 6}, {}}, {CellKind::triangle, 2, {1, 0, 3, 7, 8, 9}, {}}};
  EXPECT_TRUE(contains(message([&] { check_identity(mesh); }), "Two different edges"));
  mesh.cells[1].nodes[3] = 4;
  EXPECT_NO_THROW(check_identity(mesh));
}

TEST(Mesh, GeometryJetOfACurvedCellMatchesDifferences) {
  const Mesh mesh = generate({"sphere", {{"cells", {1}}, {"order", {3}}}, {}});
  const Vec3<double> xi{{0.3, 0.2, 0}};
  const Cell& cell = mesh.cells[3];
  const GeometryJet jet = geometry(mesh, cell, xi);
  const double h = 1e-4;
  const auto at = [&](double s, double t) { return geometry(mesh, cell, {{xi[0] + s, xi[1] + t, 0}}).x; };
  EXPECT_LT(norm2(1 / (2 * h) * (at(h, 0) - at(-h, 0)) - jet.d[0]), 1e-14);
  EXPECT_LT(norm2(1 / (h * h) * (at(h, 0) - 2 * at(0, 0) + at(-h, 0)) - jet.dd[0]), 1e-10);
  EXPECT_LT(norm2(1 / (4 * h * h) * (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) - jet.dd[1]), 1e-10);
  EXPECT_LT(norm2(1 / (h * h) * (at(0, h) - 2 * at(0, 0) + at(0, -h)) - jet.dd[3]), 1e-10);
}

}  // namespace
}  // namespace karcher
