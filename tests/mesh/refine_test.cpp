#include "karcher/mesh/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "karcher/mesh/generators.hpp"
#include "mesh/cells.hpp"
#include "mesh/measure.hpp"

namespace karcher {
namespace {

std::vector<Mesh> samples(double order) {
  std::vector<Mesh> meshes;
  meshes.push_back(generate({"interval", {{"cells", {3}}, {"order", {order}}}, {}}));
  for (const char* shape : {"triangle", "quadrilateral"}) {
    meshes.push_back(generate({"rectangle", {{"cells", {3, 2}}, {"order", {order}}}, {{"shape", shape}}}));
    meshes.push_back(generate({"klein-bottle", {{"cells", {6, 5}}, {"order", {order}}}, {{"shape", shape}}}));
    meshes.push_back(generate({"moebius", {{"cells", {5, 2}}, {"order", {order}}}, {{"shape", shape}}}));
  }
  for (const char* shape : {"tetrahedron", "hexahedron"})
    meshes.push_back(generate({"box", {{"cells", {2, 1, 2}}, {"size", {1, 2, 3}}, {"order", {order}}}, {{"shape", shape}}}));
  return meshes;
}

/// Number of geometry nodes of a conforming mesh from its vertices, edges, faces and cells.
std::size_t conforming_nodes(const Mesh& mesh, int p) {
  std::size_t nodes = entities(mesh, 0, false).size();
  for (int d = 1; d <= mesh.dim; ++d)
    for (const Cell& c : entities(mesh, d, false)) {
      const auto power = static_cast<std::size_t>(p - 1);
      switch (c.kind) {
        case CellKind::line:
          nodes += power;
          break;
        case CellKind::triangle:
          nodes += p == 3 ? 1 : 0;
          break;
        case CellKind::quadrilateral:
          nodes += power * power;
          break;
        case CellKind::hexahedron:
          nodes += power * power * power;
          break;
        default:
          break;
      }
    }
  return nodes;
}

TEST(Refine, MakesTwoFourOrEightChildrenWithoutHangingNodes) {
  for (int p = 1; p <= 3; ++p)
    for (const Mesh& mesh : samples(p)) {
      const Refinement r = refine(mesh);
      const Mesh& fine = r.mesh;
      EXPECT_EQ(fine.cells.size(), mesh.cells.size() << mesh.dim);
      EXPECT_EQ(fine.nodes.size(), conforming_nodes(fine, p)) << name(mesh.cells[0].kind) << p;
      EXPECT_EQ(euler_characteristic(fine), euler_characteristic(mesh));
      EXPECT_EQ(boundary_facets(fine).size(), boundary_facets(mesh).size() << (mesh.dim - 1));
      EXPECT_NO_THROW(check_identity(fine));
      // Vertices of the fine mesh: those of the coarse one and one per edge, quadrilateral and hexahedron.
      std::size_t expected = entities(mesh, 0, false).size() + entities(mesh, 1, false).size();
      for (int d = 2; d <= mesh.dim; ++d)
        for (const Cell& c : entities(mesh, d, false)) expected += c.kind == CellKind::quadrilateral || c.kind == CellKind::hexahedron;
      EXPECT_EQ(entities(fine, 0, false).size(), expected);
    }
}

TEST(Refine, KeepsTheShapeOfMeshesWithoutParametrisation) {
  for (int p = 1; p <= 3; ++p) {
    Mesh mesh = generate({"sphere", {{"cells", {1}}, {"order", {static_cast<double>(p)}}}, {}});
    mesh.parametrisation = {};
    EXPECT_NEAR(measure(refine(mesh).mesh, 20), measure(mesh, 30), 1e-9) << p;
  }
}

TEST(Refine, KeepsVolumeAndOrientationOfSolids) {
  for (const char* shape : {"tetrahedron", "hexahedron"}) {
    Mesh mesh = generate({"box", {{"cells", {1, 1, 1}}, {"order", {2}}}, {{"shape", shape}}});
    for (auto& x : mesh.nodes) x = Vec3<double>{{x[0] + 0.1 * x[1] * x[2], x[1] + 0.1 * x[0] * x[0], x[2] - 0.05 * x[0] * x[1]}};
    const double volume = measure(mesh, 8);
    const Mesh fine = refine(refine(mesh).mesh).mesh;
    EXPECT_NEAR(measure(fine, 8), volume, 1e-14);
    for (const Cell& c : fine.cells)
      for (const auto& xi : quadrature(c.kind, 3).points) EXPECT_GT(jacobian(geometry(fine, c, xi), 3), 0);
  }
}

/// Largest distance of a node of a from the nearest node of b.
double farthest(const Mesh& a, const Mesh& b) {
  double distance2 = 0;
  for (const auto& x : a.nodes) {
    double nearest = 1;
    for (const auto& y : b.nodes) nearest = std::min(nearest, norm2(x - y));
    distance2 = std::max(distance2, nearest);
  }
  return std::sqrt(distance2);
}

TEST(Refine, MakesTheMeshThatTheGeneratorMakesWithTwiceTheCells) {
  for (double order : {1.0, 2.0, 3.0}) {
    const auto check = [&](const char* name, std::vector<double> cells, std::map<std::string, std::string> shape) {
      const Mesh refined = refine(generate({name, {{"cells", cells}, {"order", {order}}}, shape})).mesh;
      for (double& n : cells) n *= 2;
      const Mesh direct = generate({name, {{"cells", cells}, {"order", {order}}}, shape});
      EXPECT_EQ(refined.nodes.size(), direct.nodes.size()) << name;
      EXPECT_LT(farthest(refined, direct), 1e-14) << name;
      EXPECT_LT(farthest(direct, refined), 1e-14) << name;
    };
    check("sphere", {2}, {});
    for (const char* shape : {"triangle", "quadrilateral"}) {
      for (const char* name : {"klein-bottle", "moebius", "torus", "cylinder", "helicoid", "annulus"}) check(name, {5, 4}, {{"shape", shape}});
      check("disc", {2}, {{"shape", shape}});
    }
  }
}

TEST(Refine, RegionsGoAlongAndStayPartsOfTheMesh) {
  for (const char* shape : {"tetrahedron", "hexahedron"}) {
    Mesh mesh = generate({"box", {{"cells", {2, 2, 2}}, {"order", {2}}}, {{"shape", shape}}});
    mesh.regions["edge"] = select(mesh, "edge", 1, true, [](const Vec3<double>& x) { return x[0] < 1e-9 && x[1] < 1e-9; });
    mesh.regions["corner"] = select(mesh, "corner", 0, true, [](const Vec3<double>& x) { return norm2(x) < 1e-9; });
    mesh.regions["half"] = select(mesh, "half", 3, false, [](const Vec3<double>& x) { return x[0] < 0.5 + 1e-9; });
    const Refinement r = refine(mesh);
    EXPECT_NEAR(measure(r.mesh, r.mesh.region("left").cells), 1, 1e-14);
    EXPECT_NEAR(measure(r.mesh, r.mesh.region("half").cells), 0.5, 1e-13);
    EXPECT_NEAR(measure(r.mesh, r.mesh.region("edge").cells), 1, 1e-14);
    EXPECT_EQ(r.mesh.region("corner").cells.size(), 1u);
    EXPECT_EQ(r.mesh.region("all").cells.size(), r.mesh.cells.size());
    // The refined regions are the ones that the refined mesh selects.
    const auto nodes_of = [](const std::vector<Cell>& cells) {
      std::set<std::set<int>> all;
      for (const Cell& c : cells) all.insert({c.nodes.begin(), c.nodes.end()});
      return all;
    };
    const auto low_x = [](const Vec3<double>& x) { return x[0] <= 0; };
    EXPECT_EQ(nodes_of(r.mesh.region("left").cells), nodes_of(select(r.mesh, "left", 2, true, low_x).cells));
  }
}

TEST(Refine, TellsWhereEveryChildLiesInItsParent) {
  std::mt19937 random(3);
  for (int p = 1; p <= 3; ++p)
    for (Mesh mesh : samples(p)) {
      mesh.parametrisation = {};  // then the fine geometry is the coarse one
      const Refinement r = refine(mesh);
      for (const auto& [region, children] : r.children) {
        ASSERT_EQ(children.size(), r.mesh.region(region).cells.size());
        for (std::size_t c = 0; c < children.size(); ++c) {
          const Cell& child = r.mesh.region(region).cells[c];
          const Cell& parent = mesh.region(region).cells[static_cast<std::size_t>(children[c].parent)];
          const Vec3<double> xi = random_point(child.kind, random);
          const Vec3<double> fine = geometry(r.mesh, child, xi).x, coarse = geometry(mesh, parent, in_parent(children[c], child.kind, xi)).x;
          EXPECT_LT(norm2(fine - coarse), 1e-26) << region << p;
        }
      }
    }
}

TEST(Refine, TetrahedraKeepTheirShapeUnderManyRefinements) {
  Mesh mesh;
  mesh.dim = 3;
  mesh.nodes = {{{0, 0, 0}}, {{1, 0.1, 0}}, {{0.3, 0.9, 0.1}}, {{0.2, 0.4, 1.2}}};
  mesh.cells = {{CellKind::tetrahedron, 1, {0, 1, 2, 3}, {}}};
  const auto worst = [](const Mesh& m) {  // volume over longest edge cubed
    double w = 1;
    for (const Cell& c : m.cells) {
      double longest = 0;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j)
          longest = std::max(longest, std::sqrt(norm2(m.nodes[static_cast<std::size_t>(c.nodes[static_cast<std::size_t>(i)])] -
                                                      m.nodes[static_cast<std::size_t>(c.nodes[static_cast<std::size_t>(j)])])));
      w = std::min(w, measure(m, {c}, 1) / std::pow(longest, 3));
    }
    return w;
  };
  const double start = worst(mesh);
  for (int level = 0; level < 4; ++level) mesh = refine(mesh).mesh;
  EXPECT_GT(worst(mesh), 0.35 * start);
}

}  // namespace
}  // namespace karcher
