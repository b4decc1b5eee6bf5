#include "karcher/field/space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"

namespace karcher {
namespace {

std::shared_ptr<const Mesh> make(const std::string& name, std::map<std::string, std::vector<double>> numbers, const std::string& shape) {
  return std::make_shared<const Mesh>(generate({name, std::move(numbers), {{"shape", shape}}}));
}
std::shared_ptr<const Mesh> box(const char* shape, double order = 1) { return make("box", {{"cells", {2, 3, 2}}, {"order", {order}}}, shape); }

TEST(Space, CountsNodesOfEveryOrder) {
  for (int p = 1; p <= 3; ++p) {
    for (const char* shape : {"tetrahedron", "hexahedron"}) {
      const auto mesh = box(shape);
      EXPECT_EQ(Space(mesh, mesh->region("all"), p).node_count(), (2 * p + 1) * (3 * p + 1) * (2 * p + 1)) << shape << p;
      EXPECT_EQ(Space(mesh, mesh->region("left"), p).node_count(), (3 * p + 1) * (2 * p + 1)) << shape << p;
    }
    const auto bottle = make("klein-bottle", {{"cells", {6, 5}}}, "triangle");
    EXPECT_EQ(Space(bottle, bottle->region("all"), p).node_count(), 30 * p * p);  // Euler characteristic 0: 30 vertices, 90 edges, 60 triangles
  }
}

TEST(Space, NodesLieOnTheGeometryWhereTheReferenceNodesAre) {
  for (int geometry_order = 1; geometry_order <= 3; ++geometry_order)
    for (int p = 1; p <= 3; ++p) {
      const auto mesh = make("torus", {{"cells", {5, 4}}, {"order", {static_cast<double>(geometry_order)}}}, "quadrilateral");
      const Space space(mesh, mesh->region("all"), p);
      for (std::size_t c = 0; c < mesh->cells.size(); ++c) {
        const auto& nodes = space.cell_nodes(static_cast<int>(c));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const Vec3<double> x = geometry(*mesh, mesh->cells[c], lagrange_nodes(mesh->cells[c].kind, p)[i]).x;
          EXPECT_LT(norm2(space.position(nodes[i]) - x), 1e-28);  // through every cell that has the node
        }
      }
    }
}

TEST(Space, SharesNodesBetweenASolidAndItsBoundary) {
  for (const char* shape : {"tetrahedron", "hexahedron"})
    for (int p = 1; p <= 3; ++p) {
      const auto mesh = box(shape, 2);
      const Space solid(mesh, mesh->region("all"), p), face(mesh, mesh->region("back"), p);
      std::set<NodeKey> solid_keys;
      for (int n = 0; n < solid.node_count(); ++n) solid_keys.insert(solid.key(n));
      EXPECT_EQ(static_cast<int>(solid_keys.size()), solid.node_count());
      for (int n = 0; n < face.node_count(); ++n) EXPECT_TRUE(solid_keys.contains(face.key(n)));
      for (std::size_t c = 0; c < face.region().cells.size(); ++c) {
        const auto in_solid = solid.entity_nodes(face.region().cells[c]);
        const auto& in_face = face.cell_nodes(static_cast<int>(c));
        ASSERT_EQ(in_solid.size(), in_face.size());
        for (std::size_t i = 0; i < in_solid.size(); ++i) {
          EXPECT_EQ(solid.key(in_solid[i]), face.key(in_face[i]));
          EXPECT_LT(norm2(solid.position(in_solid[i]) - face.position(in_face[i])), 1e-28);
        }
      }
    }
}

TEST(Space, NodesOfAFacetAreTheSameThroughBothCellsWhateverTheirOrientation) {
  std::mt19937 random(2);
  // Hexahedra and tetrahedra with randomly turned vertices: rotations of the reference cell, and new numbers of all vertices.
  for (const char* shape : {"tetrahedron", "hexahedron"}) {
    Mesh mesh = *box(shape);
    std::vector<int> number(mesh.nodes.size());
    for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<int>(i);
    std::shuffle(number.begin(), number.end(), random);
    std::vector<Vec3<double>> moved(mesh.nodes.size());
    for (std::size_t i = 0; i < number.size(); ++i) moved[static_cast<std::size_t>(number[i])] = mesh.nodes[i];
    mesh.nodes = moved;
    const std::array<std::array<int, 8>, 2> hexahedron_turns = {{{1, 2, 3, 0, 5, 6, 7, 4}, {4, 5, 1, 0, 7, 6, 2, 3}}};
    const std::array<std::array<int, 4>, 2> tetrahedron_turns = {{{1, 2, 0, 3}, {0, 2, 3, 1}}};
    for (Cell& c : mesh.cells) {
      for (int& n : c.nodes) n = number[static_cast<std::size_t>(n)];
      for (int k = 0; k < 6; ++k) {
        const std::size_t turn = random() % 2;
        const std::vector<int> old = c.nodes;
        for (std::size_t v = 0; v < old.size(); ++v)
          c.nodes[v] = old[static_cast<std::size_t>(shape[0] == 'h' ? hexahedron_turns[turn][v] : tetrahedron_turns[turn][v])];
      }
    }
    mesh.regions.clear();
    mesh.regions["all"] = {"all", 3, mesh.cells};
    const auto shared = std::make_shared<const Mesh>(mesh);
    for (int p = 1; p <= 3; ++p) {
      const Space space(shared, shared->region("all"), p);
      EXPECT_EQ(space.node_count(), (2 * p + 1) * (3 * p + 1) * (2 * p + 1));
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const auto& nodes = space.cell_nodes(static_cast<int>(c));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const Vec3<double> x = geometry(mesh, mesh.cells[c], lagrange_nodes(mesh.cells[c].kind, p)[i]).x;
          EXPECT_LT(norm2(space.position(nodes[i]) - x), 1e-28);
        }
      }
    }
  }
}

