#include "karcher/solve/minimize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/error.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/spread.hpp"
#include "solve/boundary.hpp"
#include "solve/corrections.hpp"
#include "solve/excursion.hpp"
#include "solve/predictor.hpp"
#include "solve/radius.hpp"
#include "solve/saddle.hpp"
#include "solve/stability.hpp"
#include "solve/stopwatch.hpp"
#include "solve/system.hpp"

namespace karcher {

std::atomic<bool> interrupt_requested = false;

namespace {

double seconds_since_start() {
  static double none = 0;
  static const Stopwatch clock(none);
  return clock.elapsed();
}
[[maybe_unused]] const double started = seconds_since_start();

}  // namespace

struct Minimizer::State {
  System system;
  double largest_gradient = 0;  ///< at the start of this or an earlier run

  // Of the current run.
  Task task;
  std::span<Observer* const> observers;
  StepReport report;
  Iterate current;
  Configuration start_u;  ///< of the current run
  double radius = 1;
  int escapes = 0;
  double shift = 0;  ///< see Subproblem::set

  State(Functional& functional, SolverOptions options, const SolverTuning& tuning) : system(functional, std::move(options), tuning) {}

  double tolerance() const {
    const double relative = task.gradient_tolerance > 0 ? task.gradient_tolerance : system.options.gradient_tolerance;
    return std::max(relative * largest_gradient, system.options.absolute_gradient_tolerance);
  }
  void start(Configuration& u);
  bool iterate();
  std::optional<Stability> judge();
  bool end(const std::string& test);
  void stop(Status status, std::string reason) {
    report.status = status;
    report.reason = std::move(reason);
  }
  void warn(const std::string& sentence) {
    if (!sentence.empty()) report.warnings.push_back(sentence + ".");
  }
  void tell(const IterationRecord& record) {
    for (Observer* o : observers) o->iteration(record);
  }
};

/// The first point: u, or where its boundary takes it.
void Minimizer::State::start(Configuration& u) {
  escapes = 0;
  shift = 0;
  radius = system.options.initial_radius > 0 ? system.options.initial_radius : system.tuning.first_radius;
  system.evaluator.set_proximal(u, system.options.method == "gradient-flow" ? task.time_step : 0.0);
  std::optional<Prediction> prediction;
  if (task.boundary) prediction = predict(system, u, *task.boundary, tolerance());
  if (prediction) {
    current = std::move(prediction->x);
    if (system.options.initial_radius == 0) radius = std::min(radius, prediction->radius);
  } else {
    current = {};
    current.u = u;
    system.evaluator.gradient(current);
  }
  if (current.ok()) largest_gradient = std::max(largest_gradient, current.gradient_norm);
  start_u = current.u;
}

/// Stability of the current point, also into the report. Nothing if the Hessian cannot be evaluated.
std::optional<Stability> Minimizer::State::judge() {
  shift = 0;
  const std::optional<Stability> found = stability_at(system, current);
  if (found) {
    report.negative_eigenvalues = found->negative;
    report.neutral_eigenvalues = found->neutral;
  }
  return found;
}

/// The test that is met (a clause) ends the run, unless the point is a saddle that can be left. True if it ends.
bool Minimizer::State::end(const std::string& test) {
  const std::optional<Stability> stability = judge();
  if (!stability) {
    stop(Status::failed, "The Hessian at the end point could not be evaluated: " + current.failure);
    return true;
  }
  const SolverOptions& options = system.options;
  if (stability->negative > 0 && options.escape && escapes < system.tuning.most_escapes && report.iterations < options.max_iterations) {
    if (std::optional<Iterate> lower = escape_saddle(system, current)) {
      current = std::move(*lower);
      ++escapes;
      return false;
    }
  }
  std::string kind = "the point is " + stability->kind();
  if (const Spread spread = widest_spread(system.layout, current.u); spread.ratio >= Spread::opposite)
    kind = fmt::format("whether the point is a minimum cannot be told: {}, so the interpolation is not determined there", spread.sentence);
  stop(Status::converged, fmt::format("{}; {}.", test, kind));
  return true;
}

/// One factorisation's worth of work: trial steps until one is accepted. True if the run has ended.
bool Minimizer::State::iterate() {
  if (current.gradient_norm <= tolerance())
    return end(fmt::format("The gradient norm {:.3g} is at most {:.3g} ({:.3g} at the start)", current.gradient_norm, tolerance(), largest_gradient));
  if (!system.linearise(current, shift)) {
    stop(Status::failed, "The Hessian could not be evaluated: " + current.failure);
    return true;
  }

  const SolverTuning& tuning = system.tuning;
  const SolverOptions& options = system.options;
  Subproblem& subproblem = system.subproblem();
  bool rejected = false;
  std::string trouble;  // of the last trial point
  for (;;) {
    if (on_any_rank(interrupt_requested)) {
      stop(Status::interrupted, fmt::format("Interrupted; the gradient norm is {:.3g}, its threshold {:.3g}.", current.gradient_norm, tolerance()));
      return true;
    }
    if (report.iterations >= options.max_iterations) {
      stop(Status::not_converged, fmt::format("After {} iterations (the most that are allowed) the gradient norm is {:.3g}, its threshold {:.3g}.",
                                              report.iterations, current.gradient_norm, tolerance()));
      return true;
    }
    Step step = subproblem.step(radius, tuning.trial);
    const bool newton = step.multiplier == 0;
    if (newton) step = subproblem.step(radius, tuning.newton);
    if (!(step.norm > 0 && std::isfinite(step.norm) && std::isfinite(step.decrease))) {
      stop(Status::failed, fmt::format("No step could be computed from a gradient of norm {:.3g}: its largest entry is {}, and numbers overflow.",
                                       current.gradient_norm, system.evaluator.largest_entry(current.g)));
      return true;
    }
    const double significant = system.significant(current, step.s);
    const bool tiny = step.decrease <= significant;
    if (tiny && !newton && radius < tuning.shortest_radius) {  // is the radius tiny, or what is there to gain?
      const Step longer = subproblem.step(tuning.shortest_radius, tuning.trial);
      if (longer.decrease > system.significant(current, longer.s)) {
        if (rejected) {
          stop(Status::not_converged, fmt::format("No step reduces the energy, however short; the gradient norm is {:.3g}, its threshold {:.3g}.{}",
                                                  current.gradient_norm, tolerance(), trouble.empty() ? "" : " " + trouble));
          return true;
        }
        radius = longer.norm;
        continue;
      }
    }

    if (const double rounding = system.rounding().gradient_norm; tiny && !rejected && current.gradient_norm <= rounding)
      return end(fmt::format("The gradient norm {:.3g} is rounding, which may be {:.3g} with these stiffnesses", current.gradient_norm, rounding));

    Iterate x = system.moved(current.u, step.s);
    const double ratio_of_step = (current.energy - x.energy) / step.decrease;
    if (x.ok()) correct(system, x, current.energy, step, tolerance());
    const double ratio = tiny ? 1.0 : (current.energy - x.energy) / step.decrease;
    const bool accepted = x.ok() && (tiny ? x.gradient_norm <= tuning.steadier * current.gradient_norm && x.energy <= current.energy + significant
                                          : ratio > tuning.least_ratio);
    ++report.iterations;

    IterationRecord record{task.load_step,
                           report.iterations,
                           accepted ? x.energy : current.energy,
                           accepted ? x.gradient_norm : current.gradient_norm,
                           step.norm,
                           radius,
                           step.multiplier,
                           ratio,
                           accepted,
                           seconds_since_start(),
                           x.failure};
    if (!accepted && tiny) {
      tell(record);
      return end(fmt::format("The energy cannot be reduced beyond rounding (the best step promises {:.2g}); the gradient norm is {:.3g}",
                             step.decrease, current.gradient_norm));
    }
    if (const double moved = accepted ? diameters_moved(system.functional, start_u, x.u) : 0; moved > tuning.farthest) {
      stop(Status::not_converged, fmt::format("In this load step the body would move by {:.3g} of its diameters, so it stays where it was: a support "
                                              "is missing, or a load is in the wrong unit.",
                                              moved));
      current = {};
      current.u = start_u;
      system.evaluator.gradient(current);
      return true;
    }
    if (accepted) {
      shift = subproblem.next_shift(step, ratio);
      const bool quadratic = !tiny && !newton && std::abs(ratio_of_step - 1) <= tuning.exact && is_definite(system);
      radius = radius_after_accepted(radius, step.norm, ratio, quadratic, tuning);
      current = std::move(x);
      tell(record);
      if (newton && step.norm <= options.step_tolerance) {
        return end(fmt::format("The Newton step {:.3g} is at most {:.3g}", step.norm, options.step_tolerance));
      }
      return false;
    }
    subproblem.set_gradient(current.g);
    radius = radius_after_rejected(step.norm, system.exchange.dot(step.s, current.g), x.energy - current.energy, tuning);
    tell(record);
    rejected = true;
    trouble = x.failure;
  }
}

Minimizer::Minimizer(Functional& functional, SolverOptions options) : Minimizer(functional, std::move(options), default_tuning) {}

Minimizer::Minimizer(Functional& functional, SolverOptions options, const SolverTuning& tuning) {
  if (const auto wrong = options.validate(); !wrong.empty()) throw InputError(wrong.front());
  state_ = std::make_unique<State>(functional, std::move(options), tuning);
}

Minimizer::~Minimizer() = default;

StepReport Minimizer::run(Configuration& u, const Task& task, std::span<Observer* const> observers) {
  State& s = *state_;
  const double begin = seconds_since_start();
  s.task = task;
  s.observers = observers;
  s.system.work = {};
  s.system.phases = {};
  s.report = {};
  s.report.load_step = task.load_step;
  s.report.t = u.t;

  if (task.boundary) s.warn(far_turn(s.system.layout, u, *task.boundary));
  s.start(u);
  if (!s.current.ok())
    s.stop(Status::failed, "The energy at the start of the load step is not defined: " + s.current.failure);
  else
    while (!s.iterate()) {
    }
  if (s.report.status == Status::not_converged) {
    const std::optional<Stability> stability = s.judge();
    if (stability && stability->loaded)
      s.report.reason += fmt::format(" The load works along a motion that nothing holds ({} eigenvalue{} zero): a support is missing.",
                                     stability->neutral, stability->neutral == 1 ? " is" : "s are");
  }

  if (const Spread spread = widest_spread(s.system.layout, s.current.u); spread.ratio > Spread::wide)
    s.warn(spread.sentence + ": the mesh is too coarse for the map there, or its data jump");
  u.values.swap(s.current.u.values);
  s.current.u.values.clear();
  s.report.energy = s.current.energy;
  s.report.energies = s.current.terms;
  s.report.gradient_norm = s.current.gradient_norm;
  s.report.largest_gradient = s.largest_gradient;
  s.report.work = s.system.work;
  s.report.phases = s.system.phases;
  s.report.seconds = seconds_since_start() - begin;
  return s.report;
}

void Minimizer::resume(const Configuration& u, double largest_gradient) {
  State& s = *state_;
  s.largest_gradient = largest_gradient;
  s.current = {};
  s.current.u = u;
  s.system.evaluator.set_proximal(u, 0.0);
  s.system.evaluator.gradient(s.current);
  if (s.current.ok()) s.judge();
}

StepReport minimize(Functional& functional, Configuration& u, const SolverOptions& options, std::span<Observer* const> observers, int load_step) {
  Minimizer minimizer(functional, options);
  Minimizer::Task task;
  task.load_step = load_step;
  return minimizer.run(u, task, observers);
}

}  // namespace karcher
