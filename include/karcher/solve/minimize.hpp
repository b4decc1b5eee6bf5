#pragma once
/// \file
/// Minimisation of a Functional by the Riemannian trust-region method (Absil, Baker, Gallivan 2007; Conn, Gould, Toint 2000, chapter 7 for the subproblem).

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

struct SolverOptions {
  std::string method = "trust-region";
  std::string subproblem = "direct";
  double gradient_tolerance = 1e-8;        ///< stop when |g|_{M^-1} <= gradient_tolerance * (largest |g|_{M^-1} seen)
  double absolute_gradient_tolerance = 0;  ///< or when |g|_{M^-1} <= this
  double step_tolerance = 0;               ///< or when the step norm |s|_M <= this
  int max_iterations = 200;
  double initial_radius = 0;  ///< in the norm |s|_M; 0: chosen from the problem
  bool escape = false;        ///< follow a direction of negative curvature when the end point is a saddle
  /// Sentences that say what is wrong; empty if nothing is.
  std::vector<std::string> validate() const;
};

/// Set by a signal handler: the solver ends after the current iteration with Status::interrupted.
extern std::atomic<bool> interrupt_requested;

/// Minimises from `u` (changed in place to the best point, whatever the outcome). Collective over PETSC_COMM_WORLD.
StepReport minimize(Functional& functional, Configuration& u, const SolverOptions& options, std::span<Observer* const> observers, int load_step = 0);

}  // namespace karcher
