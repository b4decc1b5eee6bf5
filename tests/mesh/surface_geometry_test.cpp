#include "karcher/mesh/surface_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "karcher/error.hpp"
#include "karcher/math/jet.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {
namespace {

using J = Jet<double, 2>;

/// The jet of a parametrised surface at (u, v).
GeometryJet jet_of(const std::function<Vec3<J>(const J&, const J&)>& f, double u, double v) {
  const Vec3<J> x = f(J::variable(u, 0), J::variable(v, 1));
  GeometryJet g;
  for (int c = 0; c < 3; ++c) {
    g.x[c] = x[c].v;
    g.d[0][c] = x[c].gradient(0);
    g.d[1][c] = x[c].gradient(1);
    g.dd[0][c] = x[c].hessian(0, 0);
    g.dd[1][c] = x[c].hessian(0, 1);
    g.dd[3][c] = x[c].hessian(1, 1);
  }
  return g;
}
J cosine(const J& x) { return compose(x, std::cos(x.v), -std::sin(x.v), -std::cos(x.v)); }
J sine(const J& x) { return compose(x, std::sin(x.v), std::cos(x.v), -std::sin(x.v)); }

void expect_near(const Mat3<double>& a, const Mat3<double>& b, double tolerance) {
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(a.e[i], b.e[i], tolerance) << i;
}

/// What holds for every surface.
void check_identities(const SurfaceGeometry& g) {
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) EXPECT_NEAR(dot(g.dual[a], g.tangent[b]), a == b ? 1 : 0, 1e-13);
  const Vec3<double> t1 = column(g.frame, 0), t2 = column(g.frame, 1), n = column(g.frame, 2);
  expect_near(transpose_times(g.frame, g.frame), identity<double, 3>(), 1e-14);
  EXPECT_NEAR(determinant(g.frame), 1, 1e-14);
  expect_near(g.b, g.curvature[0] * outer(t1, t1) + g.curvature[1] * outer(t2, t2), 1e-13 * (1 + std::fabs(g.mean_curvature())));
  expect_near(g.c, outer(t1, t2) - outer(t2, t1), 1e-13);
  EXPECT_NEAR(dot(n, g.normal), 1, 1e-14);
  EXPECT_GE(g.curvature[0], g.curvature[1]);
  // gradients: sum_a a^a d_a f = sum_b t_b (sum_a jacobian(a, b) d_a f)
  const auto j = g.jacobian();
  for (int a = 0; a < 2; ++a) {
    const Vec3<double> dual = j(a, 0) * t1 + j(a, 1) * t2;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(dual[c], g.dual[static_cast<std::size_t>(a)][c], 1e-13);
  }
}

TEST(SurfaceGeometry, OfACylinderHasMinusOneOverRAroundIt) {
  const double r = 0.7;
  const auto g = surface_geometry(jet_of([&](const J& u, const J& v) { return Vec3<J>{{r * cosine(u), r * sine(u), v}}; }, 0.4, 0.2));
  check_identities(g);
  const Vec3<double> phi{{-std::sin(0.4), std::cos(0.4), 0}};
  expect_near(g.b, (-1 / r) * outer(phi, phi), 1e-15);
  EXPECT_NEAR(g.curvature[0], 0, 1e-15);
  EXPECT_NEAR(g.curvature[1], -1 / r, 1e-15);
  EXPECT_NEAR(g.area, r, 1e-15);
}

TEST(SurfaceGeometry, OfATorusIsThatOfTheTextbook) {
  // R + r cos v: curvatures -1/r and -cos v/(R + r cos v) with the outward normal
  const double big = 2, r = 0.5;
  for (double v : {0.0, 0.6, 1.5707, 2.5, 3.14159}) {
    const auto g = surface_geometry(jet_of(
        [&](const J& u, const J& w) {
          const J rho = big + r * cosine(w);
          return Vec3<J>{{rho * cosine(u), rho * sine(u), r * sine(w)}};
        },
        1.1, v));
    check_identities(g);
    const double other = -std::cos(v) / (big + r * std::cos(v));
    EXPECT_NEAR(g.mean_curvature(), 0.5 * (other - 1 / r), 1e-14);
    EXPECT_NEAR(g.gauss_curvature(), -other / r, 1e-14);
    EXPECT_NEAR(g.area, r * (big + r * std::cos(v)), 1e-14);
  }
}

