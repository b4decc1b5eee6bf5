#include "solve/saddle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solve/few_unknowns.hpp"

namespace karcher {
namespace {

using testing::Local;
using testing::OneUnknown;
using testing::unit;

/// A double well with a hill at 0.
Local well(double x) { return {0.25 * x * x * x * x - 0.5 * x * x, x * x * x - x, 3 * x * x - 1}; }

std::optional<Iterate> escape_from(double x0, System& system, OneUnknown& p) {
  Iterate x;
  x.u = p.u;
  EXPECT_EQ(x.u.values, p.u.values);
  EXPECT_TRUE(system.linearise(x, 0.0));
  EXPECT_EQ(system.subproblem().inertia(0)->negative, x0 * x0 < 1.0 / 3 ? 1 : 0);
  return escape_saddle(system, x);
}

/// The best of the lengths 0.001 * 2^k along the eigenvector of norm 1.
double best_of(double x0, double sign) {
  double best = x0, least = well(x0).value;
  for (double length = 1e-3; length < 3; length *= 2)
    if (const double x = x0 + sign * length / unit; well(x).value < least) {
      least = well(x).value;
      best = x;
    }
  return best;
}

TEST(Saddle, IsLeftAlongTheLowestEigenvectorToTheBestOfSomePointsDownhill) {
  for (const double x0 : {0.01, -0.01}) {
    OneUnknown p(well, x0);
    System system(*p.functional, {}, default_tuning);
    const std::optional<Iterate> lower = escape_from(x0, system, p);
    ASSERT_TRUE(lower);
    p.u.values = lower->u.values;
    EXPECT_NEAR(p.x(), best_of(x0, x0 > 0 ? 1 : -1), 1e-12);
    EXPECT_LT(std::abs(std::abs(p.x()) - 1), 0.5);
    EXPECT_NEAR(lower->energy, well(p.x()).value, 1e-14);
  }
}

TEST(Saddle, IsNotLeftWhereNothingIsLowerByMoreThanNoise) {
  // The Hessian claims a hill, the energy falls by rounding only.
  OneUnknown p([](double x) { return Local{1 - 1e-14 * std::abs(std::tanh(x)), 0, -1}; });
  System system(*p.functional, {}, default_tuning);
  EXPECT_FALSE(escape_from(0, system, p));
}

}  // namespace
}  // namespace karcher
