#include "karcher/solve/minimize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "karcher/error.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/evaluator.hpp"
#include "solve/model.hpp"
#include "solve/seed.hpp"
#include "solve/stopwatch.hpp"

namespace karcher {

std::atomic<bool> interrupt_requested = false;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_escapes = 20;

double seconds_since_start() {
  static double none = 0;
  static const Stopwatch clock(none);
  return clock.elapsed();
}
[[maybe_unused]] const double started = seconds_since_start();

std::vector<char> fixed_flags(const Layout& layout) {
  std::vector<char> fixed(static_cast<std::size_t>(layout.local_dofs()));
  for (std::size_t d = 0; d < fixed.size(); ++d) fixed[d] = layout.fixed(static_cast<int>(d));
  return fixed;
}

/// Tangent coordinates of the way from u to the fixed components of `boundary`; free components 0.
std::vector<double> boundary_increment(const Layout& layout, const Configuration& u, const Configuration& boundary) {
  std::vector<double> delta(static_cast<std::size_t>(layout.local_dofs()), 0.0);
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    const auto ambient = static_cast<std::size_t>(manifold.ambient), dim = static_cast<std::size_t>(manifold.dim);
    std::vector<double> frame(ambient * dim), column(ambient), a(ambient);
    for (int node : layout.local_nodes(f)) {
      const int first = layout.first_dof(f, node);
      bool any = false;
      for (int k = 0; k < manifold.dim; ++k) any = any || layout.fixed(first + k);
      const double *p = u.at(f, node, manifold.ambient), *q = boundary.at(f, node, manifold.ambient);
      if (!any || std::equal(p, p + ambient, q)) continue;
      manifold.log(p, q, a.data());
      manifold.frame(p, frame.data());
      for (std::size_t k = 0; k < dim; ++k) {
        if (!layout.fixed(first + static_cast<int>(k))) continue;
        for (std::size_t i = 0; i < ambient; ++i) column[i] = frame[i * dim + k];
        delta[static_cast<std::size_t>(first) + k] = manifold.inner(p, column.data(), a.data());
      }
    }
  }
  return delta;
}

/// As Layout::retract, but fixed components move, too.
void retract_all(const Layout& layout, const Configuration& from, std::span<const double> step, Configuration& to) {
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    for (int node : layout.local_nodes(f))
      manifold.retract(from.at(f, node, manifold.ambient), step.data() + layout.first_dof(f, node), to.at(f, node, manifold.ambient));
  }
}

/// Nodes that are wholly fixed get the prescribed value itself, not what rounding has made of it.
void copy_fixed_nodes(const Layout& layout, const Configuration& boundary, Configuration& u) {
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    for (int node : layout.local_nodes(f)) {
      bool all = true;
      for (int k = 0; k < manifold.dim; ++k) all = all && layout.fixed(layout.first_dof(f, node) + k);
      if (all) std::copy_n(boundary.at(f, node, manifold.ambient), manifold.ambient, u.at(f, node, manifold.ambient));
    }
  }
}

std::string known(const std::string& key, const std::string& value, std::initializer_list<const char*> names) {
  std::string list;
  for (const char* n : names) {
    if (value == n) return {};
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", n);
  }
  return fmt::format("The solver has no {} \"{}\"; it has {}.", key, value, list);
}

}  // namespace

std::vector<std::string> SolverOptions::validate() const {
  std::vector<std::string> wrong;
  const auto add = [&](std::string sentence) {
    if (!sentence.empty()) wrong.push_back(std::move(sentence));
  };
  add(known("method", method, {"trust-region", "gradient-flow"}));
  add(known("subproblem", subproblem, {"direct"}));
  add(known("norm", norm, {"mass"}));
  if (!(gradient_tolerance >= 0 && gradient_tolerance < 1)) add(fmt::format("gradient_tolerance must be in [0, 1), but is {}.", gradient_tolerance));
  if (!(absolute_gradient_tolerance >= 0))
    add(fmt::format("absolute_gradient_tolerance must not be negative, but is {}.", absolute_gradient_tolerance));
  if (!(step_tolerance >= 0)) add(fmt::format("step_tolerance must not be negative, but is {}.", step_tolerance));
  if (max_iterations < 0) add(fmt::format("max_iterations must not be negative, but is {}.", max_iterations));
  if (!(initial_radius >= 0 && initial_radius < infinity))
    add(fmt::format("initial_radius must be 0 (chosen) or positive, but is {}.", initial_radius));
  if (max_corrections < 0) add(fmt::format("max_corrections must not be negative, but is {}.", max_corrections));
  return wrong;
}

