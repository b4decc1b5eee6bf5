#include "solve/ldlt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  // Stiffness of free chains of springs: each has one rigid motion.
  for (int chains : {1, 2}) {
    const int n = 8, length = n / chains;
    std::vector<double> a(n * n, 0.0);
    for (int i = 0; i + 1 < n; ++i) {
      if ((i + 1) % length == 0) continue;
      const auto at = static_cast<std::size_t>(i * (n + 1));
      a[at] += 1;
      a[at + n + 1] += 1;
      a[at + 1] -= 1;
      a[at + n] -= 1;
    }
    const Distributed d(2, a, n);
    Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(n, 0));
    const std::vector<double> mass(n, 1.0);
    const Inertia singular = ldlt.factor(d.matrix, 0, mass), positive = ldlt.factor(d.matrix, 1e-3, mass),
                  negative = ldlt.factor(d.matrix, -1e-3, mass);
    EXPECT_EQ(singular.negative, 0);
    EXPECT_EQ(singular.null, chains);
    EXPECT_EQ(positive.negative, 0);
    EXPECT_EQ(positive.null, 0);
    EXPECT_EQ(negative.negative, chains);
    EXPECT_EQ(negative.null, 0);
  }
}

TEST(Ldlt, SolvesForSeveralRightHandSidesAtOnce) {
  // With one block, all ranks but one own nothing.
  for (int blocks : {1, 2, 20}) {
    const int n = 3 * blocks, count = 40;  // more than MUMPS takes at a time
    std::vector<double> eigenvalues;
    for (int k = 0; k < n; ++k) eigenvalues.push_back(k % 3 == 0 ? -1 - k : 2 + k);
    const auto a = matrix_with(eigenvalues, 11);
    const Distributed d(3, a, n);
    Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(static_cast<std::size_t>(n), 0));
    ldlt.factor(d.matrix, 0, std::vector<double>(static_cast<std::size_t>(n), 1.0));
    std::vector<double> sides, x(static_cast<std::size_t>(n * count));
    for (unsigned c = 0; c < count; ++c) {
      const auto column = d.local(random_vector(n, 100 + c));
      sides.insert(sides.end(), column.begin(), column.end());
    }
    ldlt.solve(sides, x, count);
    for (unsigned c = 0; c < count; ++c) {
      const auto begin = x.begin() + static_cast<std::ptrdiff_t>(c) * n;
      const auto back = times(a, d.global({begin, begin + n})), b = random_vector(n, 100 + c);
      for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(back[i], b[i], 1e-11);
    }
  }
}

/// Adjacency matrix of a grid of m x n points: all diagonal entries are zero, so the pivots must wait for their neighbours. Its eigenvalues are
/// 2 cos(pi i / (m + 1)) + 2 cos(pi j / (n + 1)): half of them negative, and none zero if m + 1 and n + 1 have no common divisor.
std::vector<double> grid(int m, int n) {
  const int size = m * n;
  std::vector<double> a(static_cast<std::size_t>(size * size), 0.0);
  const auto couple = [&](int p, int q) { a[static_cast<std::size_t>(p * size + q)] = a[static_cast<std::size_t>(q * size + p)] = 1; };
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j) {
      if (i + 1 < m) couple(i * n + j, (i + 1) * n + j);
      if (j + 1 < n) couple(i * n + j, i * n + j + 1);
    }
  return a;
}

TEST(Ldlt, FindsRoomForDelayedPivotsAndCountsTheFactorisationsThatHadTooLittle) {
  const int m = 30, n = 40, size = m * n;
  const auto a = grid(m, n);
  const Distributed d(1, a, size, true);
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(static_cast<std::size_t>(size), 0));
  const std::vector<double> mass(static_cast<std::size_t>(size), 1.0);
  EXPECT_EQ(ldlt.factor(d.matrix, 0, mass).negative, size / 2);
  const long first = ldlt.factorisations();
  EXPECT_GT(first, 1);
  EXPECT_EQ(ldlt.factor(d.matrix, 0, mass).negative, size / 2);
  EXPECT_EQ(ldlt.factorisations(), first + 1);  // the room is there now
  const auto b = random_vector(size, 3);
  std::vector<double> x(static_cast<std::size_t>(size));
  ldlt.solve(d.local(b), x);
  const auto back = times(a, d.global(x));
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(back[i], b[i], 1e-9);
}

TEST(Ldlt, PutsTheSolutionWhereItBelongsThoughPivotsHaveMoved) {
  // Where the diagonal is large, all pivots stay in place; where it is zero, many must wait, and on several ranks other ranks eliminate them.
  const int m = 30, n = 40, size = m * n;
  const auto a = grid(m, n);
  const Distributed d(1, a, size, true);
  Ldlt ldlt(d.exchange, d.matrix, std::vector<char>(static_cast<std::size_t>(size), 0));
  const std::vector<double> mass(static_cast<std::size_t>(size), 1.0), b = random_vector(size, 3);
  for (const double shift : {10.0, 0.0, 10.0}) {
    ldlt.factor(d.matrix, shift, mass);
    std::vector<double> x(static_cast<std::size_t>(size));
    ldlt.solve(d.local(b), x);
    const std::vector<double> solution = d.global(x);
    const auto back = times(a, solution);
    double error = 0;
    for (std::size_t i = 0; i < b.size(); ++i) error = std::max(error, std::abs(back[i] + shift * solution[i] - b[i]));
    EXPECT_LT(error, 1e-9) << shift;
  }
}

}  // namespace
}  // namespace karcher
