#include "solve/radius.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "karcher/solve/minimize.hpp"
#include "solve/cell_functions.hpp"
#include "solve/few_unknowns.hpp"

namespace karcher {
namespace {

using testing::Local;
using testing::OneUnknown;
using testing::Recorder;
using testing::unit;

TEST(Radius, IsHalfTheStepAfterAPoorOne) {
  EXPECT_EQ(radius_after_accepted(8, 3, 0.249, false, default_tuning), 1.5);
  EXPECT_EQ(radius_after_accepted(8, 3, 0.25, false, default_tuning), 8);
}

TEST(Radius, DoublesAfterAGoodStepThatItHeldBack) {
  EXPECT_EQ(radius_after_accepted(8, 7.3, 0.91, false, default_tuning), 16);
  EXPECT_EQ(radius_after_accepted(8, 7.1, 0.91, false, default_tuning), 8);  // a shorter step was free to be longer
  EXPECT_EQ(radius_after_accepted(8, 7.3, 0.90, false, default_tuning), 8);  // not good enough
}

TEST(Radius, IsOutOfTheWayAfterAStepForWhichTheModelIsExact) {
  EXPECT_EQ(radius_after_accepted(8, 7.3, 9, true, default_tuning), 8e4);
  EXPECT_EQ(radius_after_accepted(8, 7.3, 9, false, default_tuning), 16);
  EXPECT_EQ(radius_after_accepted(8, 7.1, 9, true, default_tuning), 8);
}

TEST(Radius, IsNeverMoreThanEightSteps) {
  EXPECT_EQ(radius_after_accepted(8, 0.5, 0.95, false, default_tuning), 4);
  EXPECT_EQ(radius_after_accepted(8, 0.5, 0.5, false, default_tuning), 4);
}

TEST(Radius, AfterARejectedStepEndsAtTheMinimumOfTheParabola) {
  // slope -1 and rise r: the parabola -t + r t^2 over the step is least at 1 / (2 r)
  EXPECT_DOUBLE_EQ(radius_after_rejected(3, -1, 0.25, default_tuning), 0.4 * 3);
  EXPECT_DOUBLE_EQ(radius_after_rejected(3, -1, 100, default_tuning), 0.2 * 3);
  EXPECT_DOUBLE_EQ(radius_after_rejected(3, -1, -0.6, default_tuning), 0.5 * 3);
  EXPECT_DOUBLE_EQ(radius_after_rejected(3, -1, std::numeric_limits<double>::infinity(), default_tuning), 0.25 * 3);
  EXPECT_DOUBLE_EQ(radius_after_rejected(3, -1, std::numeric_limits<double>::quiet_NaN(), default_tuning), 0.25 * 3);
}

/// Slope -1 and curvature 1 at 0, so that the step is to x = 1 (if the radius lets it) and promises 1/2; there the energy has fallen by ratio / 2.
std::vector<IterationRecord> two_iterations(double ratio, double initial_radius) {
  OneUnknown p([=](double x) { return Local{-x + 0.5 * x * x + 0.5 * (1 - ratio) * x * x * x * x, -1 + x, 1}; });
  SolverOptions options;
  options.max_corrections = 0;
  options.max_iterations = 2;
  options.initial_radius = initial_radius;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  minimize(*p.functional, p.u, options, observers);
  EXPECT_GE(recorder.records.size(), 1u);
  EXPECT_NEAR(recorder.records[0].step_norm, unit, 1e-14);
  EXPECT_NEAR(recorder.records[0].ratio, ratio, 1e-14);
  return recorder.records;
}

TEST(TrustRegion, AcceptsAStepThatReachesAHundredthOfItsPromise) {
  EXPECT_TRUE(two_iterations(0.0101, 4)[0].accepted);
  EXPECT_FALSE(two_iterations(0.0099, 4)[0].accepted);
}

TEST(TrustRegion, SetsTheRadiusOfTheNextIterationByTheRatioOfTheLast) {
  // The slope is given as -1 + x: after an accepted step the point is at rest, so only rejected steps are followed by a second record.
  const auto rejected = two_iterations(-0.5, 4);
  ASSERT_EQ(rejected.size(), 2u);
  EXPECT_EQ(rejected[0].radius, 4);
  EXPECT_NEAR(rejected[1].radius, 0.4 * unit, 1e-14);
}

/// Radius after one accepted step from 0 to 1 within `radius`, which reached `ratio` of its promise.
double second_radius(double ratio, double radius) {
  // The slope stays -1, so that there is a second step.
  OneUnknown p([=](double x) { return Local{-x + 0.5 * x * x + 0.5 * (1 - ratio) * x * x * x * x, -1, 1}; });
  SolverOptions options;
  options.max_corrections = 0;
  options.max_iterations = 2;
  options.initial_radius = radius;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  minimize(*p.functional, p.u, options, observers);
  EXPECT_EQ(recorder.records.size(), 2u);
  EXPECT_TRUE(recorder.records[0].accepted);
  return recorder.records[1].radius;
}

TEST(TrustRegion, SetsTheRadiusOfTheNextIterationByTheRatioOfAnAcceptedStep) {
  EXPECT_NEAR(second_radius(0.2, 4), 0.5 * unit, 1e-14);
  EXPECT_EQ(second_radius(0.3, 4), 4);
  EXPECT_EQ(second_radius(0.95, 4), 4);
  EXPECT_EQ(second_radius(0.95, 1.5), 3);  // |s| = 1.414 is more than 0.9 of 1.5
  EXPECT_NEAR(second_radius(0.95, 40), 8 * unit, 1e-13);
}

}  // namespace
}  // namespace karcher
