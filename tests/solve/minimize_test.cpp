#include "karcher/solve/minimize.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "karcher/error.hpp"
#include "karcher/solve/continuation.hpp"
#include "karcher/solve/exchange.hpp"
#include "solve/cell_functions.hpp"
#include "solve/few_unknowns.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

using testing::CellFunction;
using testing::CellValue;
using testing::fixed_ends;
using testing::Local;
using testing::Local2;
using testing::OneUnknown;
using testing::rayleigh;
using testing::Recorder;
using testing::rosenbrock;
using testing::SmallProblem;
using testing::springs;
using testing::TwoUnknowns;

TEST(Minimize, FindsTheMinimumOfTheChainedRosenbrockFunction) {
  for (int max_corrections : {0, 20}) {
    SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
    SolverOptions options;
    options.max_corrections = max_corrections;
    options.gradient_tolerance = 1e-12;
    const StepReport report = minimize(*p.functional, p.u, options, {});
    complete(*p.layout, p.u);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(report.negative_eigenvalues, 0);
    // -1.2 everywhere lies in the basin of the global minimum or of the other local one near (-1, 1, 1, ...) (Kok and Sandrock 2009).
    EXPECT_NEAR(std::abs(p.value(0)), 1, 0.01);
    for (int i = 1; i <= 18; ++i) EXPECT_NEAR(p.value(i), 1, 2e-2);
    EXPECT_LT(report.energy, 3.99);
    EXPECT_LE(report.iterations, 60);
  }
}

TEST(Minimize, EnergyNeverRises) {
  SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
  Recorder recorder;
  Observer* observers[] = {&recorder};
  minimize(*p.functional, p.u, {}, observers);
  ASSERT_GT(recorder.records.size(), 5u);
  for (std::size_t i = 1; i < recorder.records.size(); ++i) EXPECT_LE(recorder.records[i].energy, recorder.records[i - 1].energy + 1e-12);
  EXPECT_LT(recorder.records.back().energy, 0.01 * recorder.records.front().energy);
}

TEST(Minimize, FindsTheLowestEigenvectorOnTheSphere) {
  std::vector<double> initial;
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.3 + i;
    for (double x : {std::sin(angle) * 0.6, std::cos(angle), std::sin(angle) * 0.8}) initial.push_back(x);
  }
  SmallProblem p(4, manifold_by_name("S2"), rayleigh, initial);
  SolverOptions options;
  options.gradient_tolerance = 1e-10;
  const StepReport report = minimize(*p.functional, p.u, options, {});
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(report.negative_eigenvalues, 0);
  EXPECT_NEAR(report.energy, 8 * 0.5 * 1, 1e-12);  // two nodes in each of four cells
}

std::vector<double> poles(int nodes, int axis) {
  std::vector<double> initial(static_cast<std::size_t>(3 * nodes), 0.0);
  for (int i = 0; i < nodes; ++i) initial[static_cast<std::size_t>(3 * i + axis)] = 1;
  return initial;
}

TEST(Minimize, ReportsASaddleWhereItStartsAtOne) {
  SmallProblem p(4, manifold_by_name("S2"), rayleigh, poles(5, 1));
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.negative_eigenvalues, 5);  // one for every node: the direction of the eigenvalue 1
  EXPECT_NE(report.reason.find("not a local minimum"), std::string::npos) << report.reason;
}

TEST(Minimize, EscapesFromASaddleWhenAsked) {
  for (int axis : {1, 2}) {
    SmallProblem p(4, manifold_by_name("S2"), rayleigh, poles(5, axis));
    SolverOptions options;
    options.escape = true;
    const StepReport report = minimize(*p.functional, p.u, options, {});
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(report.negative_eigenvalues, 0);
    EXPECT_NEAR(report.energy, 4, 1e-10);
  }
}

TEST(Minimize, LeavesFixedComponentsAlone) {
  std::vector<double> initial;
  for (int i = 0; i <= 10; ++i) initial.push_back(0.25 + 0.05 * i * i);
  SmallProblem q(10, manifold_by_name("R1"), springs, initial, fixed_ends(10));
  const StepReport report = minimize(*q.functional, q.u, {}, {});
  complete(*q.layout, q.u);
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(q.value(0), 0.25);
  EXPECT_EQ(q.value(10), 5.25);
  for (int i = 1; i < 10; ++i) EXPECT_NEAR(q.value(i), 0.25 + 0.5 * i, 1e-12);
  EXPECT_NEAR(report.energy, 10 * 0.5 * 0.25, 1e-12);
}