struct Minimizer::State {
  Functional& functional;
  const Layout& layout;
  SolverOptions options;
  Exchange exchange;
  std::vector<char> fixed;
  std::vector<double> mass;
  std::vector<std::uint64_t> numbers;
  WorkCounts work;
  PhaseSeconds phases;
  Evaluator evaluator;
  BlockMatrix h;
  std::unique_ptr<Ldlt> ldlt;
  std::unique_ptr<TrustRegionModel> model;
  Configuration factored_at;  ///< where the model's matrix and factorisation belong; no values: nowhere

  // Of the current run.
  Task task;
  std::span<Observer* const> observers;
  StepReport report;
  Iterate current;
  double largest_gradient = 0, radius = 1;
  int escapes = 0;
  double shift_hint = 0;  ///< where to factorise next: 0, or about the multiplier of the next step

  State(Functional& f, SolverOptions o)
      : functional(f),
        layout(f.layout()),
        options(std::move(o)),
        exchange(layout),
        fixed(fixed_flags(layout)),
        mass(step_mass(layout)),
        numbers(seed_numbers(layout)),
        evaluator(functional, exchange, fixed, mass, work, phases),
        h(functional.make_matrix()) {}

  double tolerance() const {
    const double relative = task.gradient_tolerance > 0 ? task.gradient_tolerance : options.gradient_tolerance;
    return std::max(relative * largest_gradient, options.absolute_gradient_tolerance);
  }
  double size(std::span<const double> s) const {
    double square = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(exchange.owned_dofs()); ++d) square += mass[d] * s[d] * s[d];
    return std::sqrt(sum_over_ranks(square));
  }

  /// Norm of the step that moves all nodes as far as s moves the farthest one of each field.
  double uniform_size(std::span<const double> s) const {
    double square = 0;
    for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
      const int dim = layout.fields()[static_cast<std::size_t>(f)].manifold->dim;
      double farthest = 0, weight = 0;
      for (int node : layout.local_nodes(f)) {
        const auto first = static_cast<std::size_t>(layout.first_dof(f, node));
        double here = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) here += s[first + k] * s[first + k];
        farthest = std::max(farthest, here);
        if (layout.owns(f, node)) weight += mass[first];
      }
      square += sum_over_ranks(weight) * max_over_ranks(farthest);
    }
    return std::sqrt(square);
  }

  bool factor_at_current();
  Iterate moved(const Configuration& from, std::span<const double> s);
  void correct(Iterate& x, double base_energy, const TrustRegionModel::Step& step);
  bool predict(Configuration& u);
  bool escape_saddle();
  bool iterate();
  bool count_negative_eigenvalues();
  bool end(const std::string& test);
  void stop(Status status, std::string reason) {
    report.status = status;
    report.reason = std::move(reason);
  }
  void tell(const IterationRecord& record) {
    for (Observer* o : observers) o->iteration(record);
  }
};

/// Hessian at the current iterate and its factorisation, if they are not there already. False if the Hessian could not be evaluated.
bool Minimizer::State::factor_at_current() {
  const bool same_place = !on_any_rank(factored_at.values.empty() || factored_at.values != current.u.values);
  std::vector<double> before;
  if (same_place) before = h.values;
  evaluator.hessian(current, h);
  if (!current.ok()) {
    factored_at.values.clear();
    return false;
  }
  // The matrix may be the same although the load has changed (dead loads): then so is the factorisation.
  if (same_place && !on_any_rank(before != h.values)) {
    model->set_gradient(current.g);
    return true;
  }
  if (!ldlt) {
    Stopwatch watch(phases.factorisation);
    ldlt = std::make_unique<Ldlt>(exchange, h, fixed);
    model = std::make_unique<TrustRegionModel>(exchange, *ldlt, fixed, mass, numbers, work, phases);
  }
  model->set(h, current.g, shift_hint);
  factored_at.values = current.u.values;
  return true;
}