TEST(Space, KeysOfDifferentOrdersCoincideOnlyAtCommonPlaces) {
  const auto mesh = make("rectangle", {{"cells", {2, 2}}}, "triangle");
  const auto keys = [&](int p) {
    const Space space(mesh, mesh->region("all"), p);
    std::set<NodeKey> all;
    for (int n = 0; n < space.node_count(); ++n) all.insert(space.key(n));
    return all;
  };
  const auto one = keys(1), two = keys(2), three = keys(3);
  EXPECT_TRUE(std::includes(two.begin(), two.end(), one.begin(), one.end()));
  EXPECT_TRUE(std::includes(three.begin(), three.end(), one.begin(), one.end()));
  std::vector<NodeKey> common;
  std::set_intersection(two.begin(), two.end(), three.begin(), three.end(), std::back_inserter(common));
  EXPECT_EQ(common.size(), one.size());
}

TEST(Space, CarriesThePartsOfItsCellsAndNothingElse) {
  const auto mesh = box("tetrahedron");
  for (int p = 1; p <= 3; ++p) {
    const Space left(mesh, mesh->region("left"), p);
    for (const Cell& c : mesh->region("right").cells) EXPECT_TRUE(left.entity_nodes(c).empty());
    for (const Cell& c : mesh->cells) EXPECT_TRUE(left.entity_nodes(c).empty());
    for (int d = 0; d <= 1; ++d) {
      const Region parts = select(*mesh, "edges", d, true, [](const Vec3<double>& x) { return x[0] < 1e-9; });
      EXPECT_EQ(parts.cells.size(), d == 0 ? 12u : 23u);  // of 3 by 2 squares, cut into triangles
      for (const Cell& e : parts.cells) EXPECT_EQ(left.entity_nodes(e).size(), static_cast<std::size_t>(node_count(e.kind, p)));
    }
  }
  // Three edges around a triangle do not make the triangle theirs.
  const auto sheet = make("rectangle", {{"cells", {1, 1}}}, "triangle");
  const Space frame(sheet, Region{"edges", 1, entities(*sheet, 1, false)}, 1);
  EXPECT_TRUE(frame.entity_nodes(sheet->cells[0]).empty());
}

TEST(Space, CarriesNoDiagonalsAndNoHalvesOfFacesThoughItHasTheirCorners) {
  const auto solid = box("hexahedron"), sheet = make("rectangle", {{"cells", {2, 2}}}, "quadrilateral");
  const auto part = [](const Mesh& mesh, CellKind kind, const std::vector<int>& corners) {
    Cell entity;
    entity.kind = kind;
    for (const int v : corners) entity.nodes.push_back(mesh.cells[0].nodes[static_cast<std::size_t>(v)]);
    return entity;
  };
  const Space in_space(solid, solid->region("all"), 1), in_plane(sheet, sheet->region("all"), 1);
  EXPECT_EQ(in_plane.entity_nodes(part(*sheet, CellKind::line, {0, 1})).size(), 2u);
  EXPECT_EQ(in_space.entity_nodes(part(*solid, CellKind::line, {2, 6})).size(), 2u);
  EXPECT_EQ(in_space.entity_nodes(part(*solid, CellKind::quadrilateral, {2, 3, 7, 6})).size(), 4u);
  EXPECT_TRUE(in_plane.entity_nodes(part(*sheet, CellKind::line, {0, 2})).empty());
  EXPECT_TRUE(in_plane.entity_nodes(part(*sheet, CellKind::triangle, {0, 1, 2})).empty());
  EXPECT_TRUE(in_space.entity_nodes(part(*solid, CellKind::line, {0, 2})).empty());
  EXPECT_TRUE(in_space.entity_nodes(part(*solid, CellKind::line, {0, 6})).empty());
  EXPECT_TRUE(in_space.entity_nodes(part(*solid, CellKind::triangle, {0, 1, 2})).empty());
  EXPECT_TRUE(in_space.entity_nodes(part(*solid, CellKind::quadrilateral, {0, 1, 7, 6})).empty());
}

TEST(Space, RefusesOtherOrdersAndEmptyRegions) {
  const auto mesh = box("hexahedron");
  for (const int order : {0, 4}) try {
      Space(mesh, mesh->region("all"), order);
      ADD_FAILURE() << order;
    } catch (const InputError& e) {
      EXPECT_EQ(e.what(), "A field has order 1, 2 or 3, not " + std::to_string(order) + ".");
    }
  EXPECT_THROW(Space(mesh, Region{"nothing", 2, {}}, 1), InputError);
}

}  // namespace
}  // namespace karcher
