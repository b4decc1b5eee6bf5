#pragma once
/// \file
/// Continuation: a sequence of load steps t in (from, to], each solved from the last converged configuration.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "karcher/solve/minimize.hpp"

namespace karcher {

struct ContinuationOptions {
  double from = 0, to = 1;
  int steps = 1;  ///< load step k = 1 .. steps solves at from + k / steps (to - from)
  bool adaptive =
      false;  ///< a step that fails is halved from the last converged configuration, one that takes few iterations is followed by a longer one
  double smallest = 1e-4;  ///< adaptive: give up when a step is shorter than this part of to - from
  std::vector<std::string> validate() const;
};

/// Writes the Dirichlet values at t into the fixed components of u. Null: they do not depend on t.
using BoundaryValues = std::function<void(double t, Configuration& u)>;

struct ContinuationReport {
  /// converged: all load steps are; else the status of the one that ended it.
  Status status = Status::failed;
  std::vector<StepReport> steps;  ///< every finished load step, a failed last one included; adaptive: retried ones are not listed
  double seconds = 0;
};

/// u: initial values in, the last load step's result out. After a failure u is the last converged configuration if a step converged, else the best point reached.
/// Collective.
ContinuationReport run_continuation(Functional& functional, Configuration& u, const BoundaryValues& boundary, const ContinuationOptions& options,
                                    const SolverOptions& solver, std::span<Observer* const> observers);

}  // namespace karcher
