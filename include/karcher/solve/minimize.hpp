#pragma once
/// \file
/// Minimisation of a Functional by the Riemannian trust-region method (Absil, Baker, Gallivan 2007; Conn, Gould, Toint 2000, chapter 7 for the subproblem).
///
/// One iteration: gradient g and Hessian H of the pullback v -> E(retract(u, v)); one factorisation; the step s that minimises the model over |s| <= radius (norm of
/// solve/norm.hpp); then, as long as it pays, corrections of the trial point with the same factorisation (simplified Newton steps: they remove
/// the membrane strain of second order that a long step of a thin structure makes, which would otherwise force short steps). Accepted if the energy falls by at
/// least 0.01 times what the model promised. Another radius costs no factorisation.

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

struct SolverTuning;

struct SolverOptions {
  std::string method =
      "trust-region";  ///< "trust-region", or "gradient-flow": one implicit Euler step of the L2 gradient flow for each load step, t is the time
  std::string subproblem = "direct";  ///< "direct": sparse L D L^T with inertia
  std::string norm = "mass";          ///< of steps, see solve/norm.hpp
  /// Stop when |g|_* <= gradient_tolerance * (largest |g|_* at the start of this or an earlier load step). Points on the way, whose residual may be far
  /// larger, do not loosen the test.
  double gradient_tolerance = 1e-8;
  double absolute_gradient_tolerance = 0;  ///< or when |g|_* <= this
  double step_tolerance = 0;               ///< or when the norm of an accepted full Newton step is <= this (0: never)
  int max_iterations = 200;                ///< trial steps, rejected ones included
  double initial_radius = 0;               ///< in the norm of steps, which is free of units; 0: 1
  int max_corrections = 20;                ///< for each trial step
  bool escape = false;                     ///< follow a direction of negative curvature when the end point is a saddle
  /// The words that there are.
  static std::vector<std::string> methods(), subproblems(), norms();
  /// Sentences that say what is wrong; empty if nothing is.
  std::vector<std::string> validate() const;
};

/// Set by a signal handler: the solver ends after the current iteration with Status::interrupted.
extern std::atomic<bool> interrupt_requested;

/// Minimises one functional again and again (load steps): keeps the matrix, the analysis of its pattern and, where they still hold, factorisations.
class Minimizer {
 public:
  /// Collective. \throws InputError with the first sentence of options.validate().
  Minimizer(Functional& functional, SolverOptions options);
  /// With other inner constants than the solver's own (for its tests).
  Minimizer(Functional& functional, SolverOptions options, const SolverTuning& tuning);
  ~Minimizer();

  struct Task {
    int load_step = 0;
    /// Configuration with the Dirichlet values to be reached (only fixed components are read); null: those of u. The way there is predicted by the linear
    /// problem, so that a prescribed displacement is not first absorbed by one row of cells.
    const Configuration* boundary = nullptr;
    double time_step = 0;           ///< gradient-flow: minimise E(u) + 1/(2 time_step) int dist(u, u_before)^2 (nodal distances, lumped mass)
    double gradient_tolerance = 0;  ///< instead of the option, if > 0
  };
  /// Minimises from `u`, which is changed in place to the best point, whatever the outcome. Set the functional's load parameter (and u.t) before. Collective.
  StepReport run(Configuration& u, const Task& task, std::span<Observer* const> observers = {});
  /// Before the first run: what comes is as if a run of this minimizer had ended in u, on one rank to the last bit. Set the functional's load parameter before.
  /// Costs a factorisation. Collective.
  /// \param largest_gradient StepReport::largest_gradient of that run
  void resume(const Configuration& u, double largest_gradient);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Minimises once. Collective over PETSC_COMM_WORLD.
StepReport minimize(Functional& functional, Configuration& u, const SolverOptions& options, std::span<Observer* const> observers, int load_step = 0);

}  // namespace karcher
