#include "solve/direct_subproblem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "solve/distributed.hpp"
#include "solve/multiply.hpp"
#include "solve/random_matrix.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::matrix_with;
using testing::random_vector;

/// A subproblem of n unknowns with eigenvalues of M^-1/2 H M^-1/2 as given, and its dense reference.
struct Problem {
  std::vector<double> mass, scaled, scaled_gradient, gradient;
  std::unique_ptr<Distributed> d;
  std::vector<char> fixed;
  std::vector<double> local_mass;
  std::vector<std::uint64_t> numbers;
  WorkCounts work;
  PhaseSeconds phases;
  std::unique_ptr<DirectSubproblem> subproblem;

  /// missing: eigenvectors to which the gradient is orthogonal; noise: relative errors of the matrix
  Problem(const std::vector<double>& eigenvalues, unsigned seed, const std::vector<int>& missing = {}, double noise = 0) {
    const std::size_t n = eigenvalues.size();
    std::vector<double> q;
    scaled = matrix_with(eigenvalues, seed, &q);
    scaled_gradient = random_vector(static_cast<int>(n), seed + 1000);
    for (int k : missing) {
      const double* x = q.data() + static_cast<std::size_t>(k) * n;
      const double component = std::inner_product(x, x + n, scaled_gradient.begin(), 0.0);
      for (std::size_t i = 0; i < n; ++i) scaled_gradient[i] -= component * x[i];
    }
    make(noise, seed + 2000);
  }
  /// M^-1/2 H M^-1/2 and M^-1/2 g as given
  Problem(std::vector<double> matrix, std::vector<double> g) : scaled(std::move(matrix)), scaled_gradient(std::move(g)) { make(0, 0); }
  void make(double noise, unsigned seed) {
    const std::size_t n = scaled_gradient.size();
    std::vector<double> h(n * n), errors = random_vector(static_cast<int>(n * n), seed);
    for (std::size_t i = 0; i < n; ++i) mass.push_back(0.01 + 0.1 * static_cast<double>(i % 5));
    for (std::size_t i = 0; i < n; ++i) {
      gradient.push_back(std::sqrt(mass[i]) * scaled_gradient[i]);
      for (std::size_t j = 0; j < n; ++j)
        h[i * n + j] = std::sqrt(mass[i] * mass[j]) * scaled[i * n + j] * (1 + noise * errors[std::min(i, j) * n + std::max(i, j)]);
    }
    d = std::make_unique<Distributed>(2, h, static_cast<int>(n));
    fixed.assign(n, 0);
    local_mass = d->local(mass);
    for (int block : d->exchange.local_to_global())
      for (int k = 0; k < 2; ++k) numbers.push_back(static_cast<std::uint64_t>(2 * block + k));
    subproblem =
        std::make_unique<DirectSubproblem>(SubproblemInput{d->exchange, d->matrix, fixed, local_mass, numbers, default_tuning, work, phases});
    subproblem->set(d->matrix, d->local(gradient), 0);
  }
  /// Another matrix of the same pattern: that of `other`, with its gradient.
  void set(const Problem& other, double shift) {
    scaled = other.scaled;
    scaled_gradient = other.scaled_gradient;
    gradient = other.gradient;
    d->matrix.values = other.d->matrix.values;
    subproblem->set(d->matrix, d->local(gradient), shift);
  }
  DenseStep reference(double radius) const {
    return minimise_in_ball(symmetric_eigen(static_cast<int>(mass.size()), scaled), scaled_gradient, radius);
  }
};

std::vector<double> spread(int n, double low, double high) {
  std::vector<double> values;
  for (int k = 0; k < n; ++k) values.push_back(low * std::pow(high / low, k / (n - 1.0)));
  return values;
}

TEST(DirectSubproblem, TakesTheNewtonStepWithOneFactorisationWhereItIsInside) {
  Problem p(spread(60, 1e-3, 1e6), 1);
  const auto step = p.subproblem->step(1e9, {.accuracy = 1e-8, .expansions = 20, .refactorisations = 3});
  EXPECT_EQ(step.multiplier, 0);
  EXPECT_NEAR(step.decrease, p.reference(1e9).decrease, 1e-7 * step.decrease);
  EXPECT_EQ(p.work.factorisations, 1);
  EXPECT_LE(p.work.solves, 3);
}

