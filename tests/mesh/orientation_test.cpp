#include "karcher/mesh/orientation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "karcher/mesh/generators.hpp"

namespace karcher {
namespace {

Mesh mesh_of(const std::string& name, std::map<std::string, std::vector<double>> numbers, const std::string& shape = "") {
  GeneratorOptions options{name, std::move(numbers), {}};
  if (!shape.empty()) options.words["shape"] = shape;
  return generate(options);
}

/// Turns every third cell of a surface over.
void turn_some(std::vector<Cell>& cells) {
  for (std::size_t c = 0; c < cells.size(); c += 3) std::reverse(cells[c].nodes.begin() + 1, cells[c].nodes.begin() + vertex_count(cells[c].kind));
}

Vec3<double> vertex_normal(const Mesh& mesh, const Cell& cell) {
  const auto x = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(cell.nodes[i])]; };
  return cross(x(1) - x(0), x(2) - x(0));
}

TEST(Orientation, MakesTheNormalsOfASphereWithTurnedCellsPointToOneSide) {
  Mesh mesh = mesh_of("sphere", {{"cells", {4}}, {"order", {1}}});
  turn_some(mesh.cells);
  mesh.regions["all"].cells = mesh.cells;
  const Orientation orientation(mesh, mesh.region("all"));
  ASSERT_TRUE(orientation.exists());
  int outwards = 0, turned = 0;
  for (const Cell& cell : mesh.cells) {
    outwards += dot(orientation.sign(cell) * vertex_normal(mesh, cell), mesh.nodes[static_cast<std::size_t>(cell.nodes[0])]) > 0;
    turned += orientation.sign(cell) < 0;
  }
  EXPECT_TRUE(outwards == 0 || outwards == static_cast<int>(mesh.cells.size())) << outwards;
  EXPECT_GT(turned, 0);
  EXPECT_EQ(orientation.sign(mesh.cells.front()), 1);  // the first cell says which side
}

TEST(Orientation, DoesNotExistOnOneSidedSurfacesNorWhereThreeSheetsMeet) {
  for (const char* one_sided : {"moebius", "klein-bottle"}) {
    const Mesh mesh = mesh_of(one_sided, {{"cells", {12, 6}}, {"order", {1}}});
    EXPECT_FALSE(Orientation(mesh, mesh.region("all")).exists()) << one_sided;
  }
  for (const char* two_sided : {"torus", "cylinder", "rectangle"}) {
    const Mesh mesh = mesh_of(two_sided, {{"cells", {12, 6}}, {"order", {1}}});
    EXPECT_TRUE(Orientation(mesh, mesh.region("all")).exists()) << two_sided;
  }
  Mesh sheets;
  sheets.dim = 2;
  sheets.nodes = {{{0, 0, 0}}, {{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}, {{-1, 0, 0}}};
  for (const int tip : {2, 3, 4}) sheets.cells.push_back({CellKind::triangle, 1, {0, 1, tip}, {}});
  EXPECT_FALSE(Orientation(sheets, {"all", 2, sheets.cells}).exists());
}

TEST(Orientation, PointsOutOfASolidWhateverTheOrderOfTheVertices) {
  for (const char* shape : {"tetrahedron", "hexahedron"}) {
    const Mesh mesh = mesh_of("box", {{"cells", {2, 2, 2}}, {"order", {1}}}, shape);
    Region boundary{"skin", 2, boundary_facets(mesh)};
    turn_some(boundary.cells);
    const Orientation orientation(mesh, boundary);
    ASSERT_TRUE(orientation.exists());
    Vec3<double> middle;
    for (const auto& x : mesh.nodes) middle += (1.0 / static_cast<double>(mesh.nodes.size())) * x;
    for (const Cell& cell : boundary.cells)
      EXPECT_GT(dot(orientation.sign(cell) * vertex_normal(mesh, cell), mesh.nodes[static_cast<std::size_t>(cell.nodes[0])] - middle), 0) << shape;
  }
}

TEST(Orientation, OfCurvesInThePlanePointsOutAndFollowsTheFirstLineElsewhere) {
  const Mesh mesh = mesh_of("disc", {{"cells", {2}}, {"order", {1}}}, "quadrilateral");
  Region boundary{"rim", 1, boundary_facets(mesh)};
  for (std::size_t c = 0; c < boundary.cells.size(); c += 3) std::swap(boundary.cells[c].nodes[0], boundary.cells[c].nodes[1]);
  const Orientation outwards(mesh, boundary);
  for (const Cell& cell : boundary.cells) {
    const Vec3<double>&a = mesh.nodes[static_cast<std::size_t>(cell.nodes[0])], &b = mesh.nodes[static_cast<std::size_t>(cell.nodes[1])];
    EXPECT_GT(outwards.sign(cell) * dot(cross(b - a, Vec3<double>{{0, 0, 1}}), a + b), 0);
  }
  const Mesh line = mesh_of("interval", {{"cells", {4}}, {"order", {1}}});
  Region turned = line.region("all");
  std::swap(turned.cells[2].nodes[0], turned.cells[2].nodes[1]);
  const Orientation one_way(line, turned);
  ASSERT_TRUE(one_way.exists());
  for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(one_way.sign(turned.cells[c]), c == 2 ? -1 : 1);
}

}  // namespace
}  // namespace karcher