/// retract(from, s), evaluated.
Iterate Minimizer::State::moved(const Configuration& from, std::span<const double> s) {
  Iterate x;
  x.u = from;
  layout.retract(from, s, x.u);
  evaluator.gradient(x);
  return x;
}

/// Goes on from the trial point x with the matrix that is factorised already, as long as it pays. Tangent coordinates at x are taken for those where the
/// matrix was made: for body frames the natural transport, and in any case the energy decides. Soft directions, for which the old matrix is wrong, must not
/// spoil what the stiff ones gain; so of the corrections that one basis has to offer, shorter or longer, across the step or not, the best is taken.
void Minimizer::State::correct(Iterate& x, double base_energy, const TrustRegionModel::Step& step) {
  double total = std::max(0.0, std::isfinite(base_energy) ? base_energy - x.energy : 0.0);
  double reach = step.norm;
  for (int k = 0; k < options.max_corrections && x.gradient_norm > tolerance(); ++k) {
    model->set_gradient(x.g);
    TrustRegionModel::Step c = model->step(reach, {.accuracy = 0.1, .expansions = 2, .refactorisations = 0});
    const bool tiny = c.decrease <= 10 * x.noise;
    Iterate next;
    next.energy = infinity;
    double length = 0;
    for (double part : {1.0, 0.25, 0.0625})
      for (bool across : {false, true}) {
        if (tiny && (across || part < 1)) continue;
        const TrustRegionModel::Step candidate =
            part == 1 && !across ? c : model->step_in_basis(part * reach, across ? step.y : std::span<const double>());
        if (part < 1 && !across && c.norm <= part * reach) continue;
        Iterate y;
        y.u = x.u;
        layout.retract(x.u, candidate.s, y.u);
        evaluator.energy(y);
        if (y.energy < next.energy) {
          next = std::move(y);
          length = candidate.norm;
        }
      }
    const double gain = x.energy - next.energy;
    if (!next.ok() || !(gain > (tiny ? -10 * x.noise : 0.0))) break;
    evaluator.gradient(next);
    const bool steadier = next.gradient_norm <= 0.5 * x.gradient_norm;
    if (!next.ok() || (tiny && !steadier)) break;
    x = std::move(next);
    total += gain;
    if (gain < 0.1 * total && !steadier) break;
    reach = std::min(step.norm, 4 * length);
  }
}

/// Moves the boundary to its prescribed values and everything else with it by the linear problem. False if the boundary does not move.
bool Minimizer::State::predict(Configuration& u) {
  std::vector<double> delta = boundary_increment(layout, u, *task.boundary);
  const double reach = uniform_size(delta);
  if (!(reach > 1e-13)) {  // rounding is no move
    copy_fixed_nodes(layout, *task.boundary, u);
    return false;
  }
  Iterate naive;
  naive.u = u;
  retract_all(layout, u, delta, naive.u);
  copy_fixed_nodes(layout, *task.boundary, naive.u);
  evaluator.gradient(naive);

  current.u = u;
  Iterate predicted;
  predicted.energy = infinity;
  if (factor_at_current()) {
    std::vector<double> pull(delta.size());
    multiply(exchange, h, {}, delta, pull);
    for (std::size_t d = 0; d < pull.size(); ++d) pull[d] = fixed[d] ? 0 : pull[d] + current.g[d];
    model->set_gradient(pull);
    // Soft modes must not carry the inside further than the boundary goes.
    model->step(reach, {});
    TrustRegionModel::Step step;
    for (double part : {1.0, 0.25, 0.0625}) {
      const TrustRegionModel::Step candidate = model->step_in_basis(part * reach);
      std::vector<double> whole = delta;
      for (std::size_t d = 0; d < whole.size(); ++d) whole[d] += candidate.s[d];
      Iterate x;
      x.u = u;
      retract_all(layout, u, whole, x.u);
      copy_fixed_nodes(layout, *task.boundary, x.u);
      evaluator.energy(x);
      if (!(x.energy < predicted.energy)) continue;
      predicted = std::move(x);
      step = candidate;
    }
    if (predicted.energy < infinity) evaluator.gradient(predicted);
    // Where it is the boundary that disturbs an equilibrium, the solution is about as far as the boundary goes.
    if (options.initial_radius == 0 && current.gradient_norm < 0.1 * naive.gradient_norm) radius = std::min(radius, reach);
    if (predicted.energy < infinity) correct(predicted, infinity, step);
  }
  const bool better = predicted.energy < infinity && predicted.energy <= naive.energy;
  current = better ? std::move(predicted) : std::move(naive);
  return true;
}

