// What the trust region may expect of every subproblem of the table.
#include "solve/subproblems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "karcher/solve/dense.hpp"
#include "solve/distributed.hpp"
#include "solve/multiply.hpp"
#include "solve/random_matrix.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::random_vector;

class EverySubproblem : public ::testing::TestWithParam<SubproblemKind> {
 protected:
  static constexpr int n = 30;
  /// H and g so that those of M^-1/2 are `scaled` with the given eigenvalues, M = diag(1, 2, 1, 2, ...).
  void make(const std::vector<double>& eigenvalues) {
    subproblem.reset();
    numbers.clear();
    scaled = testing::matrix_with(eigenvalues, 3);
    std::vector<double> h(n * n), mass(n);
    for (std::size_t i = 0; i < n; ++i) mass[i] = 1.0 + static_cast<double>(i % 2);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) h[i * n + j] = std::sqrt(mass[i] * mass[j]) * scaled[i * n + j];
    d = std::make_unique<Distributed>(3, h, n);
    local_mass = d->local(mass);
    for (const int block : d->exchange.local_to_global())
      for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<std::uint64_t>(3 * block + k));
    subproblem = GetParam().make({d->exchange, d->matrix, fixed, local_mass, numbers, default_tuning, work, phases});
    set(50, true);
  }
  void set(unsigned seed, bool new_matrix = false) {
    scaled_gradient = random_vector(n, seed);
    std::vector<double> g(n);
    for (std::size_t i = 0; i < n; ++i) g[i] = std::sqrt(1.0 + static_cast<double>(i % 2)) * scaled_gradient[i];
    gradient = d->local(g);
    if (new_matrix)
      subproblem->set(d->matrix, gradient, 0);
    else
      subproblem->set_gradient(gradient);
  }
  DenseStep exact(double radius) const { return minimise_in_ball(symmetric_eigen(n, scaled), scaled_gradient, radius); }
  double decrease(const Step& step) const {
    std::vector<double> hs(step.s.size());
    multiply(d->exchange, d->matrix, {}, step.s, hs);
    return -d->exchange.dot(gradient, step.s) - 0.5 * d->exchange.dot(hs, step.s);
  }
  double norm(const std::vector<double>& s) const {
    std::vector<double> ms = s;
    for (std::size_t i = 0; i < ms.size(); ++i) ms[i] *= local_mass[i];
    return std::sqrt(d->exchange.dot(ms, s));
  }

  std::vector<double> scaled, scaled_gradient, gradient, local_mass;
  std::vector<char> fixed = std::vector<char>(n, 0);
  std::vector<std::uint64_t> numbers;
  std::unique_ptr<Distributed> d;
  WorkCounts work;
  PhaseSeconds phases;
  std::unique_ptr<Subproblem> subproblem;
};
INSTANTIATE_TEST_SUITE_P(Table, EverySubproblem, ::testing::ValuesIn(subproblems().begin(), subproblems().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

std::vector<double> spectrum(double first) {
  std::vector<double> values{first};
  for (int k = 1; k < 30; ++k) values.push_back(k);
  return values;
}

TEST_P(EverySubproblem, StaysWithinTheRadiusAndSaysWhatItPromises) {
  for (const double first : {0.5, -2.0}) {
    make(spectrum(first));
    for (const double radius : {10.0, 1.0, 0.01}) {
      const Step step = subproblem->step(radius, default_tuning.trial);
      EXPECT_LE(step.norm, radius * (1 + 1e-9));
      EXPECT_NEAR(norm(step.s), step.norm, 1e-9 * radius);
      EXPECT_NEAR(decrease(step), step.decrease, 1e-9 * std::abs(step.decrease));
      EXPECT_GE(step.decrease, 0.5 * exact(radius).decrease);
      EXPECT_LE(step.decrease, exact(radius).decrease * (1 + 1e-9));
    }
  }
}

TEST_P(EverySubproblem, GivesTheNewtonStepWhereItIsInsideAndSaysSo) {
  make(spectrum(0.5));
  const Step step = subproblem->step(1e3, default_tuning.newton);
  EXPECT_EQ(step.multiplier, 0);
  EXPECT_NEAR(step.decrease, exact(1e3).decrease, 1e-6 * step.decrease);
  EXPECT_GT(subproblem->step(0.1, default_tuning.trial).multiplier, 0);
}

TEST_P(EverySubproblem, TakesAnotherGradientForTheSameMatrix) {
  make(spectrum(0.5));
  subproblem->step(1.0, default_tuning.trial);
  const long factorisations = work.factorisations;
  set(51);
  const Step step = subproblem->step(1e3, default_tuning.newton);
  EXPECT_NEAR(step.decrease, exact(1e3).decrease, 1e-6 * step.decrease);
  EXPECT_EQ(work.factorisations, factorisations);
}

TEST_P(EverySubproblem, KnownStepsCostNothingAndCanBeAcross) {
  make(spectrum(-2));
  const Step step = subproblem->step(1.0, default_tuning.trial);
  const WorkCounts before = work;
  const Step same = subproblem->known_step(1.0), shorter = subproblem->known_step(0.25), across = subproblem->known_step(1.0, &step);
  EXPECT_EQ(work.solves, before.solves);
  EXPECT_EQ(work.factorisations, before.factorisations);
  EXPECT_NEAR(same.decrease, step.decrease, 1e-9 * step.decrease);
  EXPECT_LE(shorter.norm, 0.25 * (1 + 1e-9));
  EXPECT_GT(shorter.decrease, 0);
  std::vector<double> ms = step.s;
  for (std::size_t i = 0; i < ms.size(); ++i) ms[i] *= local_mass[i];
  EXPECT_NEAR(d->exchange.dot(ms, across.s), 0, 1e-9);
}

TEST_P(EverySubproblem, KnowsTheSignsOfTheMatrixOrNothingOfThem) {
  make(spectrum(-2));
  subproblem->step(1.0, default_tuning.trial);
  EXPECT_EQ(subproblem->inertia(0).value_or(Inertia{1}).negative, 1);
  make(spectrum(0.5));
  subproblem->step(1.0, default_tuning.trial);
  EXPECT_EQ(subproblem->inertia(0).value_or(Inertia{0}).negative, 0);
}

TEST_P(EverySubproblem, FindsTheDirectionOfNegativeCurvature) {
  make(spectrum(-2));
  subproblem->find_negative_directions();
  std::vector<double> v = subproblem->lowest_direction(), hv(v.size());
  d->exchange.update_ghosts(v);
  multiply(d->exchange, d->matrix, {}, v, hv);
  EXPECT_NEAR(norm(v), 1, 1e-12);
  EXPECT_NEAR(d->exchange.dot(v, hv), subproblem->ritz_values().front(), 1e-10);
  EXPECT_LT(subproblem->ritz_values().front(), -1.8);
  EXPECT_GE(subproblem->ritz_values().front(), -2 - 1e-12);
}

TEST_P(EverySubproblem, ForgetsTheLastMatrix) {
  make(spectrum(-2));
  subproblem->step(1.0, default_tuning.trial);
  auto positive = d->matrix;
  for (double& x : positive.values) x = 0;
  // the identity, spread over the ranks as the matrix is
  for (std::size_t i = 0; i + 1 < positive.row_begin.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) positive.values[static_cast<std::size_t>(positive.row_begin[i]) * 9 + 4 * k] = 1.0 / world_size();
  subproblem->set(positive, gradient, 0);
  const Step step = subproblem->step(1e3, default_tuning.newton);
  EXPECT_NEAR(step.decrease, 0.5 * d->exchange.dot(gradient, gradient), 1e-9 * step.decrease);
  EXPECT_EQ(subproblem->inertia(0).value_or(Inertia{0}).negative, 0);
}

}  // namespace
}  // namespace karcher
