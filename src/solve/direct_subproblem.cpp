#include "solve/direct_subproblem.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "karcher/solve/collectives.hpp"
#include "solve/seed.hpp"
#include "solve/stopwatch.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

Ldlt analyse(const SubproblemInput& input) {
  Stopwatch watch(input.phases.factorisation);
  return Ldlt(input.exchange, input.pattern, input.fixed);
}

}  // namespace

DirectSubproblem::DirectSubproblem(const SubproblemInput& input) : input_(input), ldlt_(analyse(input)), basis_(input) {}

void DirectSubproblem::set(const BlockMatrix& h, std::span<const double> g, double shift) {
  h_ = &h;
  refactor(shift);
  forget_directions();
  set_gradient(g);
}

void DirectSubproblem::forget_directions() {
  basis_.set_matrix(*h_);
  counts_ = {{shift_, inertia_.negative}};
  searched_ = has_steepest_ = false;
  seed_ = 0;
  probe_ = -1;
}

void DirectSubproblem::set_gradient(std::span<const double> g) {
  basis_.set_gradient(g);
  has_steepest_ = false;
  double square = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(input_.exchange.owned_dofs()); ++d) square += g[d] * g[d] / input_.mass[d];
  dual_norm_ = std::sqrt(sum_over_ranks(square));
}

void DirectSubproblem::refactor(double shift) {
  Stopwatch watch(input_.phases.factorisation);
  const long before = ldlt_.factorisations();
  shift_ = shift;
  inertia_ = ldlt_.factor(*h_, shift, input_.mass);
  input_.work.factorisations += ldlt_.factorisations() - before;
  counts_[shift] = inertia_.negative;
  searched_ = false;
}

void DirectSubproblem::solve(std::span<const double> b, std::span<double> x) {
  Stopwatch watch(input_.phases.solve);
  ++input_.work.solves;
  ldlt_.solve(b, x);
}

bool DirectSubproblem::expand(std::vector<double> w) {
  Stopwatch watch(input_.phases.solve);
  return basis_.expand(std::move(w));
}

Step DirectSubproblem::step(double radius, const Effort& effort) {
  const SolverTuning& tuning = input_.tuning;
  const std::vector<double>&g = basis_.gradient(), &mass = input_.mass;
  const std::span<const double> across = effort.across ? std::span<const double>(effort.across->coordinates) : std::span<const double>();
  std::vector<double> w(g.size()), r(g.size());
  if (basis_.empty()) {
    if (dual_norm_ > 0) {
      solve(g, w);
      expand(w);
    }
    // A symmetric gradient leads to symmetric directions alone.
    if (negative_in_basis() < inertia_.negative) probe();
  }
  DenseStep best;
  int expansions = 0, refactored = 0, small_gains = 0;
  bool dry = false;  // the last expansion added nothing
  for (double last = 0;; last = best.decrease) {
    best = basis_.minimise(radius, across);
    if (basis_.empty() || basis_.size() >= tuning.longest_basis) break;
    if (best.multiplier > 0 && !has_steepest_) {  // at least Cauchy's decrease
      has_steepest_ = true;
      for (std::size_t d = 0; d < w.size(); ++d) w[d] = g[d] / mass[d];
      if (expand(w)) continue;
    }
    const std::vector<double> s = basis_.combine(best.y), hs = basis_.combine_products(best.y);
    double square = 0;
    for (std::size_t d = 0; d < r.size(); ++d) r[d] = input_.fixed[d] ? 0 : g[d] + hs[d] + best.multiplier * mass[d] * s[d];
    for (std::size_t d = 0; d < static_cast<std::size_t>(input_.exchange.owned_dofs()); ++d) square += r[d] * r[d] / mass[d];
    const double residual = std::sqrt(sum_over_ranks(square));
    small_gains = expansions > 0 && best.decrease - last <= effort.accuracy * best.decrease ? small_gains + 1 : 0;

    const int missing = missing_directions(best.multiplier);
    const bool solved = residual <= tuning.smallest_residual * dual_norm_;
    if (solved && missing <= 0) break;
    const bool stuck = small_gains >= tuning.patience || solved || dry;
    if (stuck && missing <= 0 && residual <= tuning.good_residual * dual_norm_) break;
    if (stuck && missing > 0 && !searched_ && (missing <= tuning.few_directions || inertia_.negative == 0)) {
      find_negative_directions();
      small_gains = 0;
      dry = false;
      continue;
    }
    if (stuck || expansions == effort.expansions) {
      // A positive definite F tells no more when it has been searched, and larger shifts even less.
      if (refactored == effort.refactorisations || (missing > 0 && inertia_.negative == 0)) break;
      // At lambda the expansion converges fast, and directions of negative curvature that are missing are the first to appear. Where none is known, the
      // shift grows until their number falls.
      const double lowest = basis_.spectrum().values.front();
      if (missing <= 0)
        refactor(best.multiplier);
      else if (negative_in_basis() > 0)
        refactor(std::max({tuning.known_shift_growth * shift_, best.multiplier, -tuning.known_shift_growth * lowest}));
      else
        refactor(shift_ > 0 ? tuning.blind_shift_growth * shift_ : std::max(dual_norm_ / radius, tuning.blind_shift_growth * std::abs(lowest)));
      ++refactored;
      expansions = small_gains = 0;
    }
    if (solved) {
      dry = !probe();
    } else {
      solve(r, w);
      dry = !expand(w);
    }
    ++expansions;
  }
  return basis_.step_of(best);
}

