#include "solve/stability.hpp"

#include <gtest/gtest.h>

#include "solve/few_unknowns.hpp"

namespace karcher {
namespace {

using testing::Local2;
using testing::TwoUnknowns;

TEST(Stability, SaysInWordsWhatThePointIs) {
  EXPECT_EQ((Stability{0, 0}.kind()), "a local minimum");
  EXPECT_EQ((Stability{1, 0}.kind()), "not a local minimum: the Hessian has 1 negative eigenvalue");
  EXPECT_EQ((Stability{3, 0}.kind()), "not a local minimum: the Hessian has 3 negative eigenvalues");
  EXPECT_EQ((Stability{0, 1}.kind()), "a local minimum (1 eigenvalue is zero to rounding)");
  EXPECT_EQ((Stability{2, 6}.kind()), "not a local minimum: the Hessian has 2 negative eigenvalues (6 eigenvalues are zero to rounding)");
  EXPECT_EQ(Stability{}.kind(), "not judged: this subproblem cannot count negative eigenvalues");
}

/// Hessian diag(first, second) on one rank or several, linearised before at another point with a shift.
Stability of_diagonal(double first, double second) {
  TwoUnknowns p([=](double a, double b) { return Local2{a * a + b * b, 2 * a, 2 * b, first, 0, second}; });
  System system(*p.functional, {}, default_tuning);
  Iterate elsewhere, x;
  elsewhere.u = x.u = p.u;
  elsewhere.u.values[0][0] += 0.1;
  EXPECT_TRUE(system.linearise(elsewhere, 100.0));
  const auto found = stability_at(system, x);
  EXPECT_TRUE(found);
  return *found;
}

TEST(Stability, CountsNegativeEigenvaluesOfTheHessianItself) {
  EXPECT_EQ(of_diagonal(1, 2).negative, 0);
  EXPECT_EQ(of_diagonal(1, -2).negative, 1);
  EXPECT_EQ(of_diagonal(-1, -2).negative, 2);
  EXPECT_EQ(of_diagonal(1, -2).neutral, 0);
}

TEST(Stability, CountsTheHessianItselfThoughAShiftedOneIsFactorisedAtThePoint) {
  TwoUnknowns p([](double a, double b) { return Local2{a * a + b * b, 2 * a, 2 * b, 1, 0, -2}; });
  System system(*p.functional, {}, default_tuning);
  Iterate x;
  x.u = p.u;
  EXPECT_TRUE(system.linearise(x, 100.0));
  EXPECT_EQ(stability_at(system, x)->negative, 1);
  EXPECT_EQ(system.work.factorisations, 2);
}

TEST(Stability, TakesEigenvaluesThatAreZeroToRoundingForNeutralWhateverTheirSign) {
  for (const double e : {0.0, 5e-12, -5e-12, 1e-15, -1e-15}) {
    const Stability found = of_diagonal(1, e);
    EXPECT_EQ(found.negative, 0) << e;
    EXPECT_EQ(found.neutral, 1) << e;
  }
  for (const double e : {2e-11, -2e-11, 1e-9, -1e-9}) {
    const Stability found = of_diagonal(1, e);
    EXPECT_EQ(found.negative, e < 0 ? 1 : 0) << e;
    EXPECT_EQ(found.neutral, 0) << e;
  }
  const Stability both = of_diagonal(-1, 3e-12);
  EXPECT_EQ(both.negative, 1);
  EXPECT_EQ(both.neutral, 1);
}

TEST(Stability, CostsTwoFactorisationsMoreOnlyWhereAnEigenvalueIsNearlyZero) {
  for (const double e : {1.0, -1.0, 1e-6, 0.0}) {
    TwoUnknowns p([=](double, double) { return Local2{0, 0, 0, 1, 0, e}; });
    System system(*p.functional, {}, default_tuning);
    Iterate x;
    x.u = p.u;
    ASSERT_TRUE(stability_at(system, x));
    EXPECT_EQ(system.work.factorisations, e == 0 ? 3 : 1) << e;
    EXPECT_LE(system.work.solves, e < 0 ? 12 : 4);
  }
}

TEST(Stability, TellsALoadThatWorksAlongANeutralDirection) {
  const auto loaded = [](double along_stiff, double along_neutral) {
    TwoUnknowns p([=](double, double) { return Local2{0, along_stiff, along_neutral, 1, 0, 0}; });
    System system(*p.functional, {}, default_tuning);
    Iterate x;
    x.u = p.u;
    return stability_at(system, x)->loaded;
  };
  EXPECT_TRUE(loaded(0, 1e-3));
  EXPECT_TRUE(loaded(1, -1));
  EXPECT_FALSE(loaded(1, 0));
  EXPECT_FALSE(loaded(1, 1e-3));
  EXPECT_FALSE(loaded(0, 0));
}

TEST(Stability, IsNotKnownWhereTheHessianCannotBeEvaluated) {
  TwoUnknowns p([](double, double) { return Local2{0, 0, 0, NAN, 0, 1}; });
  System system(*p.functional, {}, default_tuning);
  Iterate x;
  x.u = p.u;
  EXPECT_FALSE(stability_at(system, x));
  EXPECT_NE(x.failure, "");
}

}  // namespace
}  // namespace karcher
