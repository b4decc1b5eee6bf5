#pragma once
/// \file
/// Stability: whether an end point is a minimum, by the eigenvalues of the true Hessian on the free unknowns, H x = e M x. Whether e is negative is decided by
/// mathematics, not by rounding: e < -s is negative, |e| <= s neutral, with s = SolverTuning::neutral * max |H_dd| / M_dd. The inertia of H + s M counts the negative
/// ones, that of H - s M both (Sylvester); a few solves tell whether there is any neutral one, and where there is none, the inertia of H is enough.

#include <optional>
#include <string>

#include "solve/system.hpp"

namespace karcher {

struct Stability {
  int negative = -1;    ///< eigenvalues; -1: the subproblem cannot tell
  int neutral = 0;      ///< zero to rounding; not among the negative ones
  bool loaded = false;  ///< the gradient works along neutral directions: nothing balances the load there
  /// "a local minimum", "not a local minimum: the Hessian has 2 negative eigenvalues", "... (1 eigenvalue is zero to rounding)"
  std::string kind() const;
};

/// Linearises at x. Nothing, with x.failure, if the Hessian cannot be evaluated. Collective.
std::optional<Stability> stability_at(System& system, Iterate& x);

/// Whether the Hessian where the system is linearised is positive definite beyond rounding; false where the subproblem cannot tell. Collective.
bool is_definite(System& system);

}  // namespace karcher