TEST(Minimize, TakesAnEnergyThatDoesNotSeeTranslations) {
  std::vector<double> initial;
  for (int i = 0; i <= 6; ++i) initial.push_back(0.2 * i * i - i);
  SmallProblem p(6, manifold_by_name("R1"), springs, initial);
  p.functional->set_load_parameter(1);
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  complete(*p.layout, p.u);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_EQ(report.negative_eigenvalues, 0);
  EXPECT_EQ(report.neutral_eigenvalues, 1);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(p.value(i + 1) - p.value(i), 1, 1e-7);
}

TEST(Minimize, LeavesASymmetricPathWhereItHasLostItsStability) {
  // 1/4 (x^2 - 1)^2 + 1/2 (y - 1)^2 at the two nodes of a cell. From x = 0, y = 0 the gradient never points along x, but x = 0 is a saddle.
  const CellFunction wells = [](const auto& u, const auto&, double, double* g, double* h) {
    const double x = *u[0], y = *u[1];
    if (g) {
      g[0] = x * (x * x - 1);
      g[1] = y - 1;
    }
    if (h) {
      h[0] = 3 * x * x - 1;
      h[3] = 1;
    }
    return CellValue{0.25 * (x * x - 1) * (x * x - 1) + 0.5 * (y - 1) * (y - 1)};
  };
  SmallProblem p(1, manifold_by_name("R1"), wells, {0, 0});
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(report.negative_eigenvalues, 0) << report.reason;
  EXPECT_NEAR(report.energy, 0, 1e-14);
}

TEST(Minimize, FailedEvaluationsShortenTheStepAndNameThePlace) {
  // From a = b the full step goes to b - a = t = 1.9, beyond the barrier at 1.8.
  std::vector<char> fixed{1, 0};
  SmallProblem probe(1, manifold_by_name("R1"), springs, {0, 0});
  if (probe.field.space->position(0)[0] > 0.5) std::swap(fixed[0], fixed[1]);
  SmallProblem p(1, manifold_by_name("R1"), springs, {0, 0}, fixed);
  p.functional->set_load_parameter(1.9);
  Recorder recorder;
  Observer* observers[] = {&recorder};
  SolverOptions options;
  options.initial_radius = 10;
  options.max_iterations = 30;
  const StepReport report = minimize(*p.functional, p.u, options, observers);
  EXPECT_EQ(report.status, Status::not_converged);
  ASSERT_FALSE(recorder.records.empty());
  EXPECT_FALSE(recorder.records[0].accepted);
  EXPECT_NE(recorder.records[0].note.find("test-term in the cell around (0.5, 0, 0)"), std::string::npos) << recorder.records[0].note;
  EXPECT_LT(recorder.records[1].radius, recorder.records[0].radius);
  complete(*p.layout, p.u);
  EXPECT_GT(p.value(1), 1.5);
  EXPECT_LE(p.value(1), 1.8);
}

TEST(Minimize, AnInfiniteEnergyAtTheStartIsAFailureThatSaysWhere) {
  SmallProblem p(3, manifold_by_name("R1"), springs, {0, 0, 3, 3});
  const Configuration before = p.u;
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_NE(report.reason.find("(1.5, 0, 0)"), std::string::npos) << report.reason;
  EXPECT_EQ(before.values, p.u.values);
}

TEST(Minimize, AnInfiniteGradientIsNoConvergence) {
  for (double slope : {1e155, 1e300}) {
    OneUnknown p([=](double x) { return Local{slope * x, slope, 1}; });
    const StepReport report = minimize(*p.functional, p.u, {}, {});
    EXPECT_EQ(report.status, Status::failed) << report.reason;
    EXPECT_NE(report.reason.find("at the node (1, 0, 0) of the field \"u\""), std::string::npos) << report.reason;
    EXPECT_EQ(report.negative_eigenvalues, -1);
    EXPECT_EQ(p.x(), 0);
  }
}

