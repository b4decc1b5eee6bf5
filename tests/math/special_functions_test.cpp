#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "karcher/math/functions.hpp"

using namespace karcher;

namespace {

/// c_k(tau) in extended precision: the series where it does not cancel, else the closed forms and the recursion upwards.
long double reference_stumpff(int k, long double tau) {
  if (std::abs(tau) < 12 || tau < 0) {
    long double term = 1, sum = 0;
    for (int i = 2; i <= k; ++i) term /= i;
    for (int j = 0; j < 400; ++j) {
      sum += term;
      term *= -tau / ((k + 2 * j + 1.0L) * (k + 2 * j + 2.0L));
    }
    return sum;
  }
  const long double angle = std::sqrt(tau);
  if (k == 0) return std::cos(angle);
  if (k == 1) return std::sin(angle) / angle;
  long double f = 1;
  for (int i = 2; i <= k - 2; ++i) f /= i;
  return (f - reference_stumpff(k - 2, tau)) / tau;
}

/// a^(n)(c) in extended precision: 300 terms of the series near 1, else the differential equation.
long double reference_arc(int n, long double c) {
  if (std::abs(c - 1) < 0.9L) {
    const long double z = (1 - c) / 2;
    long double term = 1, sum = 0;
    for (int j = 1; j <= n; ++j) term *= -0.5L * j * j / (j + 0.5L);
    for (int k = 1; k < 300; ++k) {
      sum += term;
      term *= z * (n + k) * (n + k) / ((n + k + 0.5L) * k);
    }
    return sum;
  }
  const long double w = (1 - c) * (1 + c);
  if (n == 0) return c < 1 ? std::acos(c) / std::sqrt(w) : std::acosh(c) / std::sqrt(-w);
  if (n == 1) return (c * reference_arc(0, c) - 1) / w;
  return ((2 * n - 1) * c * reference_arc(n - 1, c) + (n - 1.0L) * (n - 1) * reference_arc(n - 2, c)) / w;
}

}  // namespace

TEST(Stumpff, HasFullAccuracyOverTheWholeLine) {
  for (int sign : {-1, 1})
    for (double size = 1e-14; size < 900; size *= 1.17) {
      const double tau = sign * size;
      const auto c = stumpff<7>(tau);
      for (int k = 0; k <= 7; ++k) {
        const double exact = static_cast<double>(reference_stumpff(k, tau));
        // Zeros of cos, sin and 1 - cos have no relative accuracy.
        double scale = std::abs(exact);
        if (tau > 0 && k < 2) scale = 1;
        if (tau > 10 && k == 2) scale = std::max(scale, 1 / tau);
        EXPECT_NEAR(c[static_cast<std::size_t>(k)], exact, 2e-15 * scale * (k < 5 ? 1 : 10)) << "c_" << k << "(" << tau << ")";
      }
    }
}

TEST(Stumpff, IsCosineAndSineOfTheRoot) {
  for (double angle = 0.01; angle < 10; angle += 0.37) {
    const auto circle = stumpff<1>(angle * angle), hyperbola = stumpff<1>(-angle * angle);
    EXPECT_NEAR(circle[0], std::cos(angle), 4e-15);
    EXPECT_NEAR(circle[1] * angle, std::sin(angle), 4e-15);
    EXPECT_NEAR(hyperbola[0] / std::cosh(angle), 1, 2e-15);
    EXPECT_NEAR(hyperbola[1] * angle / std::sinh(angle), 1, 2e-15);
  }
  EXPECT_EQ(stumpff<3>(0.0)[3], 1.0 / 6);
}

TEST(Stumpff, GoesSmoothlyThroughZeroInJets) {
  // c_1 = 1 - tau/6 + tau^2/120 - ...
  using J = Jet<double, 1>;
  const J c = stumpff<1>(J::variable(0, 0))[1];
  EXPECT_EQ(c.v, 1);
  EXPECT_DOUBLE_EQ(c.gradient(0), -1.0 / 6);
  EXPECT_DOUBLE_EQ(c.hessian(0, 0), 1.0 / 60);
}

TEST(ArcRatio, HasFullAccuracyWithItsDerivatives) {
  for (double c = -0.995; c < 40; c += c < 2 ? 0.0137 : 0.77) {
    const auto a = arc_detail::ArcRatio{}.derivatives<3>(c);
    for (int n = 0; n <= 3; ++n) {
      const double exact = static_cast<double>(reference_arc(n, c));
      // Near -1 the argument itself has lost digits: its rounding is amplified by 1/(1 + c) per derivative.
      const double limit = (n == 0 ? 1e-15 : n == 1 ? 4e-15 : 4e-14) + 4e-16 / (1 + c);
      EXPECT_NEAR(a[static_cast<std::size_t>(n)] / exact, 1, limit) << "derivative " << n << " at " << c;
    }
  }
}

TEST(ArcRatio, IsTheRatioOfAngleAndSine) {
  EXPECT_EQ(arc_ratio(1.0), 1);
  EXPECT_NEAR(arc_ratio(0.0), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(arc_ratio(std::cosh(2.0)), 2 / std::sinh(2.0), 1e-15);
  EXPECT_NEAR(arc_ratio(std::cos(3.0)) * std::sin(3.0), 3, 1e-13);
}

TEST(ArcRatio, IsSmoothWhereAngleAndSineVanish) {
  // a(cos x) = x / sin x = 1 + x^2/6 + 7 x^4/360 + ...
  using J = Jet<double, 1>;
  const J a = arc_ratio(cos(J::variable(0, 0)));
  EXPECT_EQ(a.v, 1);
  EXPECT_EQ(a.gradient(0), 0);
  EXPECT_NEAR(a.hessian(0, 0), 1.0 / 3, 1e-15);
}

TEST(AngleBetween, KeepsItsDigitsAtZeroAndAtPi) {
  for (double x : {1e-12, 1e-9, 1e-5, 0.1, 1.0, 3.0}) {
    const Vec<double, 2> a{{1, 0}}, b{{std::cos(x), std::sin(x)}};
    EXPECT_NEAR(angle_between(a, b) / x, 1, 1e-15);
    EXPECT_NEAR(std::numbers::pi - angle_between(a, -b), x, 5e-16);
  }
}
