// What every option of the solver does, by the trace of a run: the same run with another threshold ends where the trace says.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "karcher/error.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/minimize.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/cell_functions.hpp"
#include "solve/few_unknowns.hpp"
#include "solve/subproblems.hpp"

namespace karcher {
namespace {

using testing::OneUnknown;
using testing::Recorder;
using testing::rosenbrock;
using testing::SmallProblem;

struct Trace {
  std::vector<IterationRecord> records;
  StepReport report;
};

/// The chained Rosenbrock function from (-1.2, ..., -1.2) without corrections, so that thresholds change nothing but the end.
Trace trace_of(SolverOptions options) {
  SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
  options.max_corrections = 0;
  Recorder recorder;
  Observer* observers[] = {&recorder};
  Trace t;
  t.report = minimize(*p.functional, p.u, options, observers);
  t.records = recorder.records;
  return t;
}
SolverOptions tight() {
  SolverOptions options;
  options.gradient_tolerance = 1e-13;
  return options;
}
const Trace& full() {
  static const Trace trace = trace_of(tight());
  return trace;
}

/// |g|_* at the start: cells give -400 a r - 2 (1 - a) and 200 r with r = b - a^2.
double gradient_at_start() {
  const double a = -1.2, r = a - a * a, first = -400 * a * r - 2 * (1 - a), second = 200 * r;
  const double mass = 1.0 / 20 / (10.0 * 10.0);  // of an inner node: of 20 cells, lengths in halves of 20
  return std::sqrt((first * first + second * second) / (0.5 * mass) + 19 * (first + second) * (first + second) / mass);
}

TEST(SolverOptions, TheTracesFallBelowEveryThresholdOnce) {
  const auto& records = full().records;
  ASSERT_GT(records.size(), 8u);
  EXPECT_EQ(full().report.status, Status::converged);
  EXPECT_LT(records.back().gradient_norm, 1e-13 * gradient_at_start());
}

/// The first iteration after which |g|_* is at most `threshold`.
int first_at_most(double threshold) {
  for (const IterationRecord& r : full().records)
    if (r.gradient_norm <= threshold) return r.iteration;
  return -1;
}

/// Thresholds a little above and below what some iterations reach.
std::vector<double> thresholds() {
  std::vector<double> result;
  for (std::size_t k = full().records.size() - 4; k + 1 < full().records.size(); ++k)
    for (const double factor : {0.99, 1.01}) result.push_back(factor * full().records[k].gradient_norm);
  return result;
}

TEST(SolverOptions, GradientToleranceIsRelativeToTheGradientAtTheStart) {
  for (const double threshold : thresholds()) {
    SolverOptions options = tight();
    options.gradient_tolerance = threshold / gradient_at_start();
    const StepReport report = trace_of(options).report;
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_EQ(report.iterations, first_at_most(threshold));
    EXPECT_LE(report.gradient_norm, threshold);
  }
}

TEST(SolverOptions, AbsoluteGradientToleranceIsAThresholdOfTheGradientItself) {
  for (const double threshold : thresholds()) {
    SolverOptions options = tight();
    options.absolute_gradient_tolerance = threshold;
    const StepReport report = trace_of(options).report;
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_EQ(report.iterations, first_at_most(threshold));
  }
}

TEST(SolverOptions, StepToleranceEndsAfterAnAcceptedNewtonStepThatIsNoLonger) {
  const auto& records = full().records;
  int tried = 0;
  for (std::size_t k = records.size() - 4; k < records.size(); ++k) {
    ASSERT_EQ(records[k].shift, 0);
    for (const double factor : {0.99, 1.01}) {
      SolverOptions options = tight();
      options.step_tolerance = factor * records[k].step_norm;
      int expected = static_cast<int>(records.size());
      bool by_step = false;
      for (const IterationRecord& r : records)
        if (r.accepted && r.shift == 0 && r.step_norm <= options.step_tolerance) {
          expected = r.iteration;
          by_step = true;
          break;
        }
      const StepReport report = trace_of(options).report;
      EXPECT_EQ(report.iterations, expected);
      EXPECT_EQ(report.reason.find("The Newton step") == 0, by_step) << report.reason;
      ++tried;
    }
  }
  EXPECT_EQ(tried, 8);
}

TEST(SolverOptions, StepToleranceDoesNotTakeAStepThatTheRadiusCutForTheEnd) {
  SolverOptions options = tight();
  options.initial_radius = 1e-3;
  options.step_tolerance = 1e-2;
  const Trace t = trace_of(options);
  EXPECT_LE(t.records.front().step_norm, 1e-3 * (1 + 1e-12));
  EXPECT_GT(t.records.front().shift, 0);
  EXPECT_GT(t.report.iterations, 5);
  EXPECT_EQ(t.records.back().shift, 0);
}

TEST(SolverOptions, MaxIterationsCountsTrialStepsRejectedOnesIncluded) {
  int rejected = 0;
  for (const IterationRecord& r : full().records) rejected += !r.accepted;
  for (const int most : {0, 1, 5}) {
    SolverOptions options = tight();
    options.max_iterations = most;
    const Trace t = trace_of(options);
    EXPECT_EQ(t.report.status, Status::not_converged);
    EXPECT_EQ(t.report.iterations, most);
    EXPECT_EQ(t.records.size(), static_cast<std::size_t>(most));
    EXPECT_EQ(t.report.reason.find("After " + std::to_string(most) + " iterations"), 0u) << t.report.reason;
    EXPECT_GE(t.report.negative_eigenvalues, 0);  // judged all the same
  }
}

TEST(SolverOptions, InitialRadiusIsThatOfTheFirstStepAndOneWhereItIsChosen) {
  EXPECT_EQ(full().records.front().radius, 1);
  SolverOptions options = tight();
  options.initial_radius = 0.125;
  options.max_iterations = 2;
  const Trace t = trace_of(options);
  EXPECT_EQ(t.records.front().radius, 0.125);
  for (const IterationRecord& r : t.records) EXPECT_LE(r.step_norm, r.radius * (1 + 1e-12));
}

TEST(SolverOptions, MaxCorrectionsBoundsTheGradientsBetweenIterations) {
  // One gradient at the start and one at each trial point, one for each correction that is taken. (Hessians come with theirs.)
  const StepReport none = full().report;
  EXPECT_EQ(none.work.gradients, 1 + none.iterations);
  for (const int most : {1, 4}) {
    SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
    SolverOptions options;
    options.max_corrections = most;
    const StepReport report = minimize(*p.functional, p.u, options, {});
    EXPECT_GT(report.work.gradients, 1 + report.iterations);
    EXPECT_LE(report.work.gradients, 1 + (1 + most) * report.iterations);
  }
}

TEST(SolverOptions, WithoutEscapeASaddleIsTheEnd) {
  // x^4 / 4 - x^2 / 2 from its top
  for (const bool escape : {false, true}) {
    OneUnknown p([](double x) { return testing::Local{0.25 * x * x * x * x - 0.5 * x * x, x * x * x - x, 3 * x * x - 1}; });
    SolverOptions options;
    options.escape = escape;
    const StepReport report = minimize(*p.functional, p.u, options, {});
    EXPECT_EQ(report.negative_eigenvalues, escape ? 0 : 1);
    EXPECT_NEAR(std::abs(p.x()), escape ? 1 : 0, 1e-7);
  }
}

TEST(SolverOptions, NameWhatTheSolverHas) {
  SolverOptions options;
  options.subproblem = "none";
  ASSERT_EQ(options.validate().size(), 1u);
  std::string names;
  for (const SubproblemKind& kind : subproblems()) names += (names.empty() ? "\"" : ", \"") + std::string(kind.name) + "\"";
  EXPECT_EQ(options.validate()[0], "The solver has no subproblem \"none\"; it has " + names + ".");
  options = {};
  options.method = "newton";
  EXPECT_EQ(options.validate()[0], "The solver has no method \"newton\"; it has \"trust-region\", \"gradient-flow\".");
}

TEST(SolverOptions, RefuseNumbersOutOfRange) {
  const auto wrong = [](auto set) {
    SolverOptions options;
    set(options);
    return options.validate().size();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double x : {-1e-9, 1.0, nan}) EXPECT_EQ(wrong([&](SolverOptions& o) { o.gradient_tolerance = x; }), 1u) << x;
  for (const double x : {0.0, 0.5}) EXPECT_EQ(wrong([&](SolverOptions& o) { o.gradient_tolerance = x; }), 0u) << x;
  for (const double x : {-1.0, nan}) {
    EXPECT_EQ(wrong([&](SolverOptions& o) { o.absolute_gradient_tolerance = x; }), 1u);
    EXPECT_EQ(wrong([&](SolverOptions& o) { o.step_tolerance = x; }), 1u);
  }
  for (const double x : {-1.0, nan, infinity}) EXPECT_EQ(wrong([&](SolverOptions& o) { o.initial_radius = x; }), 1u);
  EXPECT_EQ(wrong([](SolverOptions& o) { o.max_iterations = -1; }), 1u);
  EXPECT_EQ(wrong([](SolverOptions& o) { o.max_corrections = -1; }), 1u);
  EXPECT_EQ(wrong([](SolverOptions& o) { o.max_iterations = o.max_corrections = 0; }), 0u);
}

TEST(Minimizer, RemembersTheLargestGradientAtTheStartOfALoadStep) {
  // 1/2 x^2: |g|_* is |x| / sqrt(M).
  const auto parabola = [](double x) { return testing::Local{0.5 * x * x, x, 1}; };
  SolverOptions options;
  options.gradient_tolerance = 1e-3;
  const auto at = [&](double x) { return OneUnknown(parabola, x).u; };
  OneUnknown p(parabola);
  Minimizer minimizer(*p.functional, options);
  Configuration u = at(1);
  EXPECT_EQ(minimizer.run(u, {}).iterations, 1);
  u = at(0.9e-3);
  EXPECT_EQ(minimizer.run(u, {}).iterations, 0);
  u = at(1.1e-3);
  EXPECT_EQ(minimizer.run(u, {}).iterations, 1);
  // A task may have a tolerance of its own.
  Minimizer::Task task;
  task.gradient_tolerance = 0.5;
  u = at(0.4);
  EXPECT_EQ(minimizer.run(u, task).iterations, 0);
  u = at(0.6);
  EXPECT_EQ(minimizer.run(u, task).iterations, 1);
  // Another minimizer has seen nothing yet.
  Minimizer fresh(*p.functional, options);
  u = at(0.9e-3);
  EXPECT_EQ(fresh.run(u, {}).iterations, 1);
}

TEST(Minimizer, EveryRunBeginsWithTheInitialRadius) {
  const auto far = [](double x) { return testing::Local{std::sqrt(1 + x * x), x / std::sqrt(1 + x * x), std::pow(1 + x * x, -1.5)}; };
  SolverOptions options;
  options.initial_radius = 0.25;
  options.max_corrections = 0;
  OneUnknown p(far, 10);
  Minimizer minimizer(*p.functional, options);
  for (int run = 0; run < 2; ++run) {
    Configuration u = OneUnknown(far, 10).u;
    Recorder recorder;
    Observer* observers[] = {&recorder};
    minimizer.run(u, {}, observers);
    ASSERT_GT(recorder.records.size(), 2u);
    EXPECT_EQ(recorder.records[0].radius, 0.25);
    EXPECT_EQ(recorder.records[1].radius, 0.5);
  }
}

TEST(Minimizer, EndsOnAllRanksWhenOneIsInterrupted) {
  for (int interrupted = 0; interrupted < world_size(); ++interrupted) {
    SmallProblem p(20, manifold_by_name("R1"), rosenbrock, std::vector<double>(21, -1.2));
    interrupt_requested = world_rank() == interrupted;
    const StepReport report = minimize(*p.functional, p.u, {}, {});
    interrupt_requested = false;
    EXPECT_EQ(report.status, Status::interrupted);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(report.reason.find("Interrupted; the gradient norm is"), 0u) << report.reason;
  }
}

}  // namespace
}  // namespace karcher