/// Twenty springs of length 0.1 and stiffness 1e6 in a row, one end held at `place`, the other pulled by `load`; they start at their lengths.
struct StiffSprings : SmallProblem {
  explicit StiffSprings(double place, double load) : SmallProblem(20, manifold_by_name("R1"), energy(load), row(place), held()) {}
  static CellFunction energy(double load) {
    return [load](const auto& u, const auto& x, double, double* g, double* h) {
      const double r = *u[1] - *u[0] - 0.1, force = x[0] > 18.5 ? load : 0.0;
      if (g) {
        g[0] = -1e6 * r;
        g[1] = 1e6 * r - force;
      }
      if (h) {
        h[0] = h[3] = 1e6;
        h[1] = h[2] = -1e6;
      }
      return CellValue{0.5e6 * r * r - force * *u[1]};
    };
  }
  static std::vector<double> row(double place) {
    std::vector<double> x;
    for (int i = 0; i <= 20; ++i) x.push_back(place + 0.1 * i);
    return x;
  }
  static std::vector<char> held() {
    const auto mesh = testing::line_mesh(20);
    const Space space(mesh, mesh->regions.at("all"), 1);
    std::vector<char> fixed;
    for (int node = 0; node <= 20; ++node) fixed.push_back(space.position(node)[0] < 0.5);
    return fixed;
  }
};

TEST(Minimize, AnEquilibriumAtTheStartIsConvergedWithoutAnIteration) {
  for (const double place : {0.0, -7.3, 1e3, 1e6}) {
    StiffSprings p(place, 0);
    const Configuration before = p.u;
    const StepReport report = minimize(*p.functional, p.u, {}, {});
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(report.negative_eigenvalues, 0);
    EXPECT_EQ(report.work.factorisations, 1);
    EXPECT_NE(report.reason.find("is rounding"), std::string::npos) << report.reason;
    EXPECT_EQ(before.values, p.u.values);
  }
}

TEST(Minimize, ASmallLoadMovesAStiffStructureAsFarAsItsGradientIsKnown) {
  for (const auto& [place, load] : {std::pair{0.0, 1e-7}, {0.0, 1e-3}, {1e3, 1e-3}}) {
    StiffSprings p(place, load);
    const StepReport report = minimize(*p.functional, p.u, {}, {});
    complete(*p.layout, p.u);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_LE(report.iterations, 2);
    EXPECT_NEAR(p.value(20), place + 2 + 20 * load / 1e6, 1e-15 * std::max(2.0, place)) << load;
  }
}

TEST(Minimize, ALoadThatIsNotAlongTheRoundingOfTheGradientIsNotTakenForRounding) {
  // a is held at 2 by a stiff spring whose force is wrong by rounding; b is pulled by a smaller force, which is exact.
  const double load = 1e-10, rounding = 3e-10;
  TwoUnknowns p([=](double a, double b) { return Local2{0.5e6 * (a - 2) * (a - 2) + 0.5 * b * b - load * b, rounding, b - load, 1e6, 0, 1}; }, 2, 0);
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_NE(report.reason.find("is rounding"), std::string::npos) << report.reason;
  EXPECT_EQ(report.iterations, 1);
  EXPECT_NEAR(p.b(), load, 1e-6 * load);
}

TEST(Minimize, ALoadStepWithoutLoadDoesNotEndALoadingThatSetsInLater) {
  CellFunction late = [](const auto& u, const auto& x, double t, double* g, double* h) {
    return StiffSprings::energy(std::max(0.0, t - 0.5))(u, x, t, g, h);
  };
  SmallProblem p(20, manifold_by_name("R1"), late, StiffSprings::row(0), StiffSprings::held());
  ContinuationOptions steps;
  steps.steps = 4;
  const ContinuationReport report = run_continuation(*p.functional, p.u, {}, steps, {}, {});
  complete(*p.layout, p.u);
  EXPECT_EQ(report.status, Status::converged);
  ASSERT_EQ(report.steps.size(), 4u);
  EXPECT_EQ(report.steps[1].iterations, 0);
  EXPECT_NEAR(p.value(20), 2 + 20 * 0.5 / 1e6, 1e-15);
}

TEST(Minimize, ALoadOnAMotionThatNothingHoldsIsToldAsAMissingSupport) {
  CellFunction pulled = [](const auto& u, const auto& x, double, double* g, double* h) {
    CellValue value = springs(u, x, 1, g, h);
    value.energy -= 0.5 * (*u[0] + *u[1]);
    if (g) g[0] -= 0.5, g[1] -= 0.5;
    return value;
  };
  SmallProblem p(6, manifold_by_name("R1"), pulled, {0, 1, 2, 3, 4, 5, 6});
  SolverOptions options;
  options.max_iterations = 10;
  const StepReport report = minimize(*p.functional, p.u, options, {});
  EXPECT_EQ(report.status, Status::not_converged);
  EXPECT_EQ(report.negative_eigenvalues, 0);
  EXPECT_EQ(report.neutral_eigenvalues, 1);
  EXPECT_NE(report.reason.find("works along a motion that nothing holds (1 eigenvalue is zero): a support is missing."), std::string::npos)
      << report.reason;
}

