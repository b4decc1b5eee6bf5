#include "karcher/solve/continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/error.hpp"
#include "solve/tuning.hpp"

namespace karcher {

std::vector<std::string> ContinuationOptions::validate() const {
  std::vector<std::string> wrong;
  if (steps < 1) wrong.push_back(fmt::format("The number of load steps must be at least 1, but is {}.", steps));
  if (!std::isfinite(from) || !std::isfinite(to)) wrong.push_back("The load parameter's range must be finite.");
  if (!(smallest > 0 && smallest <= 1))
    wrong.push_back(fmt::format("The smallest part of the load range for a step must be in (0, 1], but is {}.", smallest));
  return wrong;
}

ContinuationReport run_continuation(Functional& functional, Configuration& u, const BoundaryValues& boundary, const ContinuationOptions& options,
                                    const SolverOptions& solver, std::span<Observer* const> observers) {
  if (const auto wrong = options.validate(); !wrong.empty()) throw InputError(wrong.front());
  const bool flow = solver.method == "gradient-flow";
  if (flow && !(options.to > options.from))
    throw InputError("A gradient flow needs a time interval: the load parameter must grow from `from` to `to`.");
  const SolverTuning& tuning = default_tuning;
  Minimizer minimizer(functional, solver, tuning);
  ContinuationReport result;

  // Progress is counted in parts of the whole range, so that the last step ends exactly at `to`.
  const double whole = 1.0 / options.steps;
  double done = 0, part = whole;
  int load_step = 0;
  while (done < 1) {
    double next = std::min(1.0, done + part);
    if (1 - next < tuning.step_remainder * part) next = 1;
    if (!options.adaptive) next = static_cast<double>(load_step + 1) / options.steps;
    const double t = next == 1 ? options.to : options.from + next * (options.to - options.from);

    for (Observer* o : observers) o->load_step_begins(load_step, t);
    const Configuration before = u;
    functional.set_load_parameter(t);
    u.t = t;
    Configuration target = u;
    if (boundary) boundary(t, target);
    Minimizer::Task task;
    task.load_step = load_step;
    task.boundary = boundary ? &target : nullptr;
    task.time_step = flow ? (next - done) * (options.to - options.from) : 0.0;
    StepReport report = minimizer.run(u, task, observers);

    const bool retry = options.adaptive && (report.status == Status::not_converged || report.status == Status::failed) &&
                       tuning.step_fall * part >= options.smallest;
    if (retry) {
      u = before;
      part *= tuning.step_fall;
      continue;
    }
    result.steps.push_back(report);
    result.seconds += report.seconds;
    result.status = report.status;
    for (Observer* o : observers) o->load_step_finished(report, u);
    if (report.status != Status::converged) {
      if (load_step > 0 && report.status != Status::interrupted) u = before;
      break;
    }
    done = next;
    ++load_step;
    if (options.adaptive && report.iterations <= tuning.few_iterations) part = std::min(tuning.step_growth * part, whole);
  }
  return result;
}

}  // namespace karcher
