#include "solve/ldlt.hpp"

#include <gtest/gtest.h>

#include "solve/distributed.hpp"
#include "solve/random_matrix.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::matrix_with;
using testing::random_vector;

std::vector<double> times(const std::vector<double>& a, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) y[i] += a[i * x.size() + j] * x[j];
  return y;
}

TEST(Ldlt, CountsTheNegativeEigenvaluesOfTheShiftedMatrix) {
  std::vector<double> eigenvalues;
  for (int k = 0; k < 24; ++k) eigenvalues.push_back(-5.5 + k);
  const auto a = matrix_with(eigenvalues, 1);
  const Distributed d(3, a, 24);
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(24, 0));
  const std::vector<double> mass(24, 1.0);
  EXPECT_EQ(ldlt.factor(d.matrix, 0, mass).negative, 6);
  EXPECT_EQ(ldlt.factor(d.matrix, 3, mass).negative, 3);
  EXPECT_EQ(ldlt.factor(d.matrix, -10, mass).negative, 16);
  EXPECT_EQ(ldlt.factor(d.matrix, 100, mass).negative, 0);
}

TEST(Ldlt, SolvesWithTheShiftedMatrix) {
  const auto a = matrix_with({-4, -1, 0.5, 1, 2, 3, 4, 5, 6, 70}, 2);
  const Distributed d(2, a, 10);
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(10, 0));
  std::vector<double> mass(10), shifted = a;
  for (std::size_t i = 0; i < 10; ++i) {
    mass[i] = 0.5 + 0.1 * static_cast<double>(i);
    shifted[i * 11] += 1.5 * mass[i];
  }
  ldlt.factor(d.matrix, 1.5, d.local(mass));
  const auto b = random_vector(10, 3);
  std::vector<double> x(10);
  ldlt.solve(d.local(b), x);
  const auto back = times(shifted, d.global(x));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(back[i], b[i], 1e-12);
}

TEST(Ldlt, LeavesFixedUnknownsOutOfInertiaAndSolution) {
  // Eigenvalues of the remaining diagonal: -2, 3; the fixed ones are negative.
  std::vector<double> a(16, 0.0);
  const double diagonal[] = {-2, -7, 3, -9};
  for (std::size_t i = 0; i < 4; ++i) a[i * 5] = diagonal[i];
  a[1] = a[4] = 100;  // couples to a fixed unknown
  const Distributed d(1, a, 4);
  const auto local_fixed = d.local({0, 1, 0, 1});
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(local_fixed.begin(), local_fixed.end()));
  EXPECT_EQ(ldlt.factor(d.matrix, 0, std::vector<double>(4, 1.0)).negative, 1);
  std::vector<double> x(4);
  ldlt.solve(d.local({4, 5, 6, 7}), x);
  const auto solution = d.global(x);
  const double expected[] = {-2, 0, 2, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution[i], expected[i], 1e-15);
}

TEST(Ldlt, ReportsNullPivotsOfASingularMatrix) {
  const auto a = matrix_with({0, 1, 2, 3, 4, 5, 6, 7}, 5);
  const Distributed d(2, a, 8);
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(8, 0));
  const Inertia inertia = ldlt.factor(d.matrix, 0, std::vector<double>(8, 1.0));
  EXPECT_LE(inertia.negative + inertia.null, 1);
  EXPECT_EQ(ldlt.factor(d.matrix, 1e-3, std::vector<double>(8, 1.0)).negative, 0);
}

}  // namespace
}  // namespace karcher