TEST(Minimize, AStepThatOverflowsOrVanishesInTheArithmeticIsNoConvergence) {
  const Local too_long{0, 1e153, 1e-153}, too_short{0, 1, 1e300};
  for (const Local& at : {too_long, too_short}) {
    OneUnknown p([=](double) { return at; });
    const StepReport report = minimize(*p.functional, p.u, {}, {});
    EXPECT_NE(report.status, Status::converged) << report.reason;
  }
  OneUnknown p([=](double) { return too_short; });
  const StepReport report = minimize(*p.functional, p.u, {}, {});
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_NE(report.reason.find("1 at the node (1, 0, 0) of the field \"u\""), std::string::npos) << report.reason;
}

TEST(Minimize, ARejectedStepLeavesTheBitsUnchanged) {
  SmallProblem p(1, manifold_by_name("R1"), springs, {0.1, 0.3});
  p.functional->set_load_parameter(1.9);
  const Configuration before = p.u;
  SolverOptions options;
  options.initial_radius = 100;
  options.max_iterations = 1;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  const StepReport report = minimize(*p.functional, p.u, options, observers);
  ASSERT_EQ(recorder.records.size(), 1u);
  EXPECT_FALSE(recorder.records[0].accepted);
  EXPECT_EQ(report.status, Status::not_converged);
  EXPECT_EQ(before.values, p.u.values);
}

TEST(Minimize, AfterARejectedStepGoesDownTheSlopeOfTheAcceptedPoint) {
  // Beyond 0.6 the energy is high and rises; the one correction that is allowed leads back to the start, and gains nothing. The next step is half as long.
  OneUnknown p([](double x) { return x < 0.6 ? Local{x * x - x, 2 * x - 1, 1} : Local{10, 5, 1}; });
  SolverOptions options;
  options.initial_radius = 10;
  options.max_corrections = 1;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  const StepReport report = minimize(*p.functional, p.u, options, observers);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  ASSERT_EQ(recorder.records.size(), 2u);
  EXPECT_FALSE(recorder.records[0].accepted);
  EXPECT_TRUE(recorder.records[1].accepted);
  EXPECT_NEAR(p.x(), 0.5, 1e-12);
}

std::vector<char> right_end_fixed(int cells) {
  std::vector<char> fixed = fixed_ends(cells);
  const auto mesh = testing::line_mesh(cells);
  const Space space(mesh, mesh->regions.at("all"), 1);
  for (int node = 0; node <= cells; ++node) fixed[static_cast<std::size_t>(node)] = space.position(node)[0] > cells - 0.5;
  return fixed;
}

/// Sum over cells, at x = 0, 1, ..., of 1/2 k (u - 1)^2 at the left end, k from 1 to 10^6; at the right end of the last one k = 1.
SmallProblem wells(int cells) {
  const CellFunction well = [cells](const auto& u, const auto& x, double, double* g, double* h) {
    const double a = *u[0] - 1, b = *u[1] - 1, k = std::pow(1e6, x[0] / cells), last = x[0] > cells - 1.5 ? 1 : 0;
    if (g) g[0] = k * a, g[1] = last * b;
    if (h) h[0] = k, h[3] = last;
    return CellValue{0.5 * k * a * a + 0.5 * last * b * b};
  };
  std::vector<double> start;
  for (int i = 0; i <= cells; ++i) start.push_back(std::sin(5.0 * i));
  return {cells, manifold_by_name("R1"), well, start};
}

TEST(Minimize, AStepThatTheRadiusDoesNotCutIsAsAccurateAsNewtonsWhateverTheShift) {
  // The first step is cut, so the second matrix is shifted.
  SmallProblem p = wells(30);
  SolverOptions options;
  options.initial_radius = 1e-3;
  options.max_corrections = 0;
  options.gradient_tolerance = 1e-12;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  minimize(*p.functional, p.u, options, observers);
  ASSERT_GE(recorder.records.size(), 2u);
  EXPECT_GT(recorder.records[0].shift, 0);
  EXPECT_EQ(recorder.records[1].shift, 0);
  EXPECT_LT(recorder.records[1].gradient_norm, 1e-5 * recorder.records[0].gradient_norm);
}

