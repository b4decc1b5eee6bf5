#include "karcher/manifold/hyperbolic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "karcher/testing/random.hpp"

using namespace karcher;

namespace {

using H2 = Hyperbolic<2>;
using P = Vec<double, 3>;

P at(double r, double angle) { return {{std::cosh(r), std::sinh(r) * std::cos(angle), std::sinh(r) * std::sin(angle)}}; }

}  // namespace

TEST(Hyperbolic, TrianglesObeyTheLawOfCosines) {
  // cosh c = cosh a cosh b - sinh a sinh b cos C
  for (double a : {0.1, 1.0, 3.0})
    for (double b : {0.3, 2.0})
      for (double angle : {0.2, 1.5, 3.0}) {
        const double c = std::acosh(std::cosh(a) * std::cosh(b) - std::sinh(a) * std::sinh(b) * std::cos(angle));
        EXPECT_NEAR(H2::dist(at(a, 0.4), at(b, 0.4 + angle)), c, 1e-13 * std::cosh(a) * std::cosh(b));
        EXPECT_NEAR(std::sqrt(norm2(coordinates<H2>(at(a, 0), H2::frame(at(a, 0)), H2::log(at(a, 0), at(b, angle))))), c,
                    1e-13 * std::cosh(a) * std::cosh(b));
      }
}

TEST(Hyperbolic, AnIdealTriangleHasAnAreaNearPi) {
  // Angles of the triangle with vertices at distance 9 in directions 0, 120, 240 degrees: angle sum is pi less the area, which tends to pi.
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const auto vertex = [&](int i) { return at(9, 2 * std::numbers::pi * i / 3); };
    const auto a = H2::log(vertex(k), vertex(k + 1)), b = H2::log(vertex(k), vertex(k + 2));
    const double c = H2::inner(vertex(k), a, b) / std::sqrt(H2::inner(vertex(k), a, a) * H2::inner(vertex(k), b, b));
    sum += std::acos(std::min(1.0, c));
  }
  EXPECT_LT(sum, 0.01);
}

TEST(Hyperbolic, FarPointsStayOnTheSheet) {
  Random random(1);
  P p = H2::origin();
  for (int i = 0; i < 1000; ++i) {
    p = retract<H2>(p, 0.05 * random.direction<2>());
    ASSERT_LT(H2::defect(p), 1e-15);
  }
  EXPECT_LT(H2::defect(retract<H2>(H2::origin(), Vec<double, 2>{{15, 3}})), 1e-15);
}

TEST(Hyperbolic, HasNoProjection) {
  static_assert(Manifold<Hyperbolic<3>> && !HasProjection<Hyperbolic<3>>);
  P p;
  EXPECT_TRUE(H2::make_point({{1.4142135, 1, 0}}, p));
  EXPECT_LT(H2::defect(p), 1e-16);
  EXPECT_FALSE(H2::make_point({{1.5, 1, 0}}, p));
  EXPECT_FALSE(H2::make_point({{-1, 0, 0}}, p));
}
