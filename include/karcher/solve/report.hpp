#pragma once
/// \file
/// What a solver tells: one record per iteration, one report per load step. Observers receive them while the solver runs.

#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace karcher {

struct Configuration;

enum class Status { converged, not_converged, interrupted, failed };
std::string_view name(Status s);  ///< "converged", "not-converged", "interrupted", "failed"

/// One trial step, accepted or not.
struct IterationRecord {
  int load_step = 0, iteration = 0;
  double energy = 0, gradient_norm = 0;  ///< at the accepted point after this iteration; the norm is |g|_* of solve/norm.hpp
  double step_norm = 0, radius = 0, shift = 0, ratio = 0;
  bool accepted = false;
  double seconds = 0;  ///< since the start of the run
  std::string note;    ///< why a step was rejected, when there is more to say than its ratio: the cell where an evaluation failed
};

/// The cost of a run, in what it did. A solve costs about a twentieth of a factorisation, a gradient or an energy much less.
struct WorkCounts {
  long factorisations = 0, hessians = 0, gradients = 0, energies = 0, solves = 0;
  WorkCounts& operator+=(const WorkCounts& other);
};

struct PhaseSeconds {
  double assembly = 0, factorisation = 0, solve = 0;
  PhaseSeconds& operator+=(const PhaseSeconds& other);
};

struct StepReport {
  int load_step = 0;  ///< from 1 in a sequence of load steps
  double t = 0;
  Status status = Status::failed;
  std::string reason;                 ///< one sentence: which test ended it, its value and threshold; whether it is a local minimum
  std::vector<std::string> warnings;  ///< sentences about what makes the result doubtful
  int iterations = 0;
  double energy = 0;
  std::vector<double> energies;  ///< one per term of the functional
  double gradient_norm = 0;
  double largest_gradient =
      0;  ///< |g|_* at the start of this or an earlier load step, the largest: what SolverOptions::gradient_tolerance is relative to
  double next_increment = 0;      ///< of t, that adaptive load steps try next; 0: they end here, or are not adaptive
  int negative_eigenvalues = -1;  ///< of the true Hessian on the free unknowns; -1 unknown
  int neutral_eigenvalues = 0;    ///< zero to rounding
  WorkCounts work;
  PhaseSeconds phases;
  double seconds = 0;
};

/// "energy 6.963591204935, converged after 3 iterations: <reason>"
std::ostream& operator<<(std::ostream& out, const StepReport& report);

/// Tells tables, files and pages what happens; the solver knows no file. Called on all ranks, with the same arguments.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void load_step_begins(int /*load_step*/, double /*t*/) {}
  virtual void iteration(const IterationRecord&) {}
  /// After every load step, converged or not; on several ranks u holds the nodes that this rank sees (see complete() in solve/exchange.hpp).
  virtual void load_step_finished(const StepReport&, const Configuration& /*u*/) {}
};

}  // namespace karcher
