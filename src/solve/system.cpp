#include "solve/system.hpp"

#include <algorithm>
#include <cmath>

#include "karcher/solve/collectives.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/seed.hpp"
#include "solve/subproblems.hpp"

namespace karcher {
namespace {

std::vector<char> fixed_flags(const Layout& layout) {
  std::vector<char> fixed(static_cast<std::size_t>(layout.local_dofs()));
  for (std::size_t d = 0; d < fixed.size(); ++d) fixed[d] = layout.fixed(static_cast<int>(d));
  return fixed;
}

}  // namespace

System::System(Functional& f, SolverOptions o, const SolverTuning& t)
    : functional(f),
      layout(f.layout()),
      options(std::move(o)),
      tuning(t),
      exchange(layout),
      fixed(fixed_flags(layout)),
      mass(step_mass(layout)),
      evaluator(f, exchange, fixed, mass, tuning.noise, work, phases),
      numbers_(seed_numbers(layout)),
      h_(f.make_matrix()) {}

bool System::linearise(Iterate& x, double shift) {
  const bool same_place = !on_any_rank(linearised_at_.values.empty() || linearised_at_.values != x.u.values);
  std::vector<double> before;
  if (same_place) before = h_.values;
  evaluator.hessian(x, h_);
  if (!x.ok()) {
    linearised_at_.values.clear();
    return false;
  }
  rounding_ = rounding_of(exchange, h_, fixed, mass, sizes_of(layout, x.u));
  // The matrix may be the same although the load has changed (dead loads): then so is the factorisation.
  if (same_place && !on_any_rank(before != h_.values)) {
    subproblem_->set_gradient(x.g);
    return true;
  }
  if (!subproblem_) {
    const auto kinds = subproblems();
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const SubproblemKind& k) { return options.subproblem == k.name; });
    subproblem_ = kind->make({exchange, h_, fixed, mass, numbers_, tuning, work, phases});
  }
  subproblem_->set(h_, x.g, shift);
  linearised_at_.values = x.u.values;
  return true;
}

double System::significant(const Iterate& x, std::span<const double> s) const {
  double square = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(exchange.owned_dofs()); ++d)
    square += rounding_.gradient[d] * s[d] * rounding_.gradient[d] * s[d];
  const double energy = x.noise / tuning.noise;
  const double squares = sum_over_ranks(square) + 4 * energy * rounding_.energy / std::max(layout.free_dofs(), 1);
  return tuning.significant * (x.noise + rounding_.energy) + tuning.uncertain * std::sqrt(squares);
}

Iterate System::moved(const Configuration& from, std::span<const double> step) {
  Iterate x;
  x.u = from;
  layout.retract(from, step, x.u);
  evaluator.gradient(x);
  return x;
}

}  // namespace karcher
