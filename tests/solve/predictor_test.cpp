#include "solve/predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solve/cell_functions.hpp"

namespace karcher {
namespace {

using testing::CellFunction;
using testing::CellValue;
using testing::fixed_ends;
using testing::SmallProblem;
using testing::springs;

/// A chain of springs on [0, cells], fixed at both ends, all values `start`.
struct Chain : SmallProblem {
  explicit Chain(int cells, CellFunction f = springs, double start = 0)
      : SmallProblem(cells, manifold_by_name("R1"), std::move(f), std::vector<double>(static_cast<std::size_t>(cells) + 1, start),
                     fixed_ends(cells)) {}
  Configuration with_end_at(double x) const {
    Configuration boundary = u;
    for (int node = 0; node < field.space->node_count(); ++node)
      if (field.space->position(node)[0] > static_cast<double>(field.space->node_count()) - 1.5)
        boundary.values[0][static_cast<std::size_t>(node)] = x;
    return boundary;
  }
  void move_middle(double to) {
    for (int node = 0; node < field.space->node_count(); ++node)
      if (std::abs(field.space->position(node)[0] - 2) < 0.5) u.values[0][static_cast<std::size_t>(node)] = to;
  }
  /// Value at x = i of a configuration.
  double at(const Configuration& c, int i) {
    u.values = c.values;
    complete(*layout, u);
    return value(i);
  }
};

TEST(Predictor, SolvesTheLinearProblemOfAMovedBoundary) {
  Chain p(4);
  System system(*p.functional, {}, default_tuning);
  const std::optional<Prediction> found = predict(system, p.u, p.with_end_at(3), 1e-12);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x.energy, 4 * 0.5 * 0.75 * 0.75, 1e-13);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(p.at(found->x.u, i), 0.75 * i, 1e-13);
  EXPECT_EQ(p.at(found->x.u, 4), 3);
  EXPECT_EQ(system.work.factorisations, 1);
}

TEST(Predictor, AllowsStepsAsLongAsTheBoundaryGoesWhereItDisturbsAnEquilibrium) {
  Chain p(4);
  System system(*p.functional, {}, default_tuning);
  // The whole field moved by 3: the masses sum to 1 / length^2, and the length is half of 4.
  EXPECT_NEAR(predict(system, p.u, p.with_end_at(3), 1e-12)->radius, 3.0 / 2, 1e-14);
  // Where there are forces inside, it says nothing.
  Chain q(4);
  q.move_middle(0.3);
  System tense(*q.functional, {}, default_tuning);
  EXPECT_EQ(predict(tense, q.u, q.with_end_at(0.01), 1e-12)->radius, INFINITY);
}

TEST(Predictor, TakesRoundingForNoMove) {
  Chain p(4, springs, 0.9);
  System system(*p.functional, {}, default_tuning);
  const Configuration boundary = p.with_end_at(std::nextafter(0.9, 1.0));
  EXPECT_FALSE(predict(system, p.u, boundary, 1e-12));
  EXPECT_EQ(system.work.hessians, 0);
  EXPECT_EQ(p.at(p.u, 4), std::nextafter(0.9, 1.0));
  EXPECT_EQ(p.at(p.u, 3), 0.9);
  EXPECT_TRUE(predict(system, p.u, p.with_end_at(0.9 + 1e-12), 1e-12));
}

TEST(Predictor, TakesThePartOfTheLinearSolutionThatHasTheLeastEnergy) {
  // Of two springs the Hessian claims a seventh of the stiffness at the free node: the linear solution goes seven times too far, and is cut at the reach.
  const CellFunction soft = [](const auto& u, const auto& x, double t, double* g, double* h) {
    const CellValue v = springs(u, x, t, g, h);
    if (h) (x[0] < 0.5 ? h[3] : h[0]) /= 7;
    return v;
  };
  Chain p(2, soft);
  SolverOptions options;
  options.max_corrections = 0;
  System system(*p.functional, options, default_tuning);
  const std::optional<Prediction> found = predict(system, p.u, p.with_end_at(1.6), 1e-12);
  ASSERT_TRUE(found);
  // The free node has half of the mass 1. Best were 0.8; the reach is 2.26, a quarter of it 0.57, a sixteenth 0.14.
  EXPECT_NEAR(p.at(found->x.u, 1), 0.25 * 1.6 / std::sqrt(0.5), 1e-13);
}

TEST(Predictor, LeavesTheInsideWhereTheLinearSolutionIsWorse) {
  // The coupling of the cell's nodes has the wrong sign: the linear solution goes the wrong way.
  const CellFunction wrong = [](const auto& u, const auto& x, double t, double* g, double* h) {
    const CellValue v = springs(u, x, t, g, h);
    if (h) h[1] = h[2] = 1;
    return v;
  };
  Chain p(2, wrong);
  SolverOptions options;
  options.max_corrections = 0;
  System system(*p.functional, options, default_tuning);
  const std::optional<Prediction> found = predict(system, p.u, p.with_end_at(1.6), 1e-12);
  ASSERT_TRUE(found);
  EXPECT_EQ(p.at(found->x.u, 1), 0);
  EXPECT_EQ(p.at(found->x.u, 2), 1.6);
}

TEST(Predictor, AddsTheForcesThatAreThereAlready) {
  // A chain out of balance, without corrections: one linear step finds the even lengths.
  Chain p(4);
  p.functional->set_load_parameter(0.5);
  SolverOptions options;
  options.max_corrections = 0;
  System system(*p.functional, options, default_tuning);
  p.move_middle(0.3);
  const std::optional<Prediction> found = predict(system, p.u, p.with_end_at(1), 1e-12);
  ASSERT_TRUE(found);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(p.at(found->x.u, i), 0.25 * i, 1e-13);
}

}  // namespace
}  // namespace karcher
