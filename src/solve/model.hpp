#pragma once
/// \file
/// TrustRegionModel: the subproblem  min g.s + 1/2 s.H s  over |s|_M <= radius, solved for any number of radii with as few factorisations as possible.
///
/// The solution is (H + lambda M) s = -g with H + lambda M positive semidefinite (More, Sorensen 1983). Factorisations are what a step costs, solves are cheap,
/// so lambda is not searched by refactoring: from one factorisation F = H + shift M, indefinite or not, we build an M-orthonormal basis V of F^-1 g and of
/// F^-1 r, r the residual of the best step in span V so far (a rational Krylov space, Davidson's expansion). In span V the problem is small and solved exactly,
/// hard case included. Span V soon holds the low eigenvectors, also those of negative eigenvalues: where the inertia of F counts more of them than V has, inverse
/// iteration from fixed vectors without symmetry adds the missing ones. Only if the basis grows long, F is made anew at the current lambda, which then converges like
/// More and Sorensen's iteration, or faster. A smaller or larger radius needs the same basis, and mostly no solve at all.

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "karcher/solve/report.hpp"
#include "solve/dense.hpp"
#include "solve/ldlt.hpp"

namespace karcher {

/// y = H x for the symmetric matrix over all ranks; x with filled ghosts, y gets them too. Rows and columns with fixed[dof] != 0 are left out
/// (pass an empty span to keep them). Collective.
void multiply(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> x, std::span<double> y);

class TrustRegionModel {
 public:
  /// All references must outlive the model. numbers: of the local dofs (solve/seed.hpp). work and phases are counted up.
  TrustRegionModel(const Exchange& exchange, Ldlt& ldlt, const std::vector<char>& fixed, const std::vector<double>& mass,
                   const std::vector<std::uint64_t>& numbers, WorkCounts& work, PhaseSeconds& phases);

  /// A new point. h is kept by reference and must not change while the model is used; g by value (fixed entries 0). Factorises at `shift`.
  void set(const BlockMatrix& h, std::span<const double> g, double shift);
  /// The same matrix, factorisation and basis with another gradient.
  void set_gradient(std::span<const double> g);
  void refactor(double shift);

  struct Step {
    std::vector<double> s;  ///< local dofs
    double multiplier = 0;  ///< lambda
    double decrease = 0;    ///< of the model, >= 0
    double norm = 0;        ///< |s|_M
    std::vector<double> y;  ///< s in the basis
  };
  struct Effort {
    double accuracy = 0.05;  ///< relative gain of the model decrease under which the basis is no longer extended
    int expansions = 10;     ///< solves with one factorisation
    int refactorisations = 2;
    std::span<const double> across{};  ///< y of an earlier step: the new one is M-orthogonal to it
  };
  Step step(double radius, const Effort& effort);
  /// The best step in the basis as it is: no solve.
  Step step_in_basis(double radius, std::span<const double> across = {}) const;

  double shift() const { return shift_; }
  /// Inertia of H + shift() M.
  const Inertia& inertia() const { return inertia_; }
  /// Number of negative eigenvalues of H + shift() M known to be in the basis.
  int negative_in_basis() const { return negative_in_basis(shift_); }
  /// Extends the basis until it holds all negative directions that the inertia counts and the lowest Ritz value changes by less than a tenth (or a bounded effort
  /// is spent).
  void find_negative_directions();
  /// Ritz values (ascending) and the vector of the lowest.
  std::vector<double> ritz_values() const { return eigen_.values; }
  std::vector<double> lowest_direction() const;

 private:
  int negative_in_basis(double shift) const;
  /// Negative eigenvalues of H + lambda M that are not in the basis, as far as the factorisation at the largest shift <= lambda tells.
  int missing_directions(double lambda) const;
  bool expand(std::vector<double> w);
  /// One step of inverse iteration (Lanczos) from a seed; if it adds nothing (false), the next call begins with another seed.
  bool probe();
  std::vector<double> projected_matrix() const;
  Step step_of(DenseStep dense) const;
  DenseStep solve_in_basis(double radius, std::span<const double> across) const;
  void solve(std::span<const double> b, std::span<double> x);
  std::vector<double> combine(const std::vector<std::vector<double>>& vectors, std::span<const double> y) const;
  std::vector<double> against_basis(std::span<const double> w) const;

  const Exchange& exchange_;
  Ldlt& ldlt_;
  const std::vector<char>& fixed_;
  const std::vector<double>& mass_;
  const std::vector<std::uint64_t>& numbers_;
  WorkCounts& work_;
  PhaseSeconds& phases_;
  const BlockMatrix* h_ = nullptr;
  std::vector<double> g_;
  double shift_ = 0, dual_norm_ = 0;
  Inertia inertia_;
  std::map<double, int> counts_;  ///< negative eigenvalues of H + shift M by shift
  std::vector<std::vector<double>> basis_, h_basis_;
  std::vector<double> projected_h_, projected_g_;  // V^T H V in packed growing storage: entry (i, j), i <= j at j (j + 1) / 2 + i
  Spectrum eigen_;                                 ///< of V^T H V
  bool has_steepest_ = false;
  bool searched_ = false;  ///< for negative directions that g does not lead to, with this factorisation
  int seed_ = 0;           ///< of the current inverse iteration
  int probe_ = -1;         ///< vector of the basis that its last step made; -1: none
};

}  // namespace karcher
