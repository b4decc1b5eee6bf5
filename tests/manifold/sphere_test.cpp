#include "karcher/manifold/sphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/testing/random.hpp"

using namespace karcher;

TEST(Sphere, ExpOfAQuarterCircleIsTheDirection) {
  const Vec<double, 3> p{{1, 0, 0}}, a{{0, 0.5 * std::numbers::pi, 0}};
  const auto q = Sphere<2>::exp(p, a);
  EXPECT_NEAR(q[0], 0, 1e-16);
  EXPECT_NEAR(q[1], 1, 1e-16);
  EXPECT_EQ(q[2], 0);
}

TEST(Sphere, LogKeepsRelativeAccuracyForNearPoints) {
  Random random(1);
  for (double r : {1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
    const auto p = random.direction<3>();
    const Vec<double, 3> d = r * random.direction<3>();
    const auto q = Sphere<2>::project(p + d);
    // log = tangential part of q - p up to a relative error of r^2
    const Vec<double, 3> w = q - p, tangential = w - dot(w, p) * p, log = Sphere<2>::log(p, q);
    EXPECT_LT(std::sqrt(norm2(log - tangential)), (r * r + 1e-15) * r);
  }
}

TEST(Sphere, LogReachesTheCutLocus) {
  // The direction of log near the opposite point q = -p + d is that of d; its length is pi - |d|.
  for (double gap : {1e-3, 1e-6, 1e-9}) {
    const Vec<double, 3> p{{0, 0, 1}}, q{{std::sin(gap), 0, -std::cos(gap)}};
    const auto a = Sphere<2>::log(p, q);
    EXPECT_NEAR(a[0], std::numbers::pi - gap, 1e-15 / gap * 1e-3 + 1e-14);
    EXPECT_EQ(a[1], 0);
    EXPECT_NEAR(a[2], 0, 1e-12);
    EXPECT_NEAR(Sphere<2>::dist(p, q), std::numbers::pi - gap, 1e-15);
  }
}

TEST(Sphere, LogOfTheOppositePointIsNotANumber) {
  const auto a = Sphere<2>::log(Vec<double, 3>{{0, 0, 1}}, Vec<double, 3>{{0, 0, -1}});
  EXPECT_FALSE(norm2(a) == norm2(a) && norm2(a) < 1e300);
}

TEST(Sphere, FrameIsWellConditionedAtPolesAndEquator) {
  for (const Vec<double, 3>& p :
       {Vec<double, 3>{{0, 0, 1}}, {{0, 0, -1}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 0, -1e-300}}, {{1, 0, 1e-300}}, {{1e-200, 0, -1}}}) {
    const auto e = Sphere<2>::frame(p);
    const auto g = transpose_times(e, e);
    EXPECT_NEAR(g(0, 0), 1, 1e-15);
    EXPECT_NEAR(g(1, 1), 1, 1e-15);
    EXPECT_NEAR(g(0, 1), 0, 1e-15);
    EXPECT_NEAR(norm2(transpose_times(e, p)), 0, 1e-30);
  }
}

TEST(Sphere, ManyStepsStayOnTheSphere) {
  Random random(2);
  Vec<double, 4> p{{1, 0, 0, 0}};
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    p = retract<Sphere<3>>(p, random.uniform(0, 0.1) * random.direction<3>());
    worst = std::max(worst, Sphere<3>::defect(p));
  }
  EXPECT_LT(worst, 5e-16);
}
