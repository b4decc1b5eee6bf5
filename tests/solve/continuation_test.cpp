#include "karcher/solve/continuation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/error.hpp"
#include "karcher/solve/exchange.hpp"
#include "solve/cell_functions.hpp"
#include "solve/few_unknowns.hpp"

namespace karcher {
namespace {

using testing::CellFunction;
using testing::CellValue;
using testing::fixed_ends;
using testing::Recorder;
using testing::SmallProblem;
using testing::springs;

/// Ends of a chain of springs pulled apart to 3 t.
struct Pull {
  SmallProblem p;
  int last = 0;
  explicit Pull(int cells, CellFunction f = springs)
      : p(cells, manifold_by_name("R1"), std::move(f), std::vector<double>(static_cast<std::size_t>(cells) + 1, 0.0), fixed_ends(cells)) {
    for (int node = 0; node <= cells; ++node)
      if (p.field.space->position(node)[0] > cells - 0.5) last = node;
  }
  BoundaryValues boundary(double scale) const {
    return [this, scale](double t, Configuration& u) { u.values[0][static_cast<std::size_t>(last)] = scale * t; };
  }
};

TEST(Continuation, PrescribedDisplacementsAreSpreadBeforeTheFirstEvaluation) {
  // Pulled by 3 in one go, the last spring alone would be longer than 1.8 (infinite energy); spread over four springs it is 0.75.
  Pull pull(4);
  Recorder recorder;
  Observer* observers[] = {&recorder};
  const auto report = run_continuation(*pull.p.functional, pull.p.u, pull.boundary(3), {}, {}, observers);
  complete(*pull.p.layout, pull.p.u);
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(pull.p.value(4), 3);
  EXPECT_NEAR(pull.p.value(1), 0.75, 1e-12);
  ASSERT_EQ(recorder.steps.size(), 1u);
  EXPECT_LE(recorder.steps[0].work.factorisations, 2);
}

TEST(Continuation, VisitsTheLoadStepsInOrder) {
  Pull pull(4);
  Recorder recorder;
  Observer* observers[] = {&recorder};
  ContinuationOptions options;
  options.from = 1;
  options.to = 2;
  options.steps = 4;
  const auto report = run_continuation(*pull.p.functional, pull.p.u, pull.boundary(1), options, {}, observers);
  EXPECT_EQ(report.steps.size(), 4u);
  EXPECT_EQ(recorder.begun, (std::vector<double>{1.25, 1.5, 1.75, 2}));
  ASSERT_EQ(recorder.steps.size(), 4u);
  // springs of rest length t, four of them between 0 and t
  for (const StepReport& s : recorder.steps) EXPECT_NEAR(s.energy, 4 * 0.5 * std::pow(0.75 * s.t, 2), 1e-12);
  EXPECT_EQ(recorder.steps[3].load_step, 4);
}

TEST(Continuation, FailureEndsItAtTheLastConvergedConfiguration) {
  Pull pull(1);  // the one spring breaks at length 1.8
  ContinuationOptions options;
  options.steps = 4;
  const auto report = run_continuation(*pull.p.functional, pull.p.u, pull.boundary(2.8), options, {}, {});
  complete(*pull.p.layout, pull.p.u);
  EXPECT_EQ(report.status, Status::failed);
  ASSERT_EQ(report.steps.size(), 3u);
  EXPECT_NEAR(pull.p.value(1), 1.4, 1e-12);
}

TEST(Continuation, AdaptiveStepsAreHalvedAfterAFailureAndDoubledAfterAnEasyOne) {
  // Same spring: it breaks at t = 1.8 / 2.8 = 0.643. Every step converges at once or fails.
  Pull pull(1);
  Recorder recorder;
  Observer* observers[] = {&recorder};
  ContinuationOptions options;
  options.adaptive = true;
  options.smallest = 1.0 / 64;
  const auto report = run_continuation(*pull.p.functional, pull.p.u, pull.boundary(2.8), options, {}, observers);
  complete(*pull.p.layout, pull.p.u);
  // From 1/2 on: 1 and 1 again (a step of 1, cut at the end, then of 1/2), 3/4, 5/8; from there 7/8, 3/4, 11/16, 21/32 and 41/64. Doubled, 43/64 is too far, and
  // so is 42/64; a 64th can be halved no more.
  EXPECT_EQ(recorder.begun, (std::vector<double>{1, 0.5, 1, 1, 0.75, 0.625, 0.875, 0.75, 0.6875, 0.65625, 0.640625, 0.671875, 0.65625}));
  EXPECT_EQ(report.status, Status::failed);
  ASSERT_EQ(report.steps.size(), 4u);  // three that converged, and the last one; those tried again are not listed
  EXPECT_EQ(report.steps[0].t, 0.5);
  EXPECT_EQ(report.steps[1].t, 0.625);
  EXPECT_EQ(report.steps[2].t, 0.640625);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(report.steps[k].status, Status::converged);
  EXPECT_NEAR(pull.p.value(1), 2.8 * 0.640625, 1e-12);
}

/// Nearly the parabola of one unknown with its minimum at x = distance * t (for the parabola itself the radius would not matter), and iterations whose steps double
/// from a length of 1 on: n of them reach 2^n - 1, and one more ends it.
struct Far : testing::OneUnknown {
  explicit Far(double distance) : OneUnknown([](double) { return testing::Local{}; }) {
    const CellFunction f = [=](const auto& nodes, const auto&, double t, double* g, double* h) {
      const double r = *nodes[1] - distance * t;
      if (g) g[1] = r + 1e-3 * std::sin(r);
      if (h) h[3] = 1 + 1e-3 * std::cos(r);
      return CellValue{0.5 * r * r - 1e-3 * std::cos(r)};
    };
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(std::make_unique<testing::CellTerm>("far", field, *layout, f));
    functional = std::make_unique<Functional>(layout, std::move(terms));
  }
  std::vector<double> begun(int max_iterations) {
    SolverOptions solver;
    solver.initial_radius = testing::unit;
    solver.max_corrections = 0;
    solver.max_iterations = max_iterations;
    Recorder recorder;
    Observer* observers[] = {&recorder};
    ContinuationOptions options;
    options.adaptive = true;
    EXPECT_EQ(run_continuation(*functional, u, {}, options, solver, observers).status, Status::converged);
    return recorder.begun;
  }
};

TEST(Continuation, AdaptiveStepsThatTakeMoreThanFiveIterationsAreNotFollowedByALongerOne) {
  // 100 takes 8 iterations, 50 takes 7, 25 takes 6, 12.5 takes 5.
  EXPECT_EQ(Far(100).begun(8), (std::vector<double>{1}));
  EXPECT_EQ(Far(100).begun(6), (std::vector<double>{1, 0.5, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(Far(50).begun(5), (std::vector<double>{1, 0.5, 0.25, 0.75, 0.5, 1, 0.75, 1}));
}

TEST(Continuation, ARestOfTheRangeThatIsTooShortIsTakenAlong) {
  // Ten steps of a tenth do not add up in floating point: those of the first range fall short of its end, those of the second go beyond it.
  for (const auto& [from, to] : {std::pair{0.0, 1.0}, {0.25, 0.75}}) {
    Pull pull(4);
    Recorder recorder;
    Observer* observers[] = {&recorder};
    ContinuationOptions options;
    options.adaptive = true;
    options.steps = 10;
    options.from = from;
    options.to = to;
    EXPECT_EQ(run_continuation(*pull.p.functional, pull.p.u, pull.boundary(1), options, {}, observers).status, Status::converged);
    ASSERT_EQ(recorder.begun.size(), 10u);
    EXPECT_EQ(recorder.begun.back(), to);
  }
}

TEST(Continuation, GoesOnWhereItWasBrokenOffWithTheLengthThatAdaptiveStepsHad) {
  struct Keeper : Recorder {
    std::vector<Configuration> states;
    void load_step_finished(const StepReport& report, const Configuration& u) override {
      Recorder::load_step_finished(report, u);
      states.push_back(u);
    }
  };
  // The one spring breaks around t = 1/4 and 1/2, so that adaptive steps, of 1/2 at most, end at 1/8, 3/8 (twice the first), 7/8 and 1.
  const auto boundary = [](const Pull& pull) {
    return [&pull](double t, Configuration& u) {
      const bool breaks = std::abs(t - 0.25) < 0.05 || std::abs(t - 0.5) < 0.05;
      u.values[0][static_cast<std::size_t>(pull.last)] = breaks ? 2.8 : 1.5 * t;
    };
  };
  ContinuationOptions fixed, adaptive;
  fixed.steps = 3;
  fixed.from = 0.1;
  adaptive.steps = 2;
  adaptive.adaptive = true;
  for (const ContinuationOptions& options : {fixed, adaptive}) {
    Pull pull(1);
    Keeper whole;
    Observer* const keeper = &whole;
    ASSERT_EQ(run_continuation(*pull.p.functional, pull.p.u, boundary(pull), options, {}, {&keeper, 1}).status, Status::converged);
    ASSERT_EQ(whole.steps.size(), options.adaptive ? 4U : 3U);
    EXPECT_EQ(whole.steps[1].t, options.adaptive ? 0.375 : 0.1 + 2.0 / 3 * 0.9);
    for (std::size_t k = 1; k < whole.steps.size(); ++k) {
      const StepReport& last = whole.steps[k - 1];
      Pull rest(1);
      rest.p.u = whole.states[k - 1];
      const ContinuationStart start{static_cast<int>(k), last.t, last.next_increment, last.largest_gradient};
      const auto report = run_continuation(*rest.p.functional, rest.p.u, boundary(rest), options, {}, {}, start);
      ASSERT_EQ(report.steps.size(), whole.steps.size() - k);
      for (std::size_t j = k; j < whole.steps.size(); ++j) {
        const StepReport &resumed = report.steps[j - k], &uninterrupted = whole.steps[j];
        EXPECT_EQ(resumed.load_step, static_cast<int>(j) + 1);
        EXPECT_EQ(resumed.t, uninterrupted.t);
        EXPECT_EQ(resumed.energy, uninterrupted.energy);
        EXPECT_EQ(resumed.largest_gradient, uninterrupted.largest_gradient);
        EXPECT_EQ(resumed.iterations, uninterrupted.iterations);
      }
    }
    EXPECT_EQ(whole.steps.back().next_increment, 0);
  }
}

TEST(Continuation, GoesOnToOtherLoadsOnlyIfTheyLieAhead) {
  const auto begun = [](const ContinuationOptions& options, const ContinuationStart& start) {
    Pull pull(1);
    Recorder recorder;
    Observer* const observer = &recorder;
    run_continuation(*pull.p.functional, pull.p.u, pull.boundary(1), options, {}, {&observer, 1}, start);
    EXPECT_EQ(last_load_step(options, start), start.load_step + static_cast<int>(recorder.begun.size()));
    return recorder.begun;
  };
  ContinuationOptions options;
  options.steps = 4;
  EXPECT_EQ(begun(options, {.load_step = 7, .t = 0.5}), (std::vector<double>{0.75, 1}));
  EXPECT_EQ(begun(options, {.load_step = 7, .t = 0.3}), (std::vector<double>{0.5, 0.75, 1}));
  EXPECT_THROW(begun(options, {.load_step = 7, .t = 1}), InputError);
  EXPECT_THROW(begun(options, {.load_step = 7, .t = -0.1}), InputError);
  options.to = -1;
  EXPECT_EQ(begun(options, {.load_step = 1, .t = -0.5}), (std::vector<double>{-0.75, -1}));
}

TEST(Continuation, AFirstStepThatFailsLeavesTheBestPointALaterOneTheLastConverged) {
  Pull pull(1);
  ContinuationOptions options;
  run_continuation(*pull.p.functional, pull.p.u, pull.boundary(2.8), options, {}, {});
  complete(*pull.p.layout, pull.p.u);
  EXPECT_EQ(pull.p.value(1), 2.8);
}

TEST(Continuation, AnInterruptedStepIsNotTriedAgainAndKeepsItsPoint) {
  struct Interrupt : Recorder {
    void iteration(const IterationRecord& r) override {
      Recorder::iteration(r);
      if (r.load_step == 2) interrupt_requested = true;
    }
  } interrupt;
  Far far(100);
  SolverOptions solver;
  solver.initial_radius = testing::unit;
  solver.max_corrections = 0;
  ContinuationOptions options;
  options.steps = 2;
  options.adaptive = true;
  Observer* observers[] = {&interrupt};
  const auto report = run_continuation(*far.functional, far.u, {}, options, solver, observers);
  interrupt_requested = false;
  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(interrupt.begun, (std::vector<double>{0.5, 1}));
  ASSERT_EQ(report.steps.size(), 2u);
  EXPECT_NEAR(far.x(), 51, 1e-8);  // one step of length 1 beyond the first load step's 50
}

TEST(ContinuationOptions, RefuseWhatMakesNoSense) {
  const auto wrong = [](auto set) {
    ContinuationOptions options;
    set(options);
    return options.validate().size();
  };
  EXPECT_EQ(wrong([](ContinuationOptions&) {}), 0u);
  EXPECT_EQ(wrong([](ContinuationOptions& o) { o.steps = 0; }), 1u);
  EXPECT_EQ(wrong([](ContinuationOptions& o) { o.to = NAN; }), 1u);
  EXPECT_EQ(wrong([](ContinuationOptions& o) { o.from = INFINITY; }), 1u);
  for (const double x : {0.0, -1.0, 1.5}) EXPECT_EQ(wrong([&](ContinuationOptions& o) { o.smallest = x; }), 1u);
  Pull pull(1);
  ContinuationOptions backwards;
  backwards.from = 1;
  backwards.to = 0;
  SolverOptions flow;
  flow.method = "gradient-flow";
  EXPECT_THROW(run_continuation(*pull.p.functional, pull.p.u, {}, backwards, flow, {}), InputError);
}

}  // namespace
}  // namespace karcher
