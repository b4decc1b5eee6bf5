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

TEST(Stability, TakesEigenvaluesThatAreZeroToRoundingForNeutral) {
  const Stability rounding = of_diagonal(1, -5e-14), small = of_diagonal(1, -2e-13), zero = of_diagonal(1, 0);
  EXPECT_EQ(rounding.negative, 0);
  EXPECT_EQ(rounding.neutral, 1);
  EXPECT_EQ(small.negative, 1);
  EXPECT_EQ(small.neutral, 0);
  EXPECT_EQ(zero.negative, 0);
  EXPECT_EQ(zero.neutral, 1);
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
