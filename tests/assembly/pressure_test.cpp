#include "karcher/energy/pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assembly/map_problem.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using testing::MapProblem;
using Point3 = Vec3<double>;

constexpr double p = 1.7;

/// The deformation is the position of the nodes, moved at random by up to `amount` and shifted.
MapProblem under_pressure(const std::string& generator, std::map<std::string, std::vector<double>> numbers, int order, const std::string& region,
                          const std::string& shape = "", double amount = 0, const Point3& shift = {}) {
  const bool plane = generator == "disc";
  const ManifoldOps& manifold = plane ? manifold_ops<Euclidean<2>>() : manifold_ops<Euclidean<3>>();
  MapProblem problem(testing::moved_mesh(generator, std::move(numbers), shape), manifold, Rule::projection, order, region);
  karcher::Random random(2);
  for (int n = 0; n < problem.space().node_count(); ++n)
    for (int i = 0; i < manifold.ambient; ++i)
      problem.u.values[0].push_back(problem.space().position(n)[i] + shift[i] + random.uniform(-amount, amount));
  problem.input.parameters["value"] = p;
  problem.make("pressure-load");
  return problem;
}
double energy(const MapProblem& problem) { return problem.functional->energy(problem.u).energy; }
std::vector<double> gradient(const MapProblem& problem) {
  std::vector<double> g(problem.dofs());
  problem.functional->gradient(problem.u, g);
  return g;
}
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
  return largest;
}

TEST(Pressure, HasTheVolumeOfClosedSurfacesWhereverTheyLie) {
  const Point3 far{{30, -20, 50}};
  for (const char* shape : {"tetrahedron", "hexahedron"})
    for (const Point3& shift : {Point3{}, far})
      EXPECT_NEAR(energy(under_pressure("box", {{"cells", {2, 1, 1}}, {"size", {2, 3, 0.5}}}, 2, "boundary", shape, 0, shift)), 3 * p, 1e-11);
  // Up to the interpolation of the geometry.
  const MapProblem sphere = under_pressure("sphere", {{"cells", {4}}, {"order", {3}}}, 3, "all");
  EXPECT_NEAR(energy(sphere), 4 * std::numbers::pi / 3 * p, 5e-4);
  for (const char* shape : {"triangle", "quadrilateral"}) {
    const MapProblem disc = under_pressure("disc", {{"cells", {4}}, {"order", {3}}}, 3, "boundary", shape, 0, far);
    EXPECT_NEAR(energy(disc), std::numbers::pi * p, 1e-4) << shape;
  }
}

TEST(Pressure, IsExactForPolynomialsOnAMovedSurface) {
  // Random nodes: the volume must not change with the place, which it would with a quadrature that is not exact.
  for (const char* shape : {"tetrahedron", "hexahedron"})
    for (const int order : {1, 2, 3}) {
      const auto at = [&](const Point3& shift) {
        MapProblem problem = under_pressure("box", {{"cells", {1, 1, 1}}}, order, "boundary", shape, 0.2, shift);
        problem.input.quadrature_degree = {{CellKind::triangle, 1}, {CellKind::quadrilateral, 1}};
        problem.make("pressure-load");
        return energy(problem);
      };
      EXPECT_NEAR(at({}), at(Point3{{1, -2, 3}}), 1e-12) << shape << order;
    }
}

TEST(Pressure, ObeysTheLawsOfAnEnergy) {
  for (const auto& [generator, region, shape, order] : {std::tuple("box", "boundary", "hexahedron", 2),
                                                        {"box", "top", "tetrahedron", 1},
                                                        {"cylinder", "all", "quadrilateral", 3},
                                                        {"disc", "boundary", "", 2}}) {
    const MapProblem problem = under_pressure(generator, {}, order, region, shape, 0.05);
    for (const std::string& broken : energy_laws(*problem.functional, problem.u)) ADD_FAILURE() << broken << generator << region;
  }
}

TEST(Pressure, PushesAgainstTheOutwardNormal) {
  // The bottom of a box, whose normal is -e_3: a force of pressure times area along e_3, and no force along the others.
  const MapProblem box = under_pressure("box", {{"cells", {2, 2, 1}}, {"size", {2, 3, 1}}}, 1, "front");
  const int dof = 2;
  double sum = 0;
  const std::vector<double> g = gradient(box);
  for (int n = 0; n < box.space().node_count(); ++n) {
    const Point3& x = box.space().position(n);
    const double along = -g[static_cast<std::size_t>(box.layout->first_dof(0, n) + dof)];
    if (x[2] > 1e-9) {
      EXPECT_EQ(along, 0);
    }
    if (x[2] < 0.5 && x[0] > 0.5 && x[0] < 1.5 && x[1] > 1 && x[1] < 2) {
      EXPECT_NEAR(along, p * 1.5, 1e-14);  // inside: not the share of the rim
    }
    sum += along;
  }
  EXPECT_GT(sum, 0);
  // A disc under pressure around: radial forces inwards.
  const MapProblem disc = under_pressure("disc", {{"cells", {3}}}, 2, "boundary");
  const std::vector<double> f = gradient(disc);
  Point3 total;  // force and moment
  for (int n = 0; n < disc.space().node_count(); ++n) {
    const Point3& x = disc.space().position(n);
    const auto first = static_cast<std::size_t>(disc.layout->first_dof(0, n));
    const double inwards = f[first] * x[0] + f[first + 1] * x[1];
    total += Point3{{f[first], f[first + 1], f[first] * x[1] - f[first + 1] * x[0]}};
    if (x[0] * x[0] + x[1] * x[1] > 0.99) {
      EXPECT_GT(inwards, 0);
    }
  }
  EXPECT_LT(std::sqrt(norm2(total)), 1e-14);
}

TEST(Pressure, IsTheSameForAllSharesAndOriginsAwayFromTheRim) {
  for (const char* surface : {"sphere", "rectangle", "disc"}) {
    MapProblem problem = under_pressure(surface, {}, 2, std::string(surface) == "disc" ? "boundary" : "all", "", 0.05);
    const std::vector<double> alike = gradient(problem);
    for (int i = 0; i < 3; ++i) {
      problem.input.parameters["share[" + std::to_string(i) + "]"] = i == 1;
      problem.input.parameters["origin[" + std::to_string(i) + "]"] = 0.4 + i;
    }
    problem.make("pressure-load");
    std::vector<double> one = gradient(problem);
    if (std::string(surface) == "rectangle")
      for (int n = 0; n < problem.space().node_count(); ++n) {
        const Point3& x = problem.space().position(n);
        const auto first = static_cast<std::size_t>(problem.layout->first_dof(0, n));
        if (std::min({x[0], 1 - x[0], x[1], 1 - x[1]}) < 1e-9)
          std::copy_n(alike.begin() + static_cast<std::ptrdiff_t>(first), 3, one.begin() + static_cast<std::ptrdiff_t>(first));
      }
    EXPECT_LT(largest_difference(alike, one), 1e-14) << surface;
  }
}

TEST(Pressure, RefusesOtherPlaces) {
  for (const auto& [generator, region] : {std::pair("disc", "all"), {"rectangle", "left"}}) {
    try {
      under_pressure(generator, {}, 1, region);
      FAIL() << generator;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("A pressure works on surfaces of a deformation in R3 and on curves of one in R2"), std::string::npos)
          << e.what();
    }
  }
}

}  // namespace
}  // namespace karcher