/// From a saddle along the lowest eigenvector of the Hessian. False if no decrease is found.
bool Minimizer::State::escape_saddle() {
  model->find_negative_directions();
  std::vector<double> direction = model->lowest_direction();
  exchange.update_ghosts(direction);
  const double slope = exchange.dot(direction, current.g);
  Iterate best;
  best.energy = current.energy - 10 * current.noise;
  bool found = false;
  for (double length = slope > 0 ? -1e-3 : 1e-3; std::abs(length) < 3; length *= 2) {
    std::vector<double> s = direction;
    for (double& x : s) x *= length;
    Iterate x = moved(current.u, s);
    if (x.ok() && x.energy < best.energy) {
      best = std::move(x);
      found = true;
    } else if (found) {
      break;
    }
  }
  if (found) current = std::move(best);
  return found;
}

/// Inertia of the true Hessian at the current iterate, into the report. False if it cannot be evaluated.
bool Minimizer::State::count_negative_eigenvalues() {
  shift_hint = 0;
  if (!factor_at_current()) return false;
  if (model->shift() != 0) model->refactor(0.0);
  double stiffest = 0;
  const auto bs = static_cast<std::size_t>(h.block_size);
  for (std::size_t d = 0; d < static_cast<std::size_t>(exchange.owned_dofs()); ++d)
    if (!fixed[d]) {
      const std::size_t at = static_cast<std::size_t>(h.row_begin[d / bs]) * bs * bs + (d % bs) * (bs + 1);
      stiffest = std::max(stiffest, std::abs(h.values[at]) / mass[d]);
    }
  stiffest = max_over_ranks(stiffest);
  report.negative_eigenvalues = model->inertia().negative;
  report.neutral_eigenvalues = model->inertia().null;
  if (model->inertia().negative > 0) {
    model->find_negative_directions();
    const double zero = 1e-13 * stiffest;
    for (double e : model->ritz_values())
      if (e < 0 && e > -zero) {
        --report.negative_eigenvalues;
        ++report.neutral_eigenvalues;
      }
  }
  return true;
}

/// The test that is met (a clause) ends the run, unless the point is a saddle that can be left. True if it ends.
bool Minimizer::State::end(const std::string& test) {
  if (!count_negative_eigenvalues()) {
    stop(Status::failed, "The Hessian at the end point could not be evaluated: " + current.failure);
    return true;
  }
  const int negative = report.negative_eigenvalues, neutral = report.neutral_eigenvalues;
  if (negative > 0 && options.escape && escapes < most_escapes && report.iterations < options.max_iterations && escape_saddle()) {
    ++escapes;
    return false;
  }
  std::string kind = negative == 0 ? "a local minimum"
                                   : fmt::format("not a local minimum: the Hessian has {} negative eigenvalue{}", negative, negative == 1 ? "" : "s");
  if (neutral > 0) kind += fmt::format(" ({} eigenvalue{} zero to rounding)", neutral, neutral == 1 ? " is" : "s are");
  stop(Status::converged, fmt::format("{}; the point is {}.", test, kind));
  return true;
}

