#include "solve/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/solve/collectives.hpp"

namespace karcher {
namespace {

/// The largest |H_dd| / M_dd over the free unknowns of all ranks.
double stiffest(const System& system) {
  const BlockMatrix& h = system.hessian();
  const auto bs = static_cast<std::size_t>(h.block_size);
  double result = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(system.exchange.owned_dofs()); ++d)
    if (!system.fixed[d]) {
      // The diagonal block is the first of its row.
      const std::size_t at = static_cast<std::size_t>(h.row_begin[d / bs]) * bs * bs + (d % bs) * (bs + 1);
      result = std::max(result, std::abs(h.values[at]) / system.mass[d]);
    }
  return max_over_ranks(result);
}

}  // namespace

std::string Stability::kind() const {
  if (negative < 0) return "not judged: this subproblem cannot count negative eigenvalues";
  std::string kind = negative == 0 ? "a local minimum"
                                   : fmt::format("not a local minimum: the Hessian has {} negative eigenvalue{}", negative, negative == 1 ? "" : "s");
  if (neutral > 0) kind += fmt::format(" ({} eigenvalue{} zero to rounding)", neutral, neutral == 1 ? " is" : "s are");
  return kind;
}

bool is_definite(System& system) {
  const std::optional<Inertia> inertia = system.subproblem().inertia(0.0);
  return inertia && inertia->negative == 0 && system.subproblem().no_eigenvalue_within(system.tuning.neutral * stiffest(system));
}

std::optional<Stability> stability_at(System& system, Iterate& x) {
  if (!system.linearise(x, 0.0)) return {};
  Subproblem& subproblem = system.subproblem();
  const std::optional<Inertia> inertia = subproblem.inertia(0.0);
  // So that what the next load step begins with depends on this point alone, and a resumed run begins with the same.
  subproblem.forget_directions();
  if (!inertia) return Stability{};
  const double zero = system.tuning.neutral * stiffest(system);
  Stability result{inertia->negative, 0};
  if (!subproblem.no_eigenvalue_within(zero)) {
    const int not_positive = subproblem.inertia(-zero)->negative;
    result.negative = subproblem.inertia(zero)->negative;
    result.neutral = std::max(0, not_positive - result.negative);
    result.loaded = result.neutral > 0 && x.gradient_norm > system.rounding().gradient_norm && subproblem.soft_part(x.g) > system.tuning.soft_part;
  }
  if (result.negative > 0) subproblem.find_negative_directions();
  return result;
}

}  // namespace karcher