Step DirectSubproblem::known_step(double radius, const Step* across) const {
  return basis_.step_of(basis_.minimise(radius, across ? std::span<const double>(across->coordinates) : std::span<const double>()));
}

std::optional<Inertia> DirectSubproblem::inertia(double shift) {
  if (shift_ != shift) refactor(shift);
  return inertia_;
}

bool DirectSubproblem::no_eigenvalue_within(double s) {
  const SolverTuning& tuning = input_.tuning;
  if (inertia(0.0)->null > 0) return false;
  const auto owned = static_cast<std::size_t>(input_.exchange.owned_dofs());
  const auto size = [&](std::span<const double> v) {
    double square = 0;
    for (std::size_t d = 0; d < owned; ++d) square += input_.mass[d] * v[d] * v[d];
    return std::sqrt(sum_over_ranks(square));
  };
  std::vector<double> v(input_.mass.size());
  for (std::size_t d = 0; d < v.size(); ++d) v[d] = input_.fixed[d] ? 0 : seed_entry(tuning.certificate_seed, input_.numbers[d]);
  // Let c be the part of the unit vector v along an eigenvector with |e| <= s: after k steps v = s H^-1 M v it is c or more. A vector without symmetry has
  // c of about 1 / sqrt(n), so that |v| < rare_part / sqrt(n) says that there is none.
  const double least = tuning.rare_part / std::sqrt(static_cast<double>(input_.exchange.global_dofs()));
  double now = size(v);
  for (double& x : v) x /= now;
  for (int k = 0; k < tuning.certificate_solves; ++k) {
    for (std::size_t d = 0; d < v.size(); ++d) v[d] *= input_.fixed[d] ? 0 : s * input_.mass[d];
    solve(v, v);
    now = size(v);
    if (!std::isfinite(now)) return false;
    if (now < least) return true;
  }
  return false;
}

double DirectSubproblem::soft_part(std::span<const double> g) {
  std::vector<double> w(g.size());
  solve(g, w);
  double square = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(input_.exchange.owned_dofs()); ++d) square += g[d] * g[d] / input_.mass[d];
  square = sum_over_ranks(square);
  return square > 0 ? shift_ * input_.exchange.dot(g, w) / square : 0.0;
}

double DirectSubproblem::next_shift(const Step& accepted, double ratio) const {
  const SolverTuning& tuning = input_.tuning;
  const double shift = ratio > tuning.trusted_ratio ? tuning.shift_fall * accepted.multiplier : accepted.multiplier;
  return negative_in_basis() < inertia_.negative ? std::max(shift, shift_) : shift;
}

int DirectSubproblem::negative_in_basis(double shift) const {
  const std::vector<double>& ritz = basis_.spectrum().values;
  return static_cast<int>(std::count_if(ritz.begin(), ritz.end(), [&](double e) { return e + shift < 0; }));
}

int DirectSubproblem::missing_directions(double lambda) const {
  const auto above = counts_.upper_bound(lambda);
  if (above == counts_.begin()) return 0;
  const auto [shift, count] = *std::prev(above);
  return count - negative_in_basis(shift);
}

void DirectSubproblem::find_negative_directions() {
  const SolverTuning& tuning = input_.tuning;
  searched_ = true;
  const int limit = std::min(tuning.probes + tuning.probes_per_direction * inertia_.negative, tuning.most_probes);
  double lowest = basis_.empty() ? 0 : std::min(0.0, basis_.spectrum().values.front());
  for (int k = 0; k < limit && basis_.size() < tuning.longest_basis; ++k) {
    probe();
    if (basis_.empty()) return;
    const double now = basis_.spectrum().values.front();
    const bool settled = now > tuning.settled * lowest;
    if (negative_in_basis() >= inertia_.negative && settled) return;
    lowest = std::min(lowest, now);
  }
}

bool DirectSubproblem::probe() {
  std::vector<double> w(basis_.gradient().size());
  for (std::size_t d = 0; d < w.size(); ++d) {
    const double from = probe_ >= 0 ? basis_.vector(probe_)[d] : seed_entry(seed_, input_.numbers[d]);
    w[d] = input_.fixed[d] ? 0 : input_.mass[d] * from;
  }
  solve(w, w);
  const bool expanded = expand(std::move(w));
  if (!expanded) ++seed_;
  probe_ = expanded ? basis_.size() - 1 : -1;
  return expanded;
}

std::vector<double> DirectSubproblem::lowest_direction() const {
  if (basis_.empty()) return std::vector<double>(basis_.gradient().size(), 0.0);
  return basis_.combine(std::span(basis_.spectrum().vectors).first(static_cast<std::size_t>(basis_.size())));
}

}  // namespace karcher