/// One factorisation's worth of work: trial steps until one is accepted. True if the run has ended.
bool Minimizer::State::iterate() {
  if (current.gradient_norm <= tolerance())
    return end(fmt::format("The gradient norm {:.3g} is at most {:.3g} ({:.3g} at the start)", current.gradient_norm, tolerance(), largest_gradient));
  if (!factor_at_current()) {
    stop(Status::failed, "The Hessian could not be evaluated: " + current.failure);
    return true;
  }

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
    TrustRegionModel::Step step = model->step(radius, {});
    const bool newton = step.multiplier == 0;
    if (newton) step = model->step(radius, {.accuracy = 1e-8});
    const bool tiny = step.decrease <= 10 * current.noise;
    constexpr double shortest = 1e-6;            // steps are measured in parts of the domain and in radians
    if (tiny && !newton && radius < shortest) {  // is the radius tiny, or what is there to gain?
      const TrustRegionModel::Step longer = model->step(shortest, {});
      if (longer.decrease > 10 * current.noise) {
        if (rejected) {
          stop(Status::not_converged, fmt::format("No step reduces the energy, however short; the gradient norm is {:.3g}, its threshold {:.3g}.{}",
                                                  current.gradient_norm, tolerance(), trouble.empty() ? "" : " " + trouble));
          return true;
        }
        radius = longer.norm;
        continue;
      }
    }

    Iterate x = moved(current.u, step.s);
    if (x.ok()) correct(x, current.energy, step);
    const double ratio = tiny ? 1.0 : (current.energy - x.energy) / step.decrease;
    const bool accepted =
        x.ok() && (tiny ? x.gradient_norm <= 0.5 * current.gradient_norm && x.energy <= current.energy + 10 * current.noise : ratio > 0.01);
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
    if (accepted) {
      shift_hint = ratio > 0.75 ? 0.5 * step.multiplier : step.multiplier;
      if (model->negative_in_basis() < model->inertia().negative) shift_hint = std::max(shift_hint, model->shift());
      if (ratio < 0.25)
        radius = 0.5 * step.norm;
      else
        radius = std::min(ratio > 0.9 && step.norm > 0.9 * radius ? 2 * radius : radius, 8 * step.norm);
      current = std::move(x);
      tell(record);
      if (newton && step.norm <= options.step_tolerance) {
        return end(fmt::format("The Newton step {:.3g} is at most {:.3g}", step.norm, options.step_tolerance));
      }
      return false;
    }
    model->set_gradient(current.g);
    // Where along s the energy would be least if it were a parabola.
    const double slope = exchange.dot(step.s, current.g), rise = x.energy - current.energy - slope;
    const double least = std::isfinite(rise) && rise > 0 ? -0.5 * slope / rise : 0.25;
    radius = std::clamp(least, 0.2, 0.5) * step.norm;
    tell(record);
    rejected = true;
    trouble = x.failure;
  }
}

Minimizer::Minimizer(Functional& functional, SolverOptions options) {
  if (const auto wrong = options.validate(); !wrong.empty()) throw InputError(wrong.front());
  state_ = std::make_unique<State>(functional, std::move(options));
}

Minimizer::~Minimizer() = default;

StepReport Minimizer::run(Configuration& u, const Task& task, std::span<Observer* const> observers) {
  State& s = *state_;
  const double begin = seconds_since_start();
  s.task = task;
  s.observers = observers;
  s.work = {};
  s.phases = {};
  s.report = {};
  s.report.load_step = task.load_step;
  s.report.t = u.t;
  s.escapes = 0;
  s.shift_hint = 0;
  s.radius = s.options.initial_radius > 0 ? s.options.initial_radius : 1.0;
  s.evaluator.set_proximal(u, s.options.method == "gradient-flow" ? task.time_step : 0.0);

  s.current = {};
  if (!task.boundary || !s.predict(u)) {
    s.current.u = u;
    s.evaluator.gradient(s.current);
  }
  if (s.current.ok()) s.largest_gradient = std::max(s.largest_gradient, s.current.gradient_norm);
  if (!s.current.ok())
    s.stop(Status::failed, "The energy at the start of the load step is not defined: " + s.current.failure);
  else
    while (!s.iterate()) {
    }
  if (s.report.status == Status::not_converged) s.count_negative_eigenvalues();

  u.values.swap(s.current.u.values);
  s.current.u.values.clear();
  s.report.energy = s.current.energy;
  s.report.energies = s.current.terms;
  s.report.gradient_norm = s.current.gradient_norm;
  s.report.work = s.work;
  s.report.phases = s.phases;
  s.report.seconds = seconds_since_start() - begin;
  return s.report;
}

StepReport minimize(Functional& functional, Configuration& u, const SolverOptions& options, std::span<Observer* const> observers, int load_step) {
  Minimizer minimizer(functional, options);
  Minimizer::Task task;
  task.load_step = load_step;
  return minimizer.run(u, task, observers);
}

}  // namespace karcher
