#include "karcher/solve/dense.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solve/random_matrix.hpp"

namespace karcher {
namespace {

using testing::matrix_with;
using testing::random_vector;

double norm(const std::vector<double>& v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

/// |(B + lambda I) y + b|
double residual(const std::vector<double>& matrix, const DenseStep& step, const std::vector<double>& b) {
  const std::size_t n = b.size();
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double r = b[i] + step.multiplier * step.y[i];
    for (std::size_t j = 0; j < n; ++j) r += matrix[i * n + j] * step.y[j];
    square += r * r;
  }
  return std::sqrt(square);
}

TEST(BallProblem, IsTheNewtonStepWhereThatIsInside) {
  const auto a = matrix_with({1, 2, 3, 4}, 1);
  const auto b = random_vector(4, 2);
  const DenseStep step = minimise_in_ball(symmetric_eigen(4, a), b, 100);
  EXPECT_EQ(step.multiplier, 0);
  EXPECT_LT(residual(a, step, b), 1e-13);
}

TEST(BallProblem, MeetsTheConditionsOfMoreAndSorensenOnTheBoundary) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<double> eigenvalues{-3.0, -1e-3, 1e-6, 0.5, 2, 1e4};
    const auto a = matrix_with(eigenvalues, seed);
    const auto b = random_vector(6, seed + 50);
    for (double radius : {1e-6, 1e-2, 1.0, 50.0}) {
      const DenseStep step = minimise_in_ball(symmetric_eigen(6, a), b, radius);
      EXPECT_NEAR(norm(step.y) / radius, 1, 1e-11);
      EXPECT_GE(step.multiplier, 3.0 * (1 - 1e-12));
      EXPECT_LT(residual(a, step, b), 1e-9 * (norm(b) + 1e4 * radius));
    }
  }
}

TEST(BallProblem, ReachesTheBoundaryAlongTheLowestEigenvectorInTheHardCase) {
  std::vector<double> q;
  const auto a = matrix_with({-2, 1, 3}, 7, &q);
  std::vector<double> b(3);
  for (std::size_t i = 0; i < 3; ++i) b[i] = 0.5 * q[3 + i] - 0.2 * q[6 + i];  // orthogonal to the eigenvector of -2
  const double radius = 4;
  const DenseStep step = minimise_in_ball(symmetric_eigen(3, a), b, radius);
  EXPECT_NEAR(step.multiplier, 2, 1e-12);
  EXPECT_NEAR(norm(step.y), radius, 1e-12);
  // decrease = 1/2 (lambda radius^2 + b.(B + lambda)^+ b), More and Sorensen 1983
  EXPECT_NEAR(step.decrease, 0.5 * (2 * radius * radius + 0.25 / 3 + 0.04 / 5), 1e-11);
}

TEST(BallProblem, ReachesTheBoundaryDownhillThoughTheSlopeIsFarBelowRounding) {
  const Spectrum eigen = symmetric_eigen(3, {-2, 0, 0, 0, 1, 0, 0, 0, 3});
  const auto along_lowest = [&](double slope) { return minimise_in_ball(eigen, std::vector<double>{slope, 0.5, -0.2}, 4).y[0]; };
  EXPECT_LT(along_lowest(1e-18), -3.9);
  EXPECT_EQ(along_lowest(-1e-18), -along_lowest(1e-18));
}

TEST(BallProblem, WithoutGradientFollowsNegativeCurvatureOnly) {
  const auto down = minimise_in_ball(symmetric_eigen(2, matrix_with({-1, 5}, 3)), std::vector<double>{0, 0}, 2);
  EXPECT_NEAR(down.decrease, 2, 1e-13);
  const auto rest = minimise_in_ball(symmetric_eigen(2, matrix_with({1, 5}, 3)), std::vector<double>{0, 0}, 2);
  EXPECT_EQ(rest.decrease, 0);
}

}  // namespace
}  // namespace karcher