TEST(Minimize, AMatrixIsShiftedToWhereTheLastStepEndedSoThatOneFactorisationIsEnoughForAStep) {
  // The sum of 1/4 k (u^2 - 1)^2, k from 1 to 100, near u = 0: thirty directions of negative curvature, and a radius that cuts every step.
  const int cells = 30, steps = 10;
  const CellFunction double_well = [](const auto& u, const auto& x, double, double* g, double* h) {
    const double k = std::pow(1e2, x[0] / cells), a = *u[0], r = a * a - 1;
    if (g) g[0] = k * a * r;
    if (h) h[0] = k * (3 * a * a - 1);
    return CellValue{0.25 * k * r * r};
  };
  std::vector<double> start;
  for (int i = 0; i <= cells; ++i) start.push_back(0.1 * std::sin(5.0 * i + 1));
  SmallProblem p(cells, manifold_by_name("R1"), double_well, start, right_end_fixed(cells));
  SolverOptions options;
  options.initial_radius = 1e-5;
  options.max_corrections = 0;
  options.max_iterations = steps;
  SolverTuning tuning;
  tuning.exact = 0;  // asks for no signs of the matrix on the way
  Recorder recorder;
  Observer* observers[] = {&recorder};
  const StepReport report = Minimizer(*p.functional, options, tuning).run(p.u, {}, observers);
  ASSERT_EQ(recorder.records.size(), static_cast<std::size_t>(steps));
  for (const IterationRecord& r : recorder.records) {
    EXPECT_TRUE(r.accepted);
    EXPECT_GT(r.shift, 0);
  }
  // Not so the first step, of which nothing is known, and the signs at the end.
  EXPECT_LE(report.work.factorisations, steps + 5);
}

TEST(Minimize, TheFirstStepAfterAMoveOfTheBoundaryFromAnEquilibriumIsNoLongerThanTheMove) {
  const CellFunction stiffening = [](const auto& u, const auto& x, double, double* g, double* h) {
    const double r = *u[1] - *u[0], k = 100 * x[0];
    if (g) g[1] = r + k * r * r * r, g[0] = -g[1];
    if (h) h[0] = h[3] = 1 + 3 * k * r * r, h[1] = h[2] = -h[0];
    return CellValue{0.5 * r * r + 0.25 * k * r * r * r * r};
  };
  for (const double initial_radius : {0.0, 0.7}) {
    SmallProblem p(4, manifold_by_name("R1"), stiffening, std::vector<double>(5, 0.0), fixed_ends(4));
    Configuration boundary = p.u;
    for (int node = 0; node < 5; ++node)
      if (p.field.space->position(node)[0] > 3.5) boundary.values[0][static_cast<std::size_t>(node)] = 0.4;
    SolverOptions options;
    options.max_corrections = 0;
    options.initial_radius = initial_radius;
    Minimizer minimizer(*p.functional, options);
    Minimizer::Task task;
    task.boundary = &boundary;
    Recorder recorder;
    Observer* observers[] = {&recorder};
    minimizer.run(p.u, task, observers);
    ASSERT_FALSE(recorder.records.empty());
    // Lengths are counted in halves of the diagonal 4; a radius that is asked for is taken.
    EXPECT_NEAR(recorder.records[0].radius, initial_radius > 0 ? initial_radius : 0.2, 1e-14);
  }
}

TEST(Minimize, TheWorkOfARunIsThatOfThisRunAlone) {
  SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
  Minimizer minimizer(*p.functional, {});
  const StepReport first = minimizer.run(p.u, {}, {});
  EXPECT_GT(first.work.gradients, 5);
  // From where the first run ended there is nothing to do but to see that.
  const StepReport second = minimizer.run(p.u, {}, {});
  EXPECT_EQ(second.iterations, 0);
  EXPECT_EQ(second.work.gradients, 1);
  EXPECT_LE(second.work.factorisations, 1);
}

TEST(Minimize, GivesTheSameBitsTwice) {
  // On several ranks MUMPS adds contributions in the order in which they arrive: there, the same to rounding.
  const double tolerance = world_size() == 1 ? 0 : 1e-9;
  std::vector<double> first;
  for (int run = 0; run < 2; ++run) {
    SmallProblem p(30, manifold_by_name("R1"), rosenbrock, std::vector<double>(31, -1.2));
    minimize(*p.functional, p.u, {}, {});
    if (run == 0) first = p.u.values[0];
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_LE(std::abs(first[i] - p.u.values[0][i]), tolerance);
  }
}