TEST(DirectSubproblem, AgreesWithTheDenseSolutionForAnyRadius) {
  for (double lowest : {-1.0, 1e-4}) {
    auto eigenvalues = spread(80, 1e-4, 1e6);
    eigenvalues[0] = lowest;
    eigenvalues[1] = 3 * lowest;
    Problem p(eigenvalues, 2);
    for (double radius : {1e3, 10.0, 1.0, 1e-2, 1e-4, 1e-6}) {
      const auto step = p.subproblem->step(radius, {.accuracy = 1e-6, .expansions = 20, .refactorisations = 3});
      const DenseStep exact = p.reference(radius);
      EXPECT_NEAR(step.norm, std::min(radius, step.norm), 1e-9 * radius);
      EXPECT_NEAR(step.decrease, exact.decrease, 1e-2 * exact.decrease) << "radius " << radius << ", lowest eigenvalue " << lowest;
      EXPECT_LE(step.decrease, exact.decrease * (1 + 1e-9));
    }
    EXPECT_LE(p.work.factorisations, 8);
  }
}

TEST(DirectSubproblem, TheDecreaseIsThatOfTheReturnedStep) {
  auto eigenvalues = spread(50, 1e-2, 1e4);
  eigenvalues[0] = -0.3;
  Problem p(eigenvalues, 3);
  auto step = p.subproblem->step(0.7, {.accuracy = 1e-2, .expansions = 20, .refactorisations = 3});
  p.d->exchange.update_ghosts(step.s);
  std::vector<double> hs(step.s.size());
  multiply(p.d->exchange, p.d->matrix, {}, step.s, hs);
  const auto g = p.d->local(p.gradient);
  EXPECT_NEAR(-p.d->exchange.dot(g, step.s) - 0.5 * p.d->exchange.dot(hs, step.s), step.decrease, 1e-10 * step.decrease);
  double square = 0;
  const auto s = p.d->global(step.s);
  for (std::size_t i = 0; i < s.size(); ++i) square += p.mass[i] * s[i] * s[i];
  EXPECT_NEAR(std::sqrt(square), step.norm, 1e-12);
}

TEST(DirectSubproblem, FindsNegativeCurvatureThatTheGradientDoesNotSee) {
  auto eigenvalues = spread(60, 1e-2, 1e4);
  eigenvalues[5] = -2;
  Problem p(eigenvalues, 4, {5});
  EXPECT_EQ(p.subproblem->inertia(0)->negative, 1);
  const auto step = p.subproblem->step(3.0, {.accuracy = 1e-4, .expansions = 20, .refactorisations = 3});
  EXPECT_EQ(p.subproblem->negative_in_basis(), 1);
  EXPECT_NEAR(step.multiplier, 2, 1e-4);
  const DenseStep exact = p.reference(3.0);
  EXPECT_NEAR(step.decrease, exact.decrease, 1e-4 * exact.decrease);
}

TEST(DirectSubproblem, DoesNotLeaveItToRoundingWhichWayAStructureBuckles) {
  // Twelve directions of negative curvature, of which the gradient sees one: the others are in no residual, but for rounding.
  auto eigenvalues = spread(80, 1, 1e6);
  std::vector<int> missing;
  for (int k = 0; k < 12; ++k) {
    eigenvalues[static_cast<std::size_t>(k)] = -1 - 0.1 * k;
    if (k > 0) missing.push_back(k);
  }
  std::vector<double> steps[2];
  for (int run : {0, 1}) {
    Problem p(eigenvalues, 8, missing, run * 1e-15);
    steps[run] = p.d->global(p.subproblem->step(3.0, default_tuning.trial).s);
  }
  for (std::size_t i = 0; i < 80; ++i) EXPECT_NEAR(steps[1][i], steps[0][i], 1e-6 * *std::max_element(steps[0].begin(), steps[0].end()));
}

TEST(DirectSubproblem, ReachesCauchysDecreaseForANewGradientWithoutAnyEffort) {
  Problem p(spread(80, 1e-4, 1e6), 9);
  const double radius = 1e-9;
  const Effort none{.accuracy = 1, .expansions = 0, .refactorisations = 0};
  for (unsigned seed : {1, 2, 3}) {
    p.scaled_gradient = random_vector(80, seed);
    for (std::size_t i = 0; i < 80; ++i) p.gradient[i] = std::sqrt(p.mass[i]) * p.scaled_gradient[i];
    p.subproblem->set_gradient(p.d->local(p.gradient));
    const double steepest = std::sqrt(std::inner_product(p.scaled_gradient.begin(), p.scaled_gradient.end(), p.scaled_gradient.begin(), 0.0));
    EXPECT_GE(p.subproblem->step(radius, none).decrease, radius * steepest - 0.5e6 * radius * radius) << seed;
  }
}

