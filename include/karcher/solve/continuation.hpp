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
  /// A step that fails is halved from the last converged configuration, one that takes few iterations is followed by a longer one.
  bool adaptive = false;
  double smallest = 1e-4;  ///< adaptive: give up when a step is shorter than this part of to - from
  std::vector<std::string> validate() const;
};

/// Where a sequence of load steps begins: anew, or after load steps of an earlier run, whose sequence it continues as if that had never ended: on one rank to the
/// last bit. The earlier run may have had other options: fixed steps go on at the first of their loads beyond t.
struct ContinuationStart {
  int load_step = 0;            ///< number of load steps finished
  double t = 0;                 ///< of the last of them
  double increment = 0;         ///< its StepReport::next_increment; 0: the longest that there is
  double largest_gradient = 0;  ///< its StepReport::largest_gradient
};

/// The number that the last load step will have; 0: not known (adaptive steps).
int last_load_step(const ContinuationOptions& options, const ContinuationStart& start);

/// Writes the Dirichlet values at t into the fixed components of u. Null: they do not depend on t.
using BoundaryValues = std::function<void(double t, Configuration& u)>;

/// Fixed components that are others in some load steps.
struct ChangingSupports {
  std::vector<double> changes;  ///< values of t after which they are others, ascending; adaptive load steps end there
  /// Fixes the components (Layout::fix) that are fixed in the load step that ends at t; whether they are others than before. Null: they never change.
  std::function<bool(double t)> hold;
};

struct ContinuationReport {
  /// converged: all load steps are; else the status of the one that ended it.
  Status status = Status::failed;
  std::vector<StepReport> steps;  ///< every finished load step, a failed last one included; adaptive: retried ones are not listed
  double seconds = 0;
};

/// Load steps are numbered from 1; the initial configuration is number 0.
/// u: initial values in (the result of start.load_step if that is not 0), the last load step's result out. After a failure u is the last converged configuration
/// if a step converged, else the best point reached. Collective.
/// \throws InputError for invalid options, and if start.t lies outside of the load range or at its end
ContinuationReport run_continuation(Functional& functional, Configuration& u, const BoundaryValues& boundary, const ContinuationOptions& options,
                                    const SolverOptions& solver, std::span<Observer* const> observers, const ContinuationStart& start = {},
                                    const ChangingSupports& supports = {});

}  // namespace karcher