TEST(Minimize, BoundaryDataThatDifferByRoundingDoNotShortenTheFirstStep) {
  std::vector<char> fixed(31, 0);
  fixed[0] = 1;
  SmallProblem p(30, manifold_by_name("R1"), rosenbrock, std::vector<double>(31, 0.9), fixed);
  Configuration boundary = p.u;
  for (double& x : boundary.values[0]) x = std::nextafter(x, 1.0);
  Minimizer minimizer(*p.functional, {});
  Minimizer::Task task;
  task.boundary = &boundary;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  const StepReport report = minimizer.run(p.u, task, observers);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_EQ(recorder.records.front().radius, 1);
  EXPECT_LT(report.gradient_norm, 1e-4);
}

TEST(Minimize, AVeryShortInitialRadiusIsNoConvergence) {
  for (double radius : {1e-15, 1e-9}) {
    SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
    SolverOptions options;
    options.initial_radius = radius;
    const StepReport report = minimize(*p.functional, p.u, options, {});
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_LT(report.energy, 3.99) << radius;
  }
}

TEST(Minimize, ReportsReadAsOneSentence) {
  StepReport report;
  report.status = Status::converged;
  report.iterations = 1;
  report.energy = 6.963591204935;
  report.reason = "Nothing is left to do.";
  std::ostringstream text;
  text << report;
  EXPECT_EQ(text.str(), "energy 6.963591204935, converged after 1 iteration: Nothing is left to do.");
}

TEST(SolverOptions, RefuseWhatTheSolverDoesNotHave) {
  SolverOptions options;
  EXPECT_TRUE(options.validate().empty());
  options.method = "mixed-newton";
  options.subproblem = "monotone-multigrid";
  options.norm = "max";
  options.max_iterations = -1;
  EXPECT_EQ(options.validate().size(), 4u);
  SmallProblem p(2, manifold_by_name("R1"), springs, {0, 0, 0});
  EXPECT_THROW(minimize(*p.functional, p.u, options, {}), InputError);
}

TEST(GradientFlow, TakesImplicitEulerStepsOfTheHeatEquation) {
  // One free node between two fixed ones: u' = -2 u / m with lumped mass m = 1, so u_k = u_0 / (1 + 2 tau)^k.
  CellFunction no_rest_length = [](const auto& u, const auto& x, double, double* g, double* h) { return springs(u, x, 0, g, h); };
  SmallProblem p(2, manifold_by_name("R1"), no_rest_length, {0, 1, 0}, fixed_ends(2));
  SolverOptions options;
  options.method = "gradient-flow";
  options.gradient_tolerance = 1e-12;
  ContinuationOptions times;
  times.to = 0.5;
  times.steps = 5;
  const ContinuationReport report = run_continuation(*p.functional, p.u, {}, times, options, {});
  complete(*p.layout, p.u);
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_NEAR(p.value(1), std::pow(1.2, -5), 1e-12);
}

TEST(GradientFlow, TurnsOnTheSphereAtTheSpeedOfItsGradient) {
  // Each node obeys theta' = -dE/dtheta / m. In the plane of e1 and e2 at angle theta from e1: E = 1/2 (1 + sin^2 theta) per cell and node.
  const double theta = 0.6;
  std::vector<double> initial;
  for (int i = 0; i < 2; ++i)
    for (double x : {std::cos(theta), std::sin(theta), 0.0}) initial.push_back(x);
  SmallProblem p(1, manifold_by_name("S2"), rayleigh, initial);
  SolverOptions options;
  options.method = "gradient-flow";
  options.gradient_tolerance = 1e-12;
  ContinuationOptions times;
  times.to = 0.1;
  times.steps = 1;
  run_continuation(*p.functional, p.u, {}, times, options, {});
  complete(*p.layout, p.u);
  const double found = std::atan2(p.value(0, 1), p.value(0, 0));
  // implicit Euler with lumped mass 1/2: (found - theta) / tau = -2 sin(found) cos(found)
  EXPECT_NEAR((found - theta) / 0.1, -2 * std::sin(found) * std::cos(found), 1e-9);
}

}  // namespace
}  // namespace karcher
