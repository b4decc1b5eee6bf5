#pragma once
/// \file
/// Stability: whether an end point is a minimum, by the eigenvalues of the true Hessian on the free unknowns.

#include <optional>
#include <string>

#include "solve/system.hpp"

namespace karcher {

struct Stability {
  int negative = -1;  ///< eigenvalues; -1: the subproblem cannot tell
  int neutral = 0;    ///< zero to rounding; not among the negative ones
  /// "a local minimum", "not a local minimum: the Hessian has 2 negative eigenvalues", "... (1 eigenvalue is zero to rounding)"
  std::string kind() const;
};

/// Linearises at x. Nothing, with x.failure, if the Hessian cannot be evaluated. Collective.
std::optional<Stability> stability_at(System& system, Iterate& x);

}  // namespace karcher
