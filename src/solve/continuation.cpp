#include "karcher/solve/continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "karcher/error.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/path_watch.hpp"
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

int last_load_step(const ContinuationOptions& options, const ContinuationStart& start) {
  if (options.adaptive) return 0;
  if (start.load_step == 0) return options.steps;
  const double part = (start.t - options.from) / (options.to - options.from);
  return start.load_step + options.steps - static_cast<int>(std::floor(part * options.steps + default_tuning.same_load));
}

ContinuationReport run_continuation(Functional& functional, Configuration& u, const BoundaryValues& boundary, const ContinuationOptions& options,
                                    const SolverOptions& solver, std::span<Observer* const> observers, const ContinuationStart& start,
                                    const ChangingSupports& supports) {
  if (const auto wrong = options.validate(); !wrong.empty()) throw InputError(wrong.front());
  const bool flow = solver.method == "gradient-flow";
  if (flow && !(options.to > options.from))
    throw InputError("A gradient flow needs a time interval: the load parameter must grow from `from` to `to`.");
  const SolverTuning& tuning = default_tuning;
  const double range = options.to - options.from, longest = range / options.steps;
  const bool adaptive = options.adaptive && range != 0;
  if (supports.hold) supports.hold(start.load_step > 0 ? start.t : options.from);
  auto minimizer = std::make_unique<Minimizer>(functional, solver, tuning);
  double largest_gradient = start.largest_gradient;
  ContinuationReport result;

  double t = options.from, increment = longest;
  int load_step = 0, fixed = 0;  // finished load steps; which of the loads of fixed steps was reached
  if (start.load_step > 0) {
    if (!((start.t - options.from) * range >= 0 && (options.to - start.t) * range > 0))
      throw InputError(fmt::format("Load steps from t = {:.6g} to {:.6g} cannot go on after t = {:.6g}.", options.from, options.to, start.t));
    load_step = start.load_step;
    t = start.t;
    if (!adaptive) fixed = options.steps - (last_load_step(options, start) - load_step);
    if (std::abs(start.increment) < std::abs(longest) && start.increment * range > 0) increment = start.increment;
    functional.set_load_parameter(t);
    u.t = t;
    minimizer->resume(u, largest_gradient);
  }
  std::optional<PathWatch> path;
  const auto watch_from_here = [&] {
    path.emplace(functional.layout(), step_mass(functional.layout()), tuning);
    path->next(u);
  };
  watch_from_here();
  while (adaptive ? t != options.to : fixed < options.steps) {
    double next = fixed + 1 == options.steps ? options.to : options.from + static_cast<double>(fixed + 1) / options.steps * range;
    if (adaptive) {
      next = t + increment;
      if ((options.to - next) / increment < tuning.step_remainder) next = options.to;
      for (const double change : supports.changes)
        if ((change - t) / longest > tuning.same_load && (next - change) / longest > -tuning.same_load) {
          next = change;
          break;
        }
    }
    if (supports.hold && supports.hold(next)) {
      minimizer = std::make_unique<Minimizer>(functional, solver, tuning);
      if (load_step > 0) minimizer->resume(u, largest_gradient);
      watch_from_here();
    }

    for (Observer* o : observers) o->load_step_begins(load_step + 1, next);
    const Configuration before = u;
    functional.set_load_parameter(next);
    u.t = next;
    Configuration target = u;
    if (boundary) boundary(next, target);
    Minimizer::Task task;
    task.load_step = load_step + 1;
    task.boundary = boundary ? &target : nullptr;
    task.time_step = flow ? next - t : 0.0;
    StepReport report = minimizer->run(u, task, observers);

    const bool retry = adaptive && (report.status == Status::not_converged || report.status == Status::failed) &&
                       tuning.step_fall * increment / range >= options.smallest;
    if (retry) {
      u = before;
      increment *= tuning.step_fall;
      continue;
    }
    const bool converged = report.status == Status::converged;
    if (converged && report.iterations <= tuning.few_iterations) {
      increment *= tuning.step_growth;
      if (increment / longest > 1) increment = longest;
    }
    if (converged && !flow)
      if (const std::string jump = path->next(u); !jump.empty()) report.warnings.push_back(jump + ".");
    if (converged && adaptive && next != options.to) report.next_increment = increment;
    result.steps.push_back(report);
    result.seconds += report.seconds;
    result.status = report.status;
    for (Observer* o : observers) o->load_step_finished(report, u);
    if (!converged) {
      if (load_step > 0 && report.status != Status::interrupted) u = before;
      break;
    }
    t = next;
    largest_gradient = report.largest_gradient;
    ++load_step;
    ++fixed;
  }
  return result;
}

}  // namespace karcher
