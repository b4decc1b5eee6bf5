#include "solve/rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solve/distributed.hpp"
#include "solve/few_unknowns.hpp"
#include "solve/random_matrix.hpp"
#include "solve/small_problem.hpp"
#include "solve/system.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::Local;
using testing::OneUnknown;
using testing::random_vector;
using testing::SmallProblem;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(Rounding, OfAGradientIsThatOfTheProductsOfStiffnessesAndValues) {
  for (const int bs : {1, 2, 3}) {
    const auto n = static_cast<std::size_t>(4 * bs);
    std::vector<double> eigenvalues(n), flags(n, 0.0), mass(n), x = random_vector(static_cast<int>(n), 6);
    for (std::size_t k = 0; k < n; ++k) {
      eigenvalues[k] = static_cast<double>(k) - 2.5;
      mass[k] = 0.5 + 0.1 * static_cast<double>(k);
      x[k] = std::abs(x[k]);
    }
    flags[n - 1] = 1;
    const auto a = testing::matrix_with(eigenvalues, 5);
    const Distributed d(bs, a, static_cast<int>(n));
    const auto local_flags = d.local(flags);
    const Rounding found = rounding_of(d.exchange, d.matrix, std::vector<char>(local_flags.begin(), local_flags.end()), d.local(mass), d.local(x));
    // A share of every entry is on every rank, and the squares of the shares are summed.
    const double share = 1 / std::sqrt(d.exchange.ranks());
    const std::vector<double> gradient = d.global(found.gradient);
    double norm = 0, energy = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double square = 0;
      for (std::size_t j = 0; j < n; ++j) square += a[i * n + j] * x[j] * a[i * n + j] * x[j];
      energy += 0.5 * epsilon * epsilon * std::abs(a[i * n + i]) * x[i] * x[i];
      const double expected = i + 1 < n ? share * epsilon * std::sqrt(square) : 0;
      norm += expected * expected / mass[i];
      EXPECT_NEAR(gradient[i], expected, 1e-14 * epsilon);
    }
    EXPECT_NEAR(found.gradient_norm, std::sqrt(norm), 1e-13 * epsilon);
    EXPECT_NEAR(found.energy, energy, 1e-13 * epsilon * epsilon);
  }
}

TEST(Rounding, OfTheGradientAlongAStepAndOfTheStrainsIsWhatADecreaseMustExceed) {
  // x = 3 at the end of a spring of stiffness 1e6, at an energy that is chosen.
  for (const double energy : {0.0, 2.0}) {
    OneUnknown p([=](double) { return Local{energy, 1, 1e6}; }, 3);
    System system(*p.functional, {}, default_tuning);
    Iterate x;
    x.u = p.u;
    ASSERT_TRUE(system.linearise(x, 0.0));
    const double force = epsilon * 1e6 * 3, strain = 0.5 * epsilon * epsilon * 1e6 * 9;
    for (const double length : {0.0, 1.0, 1e3}) {
      std::vector<double> s(static_cast<std::size_t>(p.layout->local_dofs()));
      for (std::size_t d = 0; d < s.size(); ++d) s[d] = system.fixed[d] ? 0 : length;
      const double expected = 10 * (4e-15 * energy + strain) + 2 * std::sqrt(force * length * force * length + 4 * energy * strain);
      EXPECT_NEAR(system.significant(x, s), expected, 1e-12 * expected) << energy << " " << length;
    }
  }
}

TEST(Rounding, ThatOverflowsIsNone) {
  const Distributed d(1, {1e300, 0, 0, 1}, 2);
  const std::vector<double> ones(2, 1.0);
  const Rounding found = rounding_of(d.exchange, d.matrix, std::vector<char>(2, 0), ones, d.local({1e200, 1}));
  EXPECT_EQ(found.gradient_norm, 0);
  EXPECT_EQ(found.energy, 0);
  EXPECT_EQ(found.gradient, std::vector<double>(2, 0.0));
}

TEST(Rounding, ValuesOfRnAreAsLargeAsTheirCoordinatesAndAllOthersOne) {
  SmallProblem p(1, manifold_by_name("R2"), {}, {3, -4, 0, 1e3}), q(1, manifold_by_name("S2"), {}, {1, 0, 0, 0, 1, 0});
  const std::vector<double> sizes = sizes_of(*p.layout, p.u);
  for (int node : p.layout->local_nodes(0)) {
    const auto first = static_cast<std::size_t>(p.layout->first_dof(0, node));
    const bool left = p.field.space->position(node)[0] < 0.5;
    EXPECT_EQ(sizes[first], left ? 3 : 0);
    EXPECT_EQ(sizes[first + 1], left ? 4 : 1e3);
  }
  for (double size : sizes_of(*q.layout, q.u)) EXPECT_EQ(size, 1);
}

}  // namespace
}  // namespace karcher
