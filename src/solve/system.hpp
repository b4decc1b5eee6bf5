#pragma once
/// \file
/// System: a functional as the solver sees it on all ranks: what is fixed, the norm of steps, energy, gradient and Hessian, and the subproblem for the last matrix.

#include <memory>
#include <span>
#include <vector>

#include "karcher/solve/minimize.hpp"
#include "solve/evaluator.hpp"
#include "solve/rounding.hpp"
#include "solve/subproblem.hpp"
#include "solve/tuning.hpp"

namespace karcher {

class System {
 public:
  /// options must be valid.
  System(Functional& functional, SolverOptions options, const SolverTuning& tuning);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const Functional& functional;
  const Layout& layout;
  const SolverOptions options;
  const SolverTuning tuning;
  const Exchange exchange;
  const std::vector<char> fixed;   ///< [local dof]
  const std::vector<double> mass;  ///< [local dof], see solve/norm.hpp
  WorkCounts work;
  PhaseSeconds phases;
  Evaluator evaluator;

  /// Hessian at x and its subproblem, if they are not there already. False, with x.failure, if the Hessian could not be evaluated. shift: see Subproblem::set.
  /// Collective.
  bool linearise(Iterate& x, double shift);
  /// Of the last linearise() that was true.
  const BlockMatrix& hessian() const { return h_; }
  Subproblem& subproblem() { return *subproblem_; }

  /// Of the last linearise() that was true.
  const Rounding& rounding() const { return rounding_; }
  /// What the energies of x and of the point where it was linearised tell of the step s between them: a decrease that is not larger is lost in rounding, that of
  /// the energies or that of the gradient by which it is promised. Collective.
  double significant(const Iterate& x, std::span<const double> s) const;

  /// retract(from, step), evaluated.
  Iterate moved(const Configuration& from, std::span<const double> step);

 private:
  const std::vector<std::uint64_t> numbers_;
  BlockMatrix h_;
  Rounding rounding_;
  std::unique_ptr<Subproblem> subproblem_;
  Configuration linearised_at_;  ///< where the matrix and the subproblem belong; no values: nowhere
};

}  // namespace karcher