TEST(SurfaceGeometry, IsRobustAtAndNearUmbilics) {
  for (double difference : {0.0, 1e-16, 1e-12, 1e-8, 1e-4}) {
    const auto g = surface_geometry(jet_of(
        [&](const J& u, const J& v) {
          return Vec3<J>{{u + 0.3 * v, v, 0.5 * (1.0 + difference) * u * u + 0.5 * v * v}};
        },
        0, 0));
    check_identities(g);
  }
  const auto plane = surface_geometry(jet_of([](const J& u, const J& v) { return Vec3<J>{{u + v, v, 2.0 * u}}; }, 0.2, 0.1));
  check_identities(plane);
  EXPECT_EQ(plane.curvature[0], 0);
  EXPECT_EQ(plane.curvature[1], 0);
}

TEST(SurfaceGeometry, HasItsPrincipalDirectionsWhereTheSaddleBends) {
  // z = k/2 (x'^2 - y'^2) with axes x', y' turned by an angle
  for (double angle : {0.0, 0.3, 0.785398, 1.2, 1.5707963, 2.0, 3.0}) {
    const double c = std::cos(angle), s = std::sin(angle), k = 1.7;
    const auto g = surface_geometry(jet_of(
        [&](const J& u, const J& v) {
          const J x = c * u + s * v, y = c * v - s * u;
          return Vec3<J>{{u, v, 0.5 * k * (x * x - y * y)}};
        },
        0, 0));
    check_identities(g);
    EXPECT_NEAR(g.curvature[0], k, 1e-14);
    EXPECT_NEAR(g.curvature[1], -k, 1e-14);
    EXPECT_NEAR(std::fabs(dot(column(g.frame, 0), Vec3<double>{{c, s, 0}})), 1, 1e-14);
  }
}

TEST(SurfaceGeometry, ChangesItsSignsWithTheNormal) {
  const auto f = [](const J& u, const J& v) { return Vec3<J>{{u, v + 0.2 * u * v, 0.3 * u * u - 0.4 * u * v}}; };
  const auto g = surface_geometry(jet_of(f, 0.3, 0.1));
  const auto swapped = surface_geometry(jet_of([&](const J& u, const J& v) { return f(v, u); }, 0.1, 0.3));
  expect_near(swapped.b, -g.b, 1e-14);
  expect_near(swapped.c, -g.c, 1e-14);
  EXPECT_NEAR(swapped.curvature[0], -g.curvature[1], 1e-14);
}

TEST(SurfaceGeometry, OfQuadraticAndCubicSpheresConverges) {
  const auto worst = [](int order, int n) {
    const Mesh mesh = generate({"sphere", {{"radius", {2}}, {"cells", {static_cast<double>(n)}}, {"order", {static_cast<double>(order)}}}, {}});
    double error = 0;
    for (const Cell& c : mesh.cells) {
      const auto g = surface_geometry(geometry(mesh, c, {{1.0 / 3, 1.0 / 3, 0}}));
      for (double k : g.curvature) error = std::max(error, std::fabs(std::fabs(k) - 0.5));
    }
    return error;
  };
  EXPECT_GT(std::log2(worst(2, 8) / worst(2, 16)), 0.85);
  EXPECT_GT(std::log2(worst(3, 4) / worst(3, 8)), 1.9);
}

TEST(SurfaceGeometry, RefusesDegenerateTangentsWithThePlace) {
  try {
    surface_geometry(jet_of([](const J& u, const J& v) { return Vec3<J>{{u + v, 2.0 * (u + v), 0.5 * v * v}}; }, 1.5, 0.0));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("(1.5, 3, 0)"), std::string::npos) << e.what();
  }
  GeometryJet bad;
  bad.d[0][0] = std::nan("");
  EXPECT_THROW(surface_geometry(bad), InputError);
}

}  // namespace
}  // namespace karcher
