#include "solve/subspace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solve/distributed.hpp"
#include "solve/random_matrix.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::random_vector;

/// n unknowns, H with the eigenvalues 1 .. n in a random basis, M = diag(1 / 2, 1, 3 / 2, ...).
struct Problem {
  static constexpr int n = 12;
  std::vector<double> dense, mass;
  Distributed d;
  std::vector<char> fixed = std::vector<char>(n, 0);
  std::vector<double> local_mass;
  std::vector<std::uint64_t> numbers;
  WorkCounts work;
  PhaseSeconds phases;
  Subspace space;
  static std::vector<double> matrix() {
    std::vector<double> eigenvalues(n);
    std::iota(eigenvalues.begin(), eigenvalues.end(), 1.0);
    return testing::matrix_with(eigenvalues, 21);
  }
  static std::vector<double> masses() {
    std::vector<double> m;
    for (int i = 0; i < n; ++i) m.push_back(0.5 * (i + 1));
    return m;
  }
  Problem()
      : dense(matrix()),
        mass(masses()),
        d(2, dense, n),
        local_mass(d.local(mass)),
        space(SubproblemInput{d.exchange, d.matrix, fixed, local_mass, numbers, default_tuning, work, phases}) {
    space.set_matrix(d.matrix);
    space.set_gradient(d.local(random_vector(n, 22)));
  }
  double product(const std::vector<double>& a, const std::vector<double>& b) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += mass[i] * a[i] * b[i];
    return sum;
  }
  std::vector<double> vector(int i) const { return d.global(space.vector(i)); }
};

TEST(Subspace, StaysOrthonormalToRoundingThoughTheVectorsAreNearlyParallel) {
  Problem p;
  const std::vector<double> first = random_vector(Problem::n, 30);
  for (unsigned k = 0; k < 6; ++k) {
    std::vector<double> w = first, other = random_vector(Problem::n, 31 + k);
    for (std::size_t i = 0; i < w.size(); ++i) w[i] += 1e-4 * other[i];
    EXPECT_TRUE(p.space.expand(p.d.local(w)));
  }
  ASSERT_EQ(p.space.size(), 6);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) EXPECT_NEAR(p.product(p.vector(i), p.vector(j)), i == j, 1e-14) << i << j;
}

TEST(Subspace, TakesNoVectorOfWhichOrthogonalisationLeavesRounding) {
  Problem p;
  const std::vector<double> first = random_vector(Problem::n, 30);
  EXPECT_FALSE(p.space.expand(std::vector<double>(Problem::n, 0.0)));
  EXPECT_TRUE(p.space.expand(p.d.local(first)));
  std::vector<double> other = random_vector(Problem::n, 31);
  // Across the first one, and as long.
  const double along = p.product(first, other) / p.product(first, first);
  for (std::size_t i = 0; i < other.size(); ++i) other[i] -= along * first[i];
  const double scale = std::sqrt(p.product(first, first) / p.product(other, other));
  const auto tilted = [&](double by) {
    std::vector<double> w = first;
    for (std::size_t i = 0; i < w.size(); ++i) w[i] += by * scale * other[i];
    return p.d.local(w);
  };
  EXPECT_FALSE(p.space.expand(tilted(0.9e-5)));
  EXPECT_EQ(p.space.size(), 1);
  EXPECT_TRUE(p.space.expand(tilted(1.1e-5)));
  EXPECT_EQ(p.space.size(), 2);
}

TEST(Subspace, MinimisesInItsSpanOnlyAndAcrossAGivenVector) {
  Problem p;
  for (unsigned k = 0; k < 4; ++k) p.space.expand(p.d.local(random_vector(Problem::n, 40 + k)));
  const double radius = 0.05;
  const Step whole = p.space.step_of(p.space.minimise(radius, {}));
  const Step across = p.space.step_of(p.space.minimise(radius, whole.coordinates));
  const std::vector<double> s = p.d.global(whole.s), t = p.d.global(across.s), g = random_vector(Problem::n, 22);
  EXPECT_NEAR(p.product(s, t), 0, 1e-14);
  EXPECT_NEAR(std::sqrt(p.product(s, s)), radius, 1e-14);
  EXPECT_NEAR(std::sqrt(p.product(t, t)), across.norm, 1e-14);
  const auto fall = [&](const std::vector<double>& x) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum -= g[i] * x[i];
      for (std::size_t j = 0; j < x.size(); ++j) sum -= 0.5 * x[i] * p.dense[i * x.size() + j] * x[j];
    }
    return sum;
  };
  EXPECT_NEAR(fall(s), whole.decrease, 1e-13);
  EXPECT_NEAR(fall(t), across.decrease, 1e-13);
  // Both are the best of their kind: no combination with another vector of the span of the same length is better.
  for (unsigned seed = 50; seed < 70; ++seed) {
    const std::vector<double> y = random_vector(4, seed);
    std::vector<double> x = p.d.global(p.space.combine(y));
    const double length = std::sqrt(p.product(x, x));
    for (double& c : x) c *= radius / length;
    EXPECT_LE(fall(x), whole.decrease);
    const double along = p.product(x, s) / p.product(s, s);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= along * s[i];
    EXPECT_LE(fall(x), across.decrease);
    for (double& c : x) c = -c;
    EXPECT_LE(fall(x), across.decrease);
  }
  EXPECT_GT(across.decrease, 0);
}

TEST(Subspace, GhostsOfAStepAreTheBitsOfTheirOwnersThoughTheRanksRoundedItsVectorsDifferently) {
  Problem p;
  const auto owned = static_cast<std::size_t>(p.d.exchange.owned_dofs());
  for (unsigned k = 0; k < 3; ++k) {
    std::vector<double> w = p.d.local(random_vector(Problem::n, 40 + k));
    for (std::size_t i = owned; i < w.size(); ++i) w[i] *= 1 + 1e-14;
    p.space.expand(std::move(w));
  }
  const std::vector<double> s = p.space.step_of(p.space.minimise(0.05, {})).s;
  std::vector<double> expected = s;
  std::fill(expected.begin() + static_cast<std::ptrdiff_t>(owned), expected.end(), 0.0);
  p.d.exchange.update_ghosts(expected);
  EXPECT_EQ(s, expected);
}

TEST(Subspace, KnowsItsProductsWithTheMatrix) {
  Problem p;
  for (unsigned k = 0; k < 3; ++k) p.space.expand(p.d.local(random_vector(Problem::n, 40 + k)));
  const std::vector<double> y{0.3, -2, 1.5};
  const std::vector<double> x = p.d.global(p.space.combine(y)), hx = p.d.global(p.space.combine_products(y));
  for (std::size_t i = 0; i < x.size(); ++i) {
    double expected = 0;
    for (std::size_t j = 0; j < x.size(); ++j) expected += p.dense[i * x.size() + j] * x[j];
    EXPECT_NEAR(hx[i], expected, 1e-12);
  }
  // Ritz values interlace: the lowest is at least the lowest eigenvalue of H x = lambda M x, and the sum of all is the trace of V^T H V.
  double trace = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> unit_vector(3, 0.0);
    unit_vector[static_cast<std::size_t>(k)] = 1;
    const auto v = p.d.global(p.space.combine(unit_vector)), hv = p.d.global(p.space.combine_products(unit_vector));
    trace += std::inner_product(v.begin(), v.end(), hv.begin(), 0.0);
  }
  const auto& ritz = p.space.spectrum().values;
  EXPECT_NEAR(ritz[0] + ritz[1] + ritz[2], trace, 1e-12);
  EXPECT_LT(ritz[0], ritz[2]);
}

}  // namespace
}  // namespace karcher
