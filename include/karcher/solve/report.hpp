#pragma once
/// \file
/// What a solver tells: one record per iteration, one report per load step. Observers receive them while the solver runs.

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace karcher {

enum class Status { converged, not_converged, interrupted, failed };
std::string_view name(Status s);  ///< "converged", "not-converged", "interrupted", "failed"

struct IterationRecord {
  int load_step = 0, iteration = 0;
  double energy = 0, gradient_norm = 0;  ///< at the accepted point after this iteration
  double step_norm = 0, radius = 0, shift = 0, ratio = 0;
  bool accepted = false;
  double seconds = 0;  ///< since the start of the run
};

struct WorkCounts {
  long factorisations = 0, hessians = 0, gradients = 0, energies = 0, solves = 0;
};

struct PhaseSeconds {
  double assembly = 0, factorisation = 0, solve = 0;
};

struct StepReport {
  int load_step = 0;
  double t = 0;
  Status status = Status::failed;
  std::string reason;  ///< one sentence: which test ended it, its value and threshold; whether it is a local minimum
  int iterations = 0;
  double energy = 0;
  std::vector<double> energies;  ///< one per term of the functional
  double gradient_norm = 0;
  int negative_eigenvalues = -1;  ///< of the true Hessian on the free unknowns; -1 unknown
  WorkCounts work;
  PhaseSeconds phases;
  double seconds = 0;
};

/// Tells tables, files and pages what happens; the solver knows no file.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void iteration(const IterationRecord&) {}
};

}  // namespace karcher
