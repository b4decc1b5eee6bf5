#pragma once
/// \file
/// Evaluator: energy, gradient and Hessian of a functional summed over the ranks, with failures that all ranks know, and the proximal term of a gradient flow.
/// What it gives without a failure is finite: the energy, every entry of the derivatives, and the norm of the gradient.

#include <span>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

/// A configuration and what is known of it.
struct Iterate {
  Configuration u;
  double energy = 0;          ///< +infinity after a failure
  std::vector<double> terms;  ///< energy of every term
  double noise = 0;           ///< energies closer than this cannot be told apart
  std::vector<double> g;      ///< local dofs, ghosts filled, fixed entries 0
  double gradient_norm = 0;   ///< |g|_*
  std::string failure;        ///< sentence; empty: none
  bool ok() const { return failure.empty(); }
};

class Evaluator {
 public:
  /// noise: see SolverTuning. All references must outlive it; work and phases are counted up.
  Evaluator(Functional& functional, const Exchange& exchange, const std::vector<char>& fixed, const std::vector<double>& mass, double noise,
            WorkCounts& work, PhaseSeconds& phases);

  /// From now on E(u) + 1/(2 tau) sum_i m_i dist(u_i, centre_i)^2, m the lumped mass of each field's space; tau = 0: E alone.
  void set_proximal(const Configuration& centre, double tau);

  /// Fills energy, terms, noise and failure of x. Collective.
  void energy(Iterate& x);
  /// Fill everything of x but x.u. Collective.
  void gradient(Iterate& x);
  void hessian(Iterate& x, BlockMatrix& h);

  /// "3.2e+155 at the node (1, 0.5, 0) of the field "m"": the entry of largest absolute value (or NaN) of a vector of local dofs over all ranks. Collective.
  std::string largest_entry(std::span<const double> v) const;

 private:
  void finish_energy(Iterate& x, const Evaluation& local, double proximal);
  void finish(Iterate& x, const Evaluation& local, double proximal);
  double proximal(const Configuration& u, std::span<double> g, BlockMatrix* h) const;

  Functional& functional_;
  const Exchange& exchange_;
  const std::vector<char>& fixed_;
  const std::vector<double>& mass_;
  const double noise_;
  WorkCounts& work_;
  PhaseSeconds& phases_;
  Configuration centre_;
  double tau_ = 0;
  std::vector<std::vector<double>> nodal_mass_;  ///< [field][node]
};

}  // namespace karcher
