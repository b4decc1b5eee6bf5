#include "karcher/mesh/locate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"
#include "mesh/cells.hpp"
#include "mesh/measure.hpp"

namespace karcher {
namespace {

TEST(Locate, FindsThePlaceOfEveryPointOfCurvedCells) {
  std::mt19937 random(5);
  for (double order : {1.0, 2.0, 3.0}) {
    std::vector<Mesh> meshes = {generate({"interval", {{"cells", {4}}, {"order", {order}}}, {}}),
                                generate({"torus", {{"cells", {8, 6}}, {"order", {order}}}, {}}),
                                generate({"cylinder", {{"cells", {8, 3}}, {"order", {order}}}, {{"shape", "quadrilateral"}}}),
                                generate({"box", {{"cells", {2, 2, 2}}, {"order", {order}}}, {}}),
                                generate({"box", {{"cells", {2, 2, 2}}, {"order", {order}}}, {{"shape", "hexahedron"}}})};
    for (Mesh& mesh : meshes) {
      if (mesh.dim == 3)
        for (auto& x : mesh.nodes) x[0] += 0.2 * x[1] * x[1];  // curved faces
      for (std::size_t c = 0; c < mesh.cells.size(); c += 5) {
        const Vec3<double> xi = random_point(mesh.cells[c].kind, random), x = geometry(mesh, mesh.cells[c], xi).x;
        const Location found = locate(mesh, mesh.region("all"), x);
        EXPECT_EQ(found.cell, static_cast<int>(c));
        EXPECT_LT(found.distance, 1e-12);
        EXPECT_LT(norm2(found.xi - xi), 1e-18);
      }
    }
  }
}

TEST(Locate, FindsVerticesEdgesAndCornersExactly) {
  const Mesh mesh = generate({"box", {{"cells", {3, 3, 3}}, {"size", {3, 3, 3}}}, {}});
  for (const Vec3<double>& x : {Vec3<double>{{0, 0, 0}}, Vec3<double>{{3, 3, 3}}, Vec3<double>{{3, 1.5, 0}}, Vec3<double>{{1, 1, 1}}}) {
    const Location found = locate(mesh, mesh.region("all"), x);
    EXPECT_LT(norm2(geometry(mesh, mesh.cells[static_cast<std::size_t>(found.cell)], found.xi).x - x), 1e-28);
  }
}

TEST(Locate, ProjectsPointsNearASurfaceOntoIt) {
  const Mesh mesh = generate({"cylinder", {{"cells", {24, 4}}, {"order", {3}}}, {}});
  const double angle = 0.7;
  const Location found = nearest(mesh, mesh.region("all"), {{2 * std::cos(angle), 2 * std::sin(angle), 0.3}});
  const Vec3<double> x = geometry(mesh, mesh.cells[static_cast<std::size_t>(found.cell)], found.xi).x;
  EXPECT_NEAR(found.distance, 1, 1e-5);
  EXPECT_NEAR(std::atan2(x[1], x[0]), angle, 1e-4);
  EXPECT_NEAR(x[2], 0.3, 1e-6);
}

TEST(Locate, TakesAPointOfTheExactSurfaceOnAMeshOfStraightCells) {
  const Mesh mesh = generate({"cylinder", {{"cells", {16, 4}}}, {}});
  const double angle = std::numbers::pi / 16;  // midway along an edge, at its largest distance
  EXPECT_NO_THROW(locate(mesh, mesh.region("all"), {{std::cos(angle), std::sin(angle), 0.3}}));
}

TEST(Locate, RefusesPointsOutsideWithDistanceAndPlace) {
  const Mesh mesh = generate({"box", {{"cells", {2, 2, 2}}}, {}});
  try {
    locate(mesh, mesh.region("all"), {{0.5, 0.5, 1.5}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              "The point (0.5, 0.5, 1.5) lies outside the region \"all\": the nearest place is (0.5, 0.5, 1), at a distance of 0.5.");
  }
  EXPECT_NO_THROW(locate(mesh, mesh.region("back"), {{0.2, 0.7, 1}}));
  EXPECT_THROW(locate(mesh, mesh.region("back"), {{0.2, 0.7, 0.5}}), InputError);
  EXPECT_THROW(locate(mesh, {"none", 2, {}}, {{0, 0, 0}}), InputError);
}

TEST(Locate, RefusesPointsWhoseSquaredDistanceOverflowsAndPointsThatAreNotFinite) {
  const Mesh mesh = generate({"box", {{"cells", {2, 2, 2}}}, {}});
  const auto told = [&](const Vec3<double>& x) {
    try {
      locate(mesh, mesh.region("all"), x);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(told({{0, 1e155, 0}}).find("at a distance of 1e+155."), std::string::npos) << told({{0, 1e155, 0}});
  EXPECT_NE(told({{0, 1e308, 0}}).find("at a distance of 1e+308."), std::string::npos) << told({{0, 1e308, 0}});
  EXPECT_EQ(told({{std::nan(""), 0, 0}}), "The point (nan, 0, 0) is not finite.");
  const double far = std::numeric_limits<double>::infinity();
  EXPECT_EQ(told({{0, far, 0}}), "The point (0, inf, 0) is not finite.");
}

TEST(Locate, FindsTheSameNearestCellAsALookAtEveryOne) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-2, 2);
  const Mesh mesh = generate({"torus", {{"cells", {16, 9}}, {"order", {2}}}, {}});
  const Region& all = mesh.region("all");
  const Locator locator(mesh, all);
  for (int sample = 0; sample < 50; ++sample) {
    const Vec3<double> x{{any(random), any(random), any(random)}};
    double least = std::numeric_limits<double>::infinity();
    for (const Cell& cell : all.cells) least = std::min(least, nearest(mesh, {"one", 2, {cell}}, x).distance);
    EXPECT_NEAR(locator.nearest(x).distance, least, 1e-14);
  }
}

TEST(Locate, TellsAllCellsAtAPlaceAlsoThoseOfOtherSheets) {
  const Mesh flat = generate({"rectangle", {{"cells", {2, 2}}, {"size", {2, 2}}}, {{"shape", "quadrilateral"}}});
  Mesh mesh = flat;  // and a second sheet across it, which shares no node with it
  for (Vec3<double> x : flat.nodes) mesh.nodes.push_back({{x[0], 1, x[1] - 1}});
  for (Cell c : flat.cells) {
    for (int& n : c.nodes) n += static_cast<int>(flat.nodes.size());
    mesh.cells.push_back(c);
  }
  mesh.regions["all"].cells = mesh.cells;
  const Locator locator(mesh, mesh.region("all"));
  const auto cells = [&](const Vec3<double>& x) {
    std::vector<int> found;
    for (const Location& l : locator.all_nearest(x)) found.push_back(l.cell);
    return found;
  };
  EXPECT_EQ(cells({{0.5, 0.5, 0}}), (std::vector{0}));
  EXPECT_EQ(cells({{1, 0.5, 0}}), (std::vector{0, 1}));
  EXPECT_EQ(cells({{1, 1, 0}}).size(), 8u);
  EXPECT_EQ(cells({{0.5, 1, 0.3}}), (std::vector{6}));
}

}  // namespace
}  // namespace karcher
