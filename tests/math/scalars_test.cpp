#include <gtest/gtest.h>

#include <cmath>

#include "karcher/math/functions.hpp"
#include "karcher/testing/derivative_checks.hpp"

using namespace karcher;

namespace {

/// All functions of one variable with a point inside their domain.
template <class Check>
void for_each_function(Check check) {
  check(
      "sqrt", [](const auto& x) { return sqrt(x); }, 0.7);
  check(
      "exp", [](const auto& x) { return exp(x); }, 0.3);
  check(
      "log", [](const auto& x) { return log(x); }, 0.4);
  check(
      "expm1", [](const auto& x) { return expm1(x); }, 0.3);
  check(
      "log1p", [](const auto& x) { return log1p(x); }, -0.4);
  check(
      "sin", [](const auto& x) { return sin(x); }, 1.1);
  check(
      "cos", [](const auto& x) { return cos(x); }, 1.1);
  check(
      "tan", [](const auto& x) { return tan(x); }, 0.6);
  check(
      "sinh", [](const auto& x) { return sinh(x); }, 0.8);
  check(
      "cosh", [](const auto& x) { return cosh(x); }, 0.8);
  check(
      "tanh", [](const auto& x) { return tanh(x); }, 0.5);
  check(
      "asin", [](const auto& x) { return asin(x); }, 0.4);
  check(
      "acos", [](const auto& x) { return acos(x); }, 0.4);
  check(
      "atan", [](const auto& x) { return atan(x); }, 0.9);
  check(
      "asinh", [](const auto& x) { return asinh(x); }, 0.9);
  check(
      "acosh", [](const auto& x) { return acosh(x); }, 1.7);
  check(
      "atanh", [](const auto& x) { return atanh(x); }, 0.4);
  check(
      "pow 2.5", [](const auto& x) { return pow(x, 2.5); }, 0.9);
  check(
      "pow -3", [](const auto& x) { return pow(x, -3); }, 0.9);
  check(
      "x^x", [](const auto& x) { return pow(x, x); }, 0.9);
  check(
      "atan2", [](const auto& x) { return atan2(x, 1.0 - 2.0 * x); }, 0.9);
  check(
      "quotient", [](const auto& x) { return (1.0 + x) / (2.0 - x * x); }, 0.4);
  check(
      "stumpff 0", [](const auto& x) { return stumpff<2>(x)[0]; }, 0.4);
  check(
      "stumpff 2", [](const auto& x) { return stumpff<2>(x)[2]; }, 12.4);
  check(
      "stumpff 3", [](const auto& x) { return stumpff<3>(x)[3]; }, -3.0);
  check(
      "arc ratio near 1", [](const auto& x) { return arc_ratio(x); }, 1.02);
  check(
      "arc ratio", [](const auto& x) { return arc_ratio(x); }, 0.2);
  check(
      "arc ratio beyond the equator", [](const auto& x) { return arc_ratio(x); }, -0.8);
  check(
      "arc ratio far beyond 1", [](const auto& x) { return arc_ratio(x); }, 6.0);
}

}  // namespace

TEST(Scalars, JetsCarryTheFirstTwoDerivativesOfEveryFunction) {
  for_each_function([](const char* name, auto f, double x) {
    using J = Jet<double, 1>;
    const J j = f(J::variable(x, 0));
    EXPECT_NEAR(j.v, f(x), 1e-14) << name;
    const TaylorSlopes s = taylor_slopes([&](double t) { return f(x + t); }, f(x), j.gradient(0), j.hessian(0, 0), 0.05);
    EXPECT_TRUE(s.hessian_holds()) << name << ": " << s.sentence();
  });
}

TEST(Scalars, DualsOverJetsCarryTheThird) {
  for_each_function([](const char* name, auto f, double x) {
    using J = Jet<double, 1>;
    using D = Dual<J, 1>;
    D d = J::variable(x, 0);
    d.d[0] = J(1.0);
    const D y = f(d);
    const J j = f(J::variable(x, 0));
    // The dual part of a Dual over a Jet is the jet of the derivative.
    EXPECT_NEAR(y.d[0].v, j.gradient(0), 1e-13 * (1 + std::abs(j.gradient(0)))) << name;
    EXPECT_NEAR(y.d[0].gradient(0), j.hessian(0, 0), 1e-13 * (1 + std::abs(j.hessian(0, 0)))) << name;
    const auto second = [&](double t) { return f(J::variable(x + t, 0)).hessian(0, 0); };
    const double h = 1e-3, difference = (8 * (second(h) - second(-h)) - (second(2 * h) - second(-2 * h))) / (12 * h);
    EXPECT_NEAR(y.d[0].hessian(0, 0), difference, 1e-7 * (1 + std::abs(difference))) << name;
  });
}

