#include "solve/corrections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solve/few_unknowns.hpp"

namespace karcher {
namespace {

using testing::Local;
using testing::Local2;
using testing::OneUnknown;
using testing::TwoUnknowns;
using testing::unit;

constexpr double nowhere = std::numeric_limits<double>::infinity();

/// 1/2 x^2 with the claim that its curvature is 1 / progress: every correction takes x to (1 - progress) x.
struct Slow {
  OneUnknown p;
  System system;
  Iterate x;
  Step step;
  explicit Slow(double progress, int max_corrections = 20, double start = 1)
      : p(
            [=](double at) {
              return Local{0.5 * at * at, at, 1 / progress};
            },
            start),
        system(*p.functional, options(max_corrections), default_tuning) {
    x.u = p.u;
    EXPECT_TRUE(system.linearise(x, 0.0));
    step = system.subproblem().step(100, default_tuning.trial);
    step.norm = 100;
    system.work = {};
  }
  static SolverOptions options(int max_corrections) {
    SolverOptions o;
    o.max_corrections = max_corrections;
    return o;
  }
  double end() {
    p.u.values = x.u.values;
    return p.x();
  }
};

TEST(Corrections, GoOnUntilTheToleranceIsMet) {
  // Each halves the gradient, whose norm is |x| / sqrt(M).
  Slow s(0.5);
  correct(s.system, s.x, nowhere, s.step, 0.01 / unit);
  EXPECT_NEAR(s.end(), 1.0 / 128, 1e-15);
  EXPECT_EQ(s.system.work.gradients, 7);
  EXPECT_NEAR(s.x.gradient_norm, 1.0 / 128 / unit, 1e-15);
}

TEST(Corrections, AreNotMoreThanAllowed) {
  for (const int most : {0, 1, 3}) {
    Slow s(0.5, most);
    correct(s.system, s.x, nowhere, s.step, 0);
    EXPECT_NEAR(s.end(), std::pow(0.5, most), 1e-15);
  }
}

TEST(Corrections, EndWhenOneGainsLessThanATenthOfAllAndDoesNotHalveTheGradient) {
  // x falls to 0.7 x, the energy to 0.49 of itself: gains 0.51, 0.250, 0.122, 0.060 of what is there; the fourth is less than a tenth of their sum.
  Slow s(0.3);
  correct(s.system, s.x, nowhere, s.step, 0);
  EXPECT_NEAR(s.end(), std::pow(0.7, 4), 1e-15);
  // Where the step itself has gained ten times as much, the first one is.
  Slow t(0.3);
  correct(t.system, t.x, 0.5 + 5, t.step, 0);
  EXPECT_NEAR(t.end(), 0.7, 1e-15);
}

TEST(Corrections, AreNoLongerThanTheStepAndThanFourTimesTheLast) {
  // Without limit the first correction of 1/2 x^2 would end at 0.
  Slow s(1, 1, 8);
  s.step.norm = 2 * unit;
  correct(s.system, s.x, nowhere, s.step, 0);
  EXPECT_NEAR(s.end(), 6, 1e-14);
  // From 16 within 16, lengths 16, 4 and 1 are tried, and only 1 is lower. Then the limit is 4: only 1/4 of it is lower.
  const auto holes = [](double x) { return x > 15.5 ? 2.0 : std::abs(x - 15) < 0.1 ? 1.0 : std::abs(x - 14.75) < 0.1 ? 0.0 : 3.0; };
  OneUnknown p([=](double x) { return Local{holes(x), 1, 1e-3}; }, 16);
  System system(*p.functional, Slow::options(2), default_tuning);
  Iterate x;
  x.u = p.u;
  EXPECT_TRUE(system.linearise(x, 0.0));
  const Step step = system.subproblem().step(16 * unit, default_tuning.trial);
  correct(system, x, nowhere, step, 0);
  p.u.values = x.u.values;
  EXPECT_NEAR(p.x(), 14.75, 1e-12);
}

TEST(Corrections, TakeTheBestOfSomeLengths) {
  // The claim is a correction of length 1, the energy is least at 1/4 of it.
  OneUnknown p([](double x) { return Local{(x - 0.75) * (x - 0.75), 1, 1}; }, 1);
  System system(*p.functional, Slow::options(1), default_tuning);
  Iterate x;
  x.u = p.u;
  system.linearise(x, 0.0);
  const Step step = system.subproblem().step(unit, default_tuning.trial);
  correct(system, x, nowhere, step, 0);
  p.u.values = x.u.values;
  EXPECT_NEAR(p.x(), 0.75, 1e-14);
}

TEST(Corrections, TakeTheOneAcrossTheStepWhereTheMatrixIsWrongAlongIt) {
  // The claim is a correction to (0, 0); but to move a costs energy, at any length.
  TwoUnknowns p([](double a, double b) { return Local2{1e6 * (a - 1) * (a - 1) + 0.5 * b * b, a, b, 1, 0, 1}; }, 1, 0.5);
  System system(*p.functional, Slow::options(1), default_tuning);
  Iterate x;
  x.u = p.u;
  EXPECT_TRUE(system.linearise(x, 0.0));
  // A step along a: for a gradient that has no other component.
  Iterate along = x;
  for (int node = 0; node < 2; ++node)
    if (const int d = p.layout->first_dof(0, node); d >= 0) along.g[static_cast<std::size_t>(d)] = p.field.space->position(node)[0] < 0.5 ? 1 : 0;
  system.subproblem().set_gradient(along.g);
  Step step = system.subproblem().step(100, default_tuning.newton);
  EXPECT_NEAR(step.norm, unit, 1e-12);
  step.norm = 10;
  correct(system, x, nowhere, step, 0);
  p.u.values = x.u.values;
  EXPECT_NEAR(p.a(), 1, 1e-12);
  EXPECT_NEAR(p.b(), 0, 1e-12);
}

TEST(Corrections, LeaveThePointWhereNoneLowersTheEnergy) {
  OneUnknown p([](double x) { return Local{std::abs(x - 1), 1, 1}; }, 1);
  System system(*p.functional, {}, default_tuning);
  Iterate x;
  x.u = p.u;
  system.linearise(x, 0.0);
  const Step step = system.subproblem().step(unit, default_tuning.trial);
  const Configuration before = x.u;
  correct(system, x, nowhere, step, 0);
  EXPECT_EQ(x.u.values, before.values);
}

}  // namespace
}  // namespace karcher