TEST(DirectSubproblem, FindsTheAsymmetricWayInWhichASymmetricStructureBuckles) {
  // Unknowns 0 and 5, of the same mass, can be exchanged: gradient and mass are symmetric, the only direction of negative curvature, (1, -1), is not.
  const std::size_t n = 20;
  std::vector<double> matrix(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) matrix[i * (n + 1)] = 10 + static_cast<double>(i);
  matrix[0] = matrix[5 * (n + 1)] = 4;
  matrix[5] = matrix[5 * n] = 6;
  Problem p(matrix, std::vector<double>(n, 1.0));
  p.subproblem->find_negative_directions();
  EXPECT_EQ(p.subproblem->negative_in_basis(), 1);
  EXPECT_NEAR(p.subproblem->ritz_values().front(), -2, 1e-3);
}

TEST(DirectSubproblem, ShiftsTheNextMatrixByTheMultiplierAndByHalfOfItAfterAGoodStep) {
  Problem p(spread(60, 1e-3, 1e3), 10);
  const Step step = p.subproblem->step(1e-2, default_tuning.trial);
  EXPECT_GT(step.multiplier, 1);
  EXPECT_EQ(p.subproblem->next_shift(step, 0.74), step.multiplier);
  EXPECT_EQ(p.subproblem->next_shift(step, 0.76), 0.5 * step.multiplier);
}

TEST(DirectSubproblem, KeepsItsShiftWhileItsBasisLacksDirectionsOfNegativeCurvature) {
  auto eigenvalues = spread(60, 1e-2, 1e4);
  eigenvalues[5] = -2;
  Problem p(eigenvalues, 4, {5});
  p.subproblem->set(p.d->matrix, p.d->local(p.gradient), 1.0);
  Step accepted;
  accepted.multiplier = 0.1;
  EXPECT_EQ(p.subproblem->next_shift(accepted, 1), 1.0);
  p.subproblem->find_negative_directions();
  EXPECT_EQ(p.subproblem->negative_in_basis(), 1);
  EXPECT_EQ(p.subproblem->next_shift(accepted, 1), 0.05);
}

TEST(DirectSubproblem, DoesNotSeekTheDirectionsOfNegativeCurvatureThatOnlyTheLastMatrixHad) {
  // Of H + 1.5 M the last matrix has twelve, this one has one, which the gradient sees: nothing asks for another factorisation.
  auto eigenvalues = spread(60, 1, 1e4);
  eigenvalues[0] = -2;
  const Problem next(eigenvalues, 4);
  for (std::size_t k = 0; k < 12; ++k) eigenvalues[k] = -2 - 0.1 * static_cast<double>(k);
  Problem p(eigenvalues, 4);
  p.subproblem->set(p.d->matrix, p.d->local(p.gradient), 1.5);
  p.set(next, 0.0);
  const long before = p.work.factorisations;
  const Step step = p.subproblem->step(3.0, {.accuracy = 1e-3, .expansions = 20, .refactorisations = 3});
  EXPECT_NEAR(step.decrease, p.reference(3.0).decrease, 2e-3 * step.decrease);
  EXPECT_EQ(p.work.factorisations, before);
}

TEST(DirectSubproblem, NeedsNoFactorisationForAnotherRadius) {
  auto eigenvalues = spread(60, 1e-3, 1e3);
  eigenvalues[0] = -0.1;
  Problem p(eigenvalues, 6);
  p.subproblem->step(2.0, {.accuracy = 1e-3, .expansions = 20, .refactorisations = 3});
  const auto before = p.work;
  const auto step = p.subproblem->step(1.0, {.accuracy = 1e-3, .expansions = 20, .refactorisations = 3});
  EXPECT_EQ(p.work.factorisations, before.factorisations);
  EXPECT_LE(p.work.solves - before.solves, 3);
  EXPECT_NEAR(step.decrease, p.reference(1.0).decrease, 2e-3 * step.decrease);
}

}  // namespace
}  // namespace karcher