TEST(Scalars, PacksAgreeWithDoubleLaneByLane) {
  for_each_function([](const char* name, auto f, double x) {
    using P = Pack<8>;
    using J = Jet<P, 1>;
    P p;
    for (int l = 0; l < 8; ++l) p.set(l, x * (1 + 0.02 * l));
    const J y = f(J::variable(p, 0));
    const P v = f(p);
    for (int l = 0; l < 8; ++l) {
      const auto one = f(Jet<double, 1>::variable(p[l], 0));
      EXPECT_NEAR(v[l], one.v, 1e-14 * (1 + std::abs(one.v))) << name << " lane " << l;
      EXPECT_NEAR(y.v[l], one.v, 1e-14 * (1 + std::abs(one.v))) << name << " lane " << l;
      EXPECT_NEAR(y.g[0][l], one.g[0], 1e-13 * (1 + std::abs(one.g[0]))) << name << " lane " << l;
      EXPECT_NEAR(y.h[0][l], one.h[0], 1e-13 * (1 + std::abs(one.h[0]))) << name << " lane " << l;
    }
  });
}

TEST(Scalars, JetsOfSeveralVariablesHaveMixedDerivatives) {
  using J = Jet<double, 2>;
  const double x = 0.6, y = -0.4;
  const J f = exp(J::variable(x, 0) * J::variable(y, 1)) / J::variable(x, 0);
  const double e = std::exp(x * y);
  EXPECT_NEAR(f.v, e / x, 1e-15);
  EXPECT_NEAR(f.gradient(0), e * (y / x - 1 / (x * x)), 1e-14);
  EXPECT_NEAR(f.gradient(1), e, 1e-15);
  EXPECT_NEAR(f.hessian(0, 1), y * e, 1e-15);
  EXPECT_NEAR(f.hessian(1, 0), y * e, 1e-15);
  EXPECT_NEAR(f.hessian(1, 1), x * e, 1e-15);
  EXPECT_NEAR(f.hessian(0, 0), e * (y * y / x - 2 * y / (x * x) + 2 / (x * x * x)), 1e-13);
}

TEST(Scalars, APowerAtZeroHasTheDerivativesThatExist) {
  using J = Jet<double, 1>;
  const J square = pow(J::variable(0, 0), 2), line = pow(J::variable(0, 0), 1.0);
  EXPECT_EQ(square.v, 0);
  EXPECT_EQ(square.gradient(0), 0);
  EXPECT_EQ(square.hessian(0, 0), 2);
  EXPECT_EQ(line.gradient(0), 1);
  EXPECT_EQ(line.hessian(0, 0), 0);
}

TEST(Scalars, SelectTakesDerivativesWithTheValue) {
  using P = Pack<4>;
  using J = Jet<P, 1>;
  P x;
  for (int l = 0; l < 4; ++l) x.set(l, l - 1.5);
  const J y = abs(J::variable(x, 0));
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(y.v[l], std::abs(l - 1.5));
    EXPECT_EQ(y.g[0][l], l < 2 ? -1 : 1);
  }
  EXPECT_EQ(max(Jet<double, 1>(2.0), Jet<double, 1>(3.0)).v, 3);
}

TEST(PackFunctions, ExpAndLogAreRightToTwoUnitsInTheLastPlaceOverTheirWholeRange) {
  using P = Pack<8>;
  double worst_exp = 0, worst_log = 0, worst_near_one = 0;
  for (double x = -708; x < 709; x += 0.173) {
    const double e = std::exp(x);
    worst_exp = std::max(worst_exp, std::abs(exp(P(x))[5] / e - 1));
    worst_log = std::max(worst_log, std::abs(log(P(e))[2] - std::log(e)) / std::max(1e-3, std::abs(x)));
  }
  for (double x = 0.3; x < 3; x += 0.00097) worst_near_one = std::max(worst_near_one, std::abs(log(P(x))[0] / std::log(x) - 1));
  EXPECT_LT(worst_exp, 5e-16);
  EXPECT_LT(worst_log, 5e-16);
  EXPECT_LT(worst_near_one, 5e-16);
  double worst_small = 0;
  for (double x = 1e-20; x < 1e20; x *= 1.37) {
    worst_small = std::max(worst_small, std::abs(log1p(P(x))[0] / std::log1p(x) - 1));
    if (x < 1) worst_small = std::max(worst_small, std::abs(log1p(P(-x))[0] / std::log1p(-x) - 1));
  }
  EXPECT_LT(worst_small, 7e-16);
}

TEST(PackFunctions, ExpAndLogKnowTheEndsOfTheirRange) {
  using P = Pack<8>;
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(exp(P(800.0))[0], inf);
  EXPECT_EQ(exp(P(-800.0))[0], 0);
  EXPECT_EQ(exp(P(-inf))[0], 0);
  EXPECT_EQ(exp(P(inf))[0], inf);
  EXPECT_EQ(exp(P(0.0))[0], 1);
  EXPECT_TRUE(std::isnan(exp(P(nan))[0]));
  EXPECT_NEAR(exp(P(-740.0))[0] / std::exp(-740.0), 1, 0.1);  // subnormal
  EXPECT_EQ(log(P(0.0))[0], -inf);
  EXPECT_EQ(log(P(inf))[0], inf);
  EXPECT_EQ(log(P(1.0))[0], 0);
  EXPECT_TRUE(std::isnan(log(P(-1.0))[0]));
  EXPECT_TRUE(std::isnan(log(P(nan))[0]));
  EXPECT_EQ(log1p(P(-1.0))[0], -inf);
  EXPECT_EQ(log1p(P(inf))[0], inf);
  EXPECT_TRUE(std::isnan(log1p(P(-2.0))[0]));
  EXPECT_NEAR(log(P(4e-320))[0], std::log(4e-320), 1e-12);
}
