#pragma once
/// \file
/// DirectSubproblem: the subproblem solved for any number of radii with as few factorisations as possible.
///
/// The solution is (H + lambda M) s = -g with H + lambda M positive semidefinite (More, Sorensen 1983). Factorisations are what a step costs, solves are cheap,
/// so lambda is not searched by refactoring: from one factorisation F = H + shift M, indefinite or not, we build an M-orthonormal basis V of F^-1 g and of
/// F^-1 r, r the residual of the best step in span V so far (a rational Krylov space, Davidson's expansion). In span V the problem is small and solved exactly,
/// hard case included. Span V soon holds the low eigenvectors, also those of negative eigenvalues: where the inertia of F counts more of them than V has, inverse
/// iteration from fixed vectors without symmetry adds the missing ones. Only if the basis grows long, F is made anew at the current lambda, which then converges like
/// More and Sorensen's iteration, or faster. A smaller or larger radius needs the same basis, and mostly no solve at all.

#include <map>
#include <span>
#include <vector>

#include "solve/ldlt.hpp"
#include "solve/subproblem.hpp"
#include "solve/subspace.hpp"

namespace karcher {

class DirectSubproblem : public Subproblem {
 public:
  /// Analyses the pattern.
  explicit DirectSubproblem(const SubproblemInput& input);

  /// Factorises h + shift M.
  void set(const BlockMatrix& h, std::span<const double> g, double shift) override;
  void set_gradient(std::span<const double> g) override;
  void forget_directions() override;
  Step step(double radius, const Effort& effort) override;
  Step known_step(double radius, const Step* across = nullptr) const override;
  std::optional<Inertia> inertia(double shift) override;
  /// By inverse iteration from a vector without symmetry, which leaves the basis as it is.
  bool no_eigenvalue_within(double s) override;
  double soft_part(std::span<const double> g) override;
  /// Ends when the basis holds all negative directions that the inertia counts and the lowest Ritz value changes by less than a tenth.
  void find_negative_directions() override;
  std::vector<double> ritz_values() const override { return basis_.spectrum().values; }
  std::vector<double> lowest_direction() const override;
  double next_shift(const Step& accepted, double ratio) const override;

  /// Number of negative eigenvalues of the matrix that is factorised at present which are known to be in the basis.
  int negative_in_basis() const { return negative_in_basis(shift_); }

 private:
  void refactor(double shift);
  int negative_in_basis(double shift) const;
  /// Negative eigenvalues of H + lambda M that are not in the basis, as far as the factorisation at the largest shift <= lambda tells.
  int missing_directions(double lambda) const;
  bool expand(std::vector<double> w);
  /// One step of inverse iteration (Lanczos) from a seed; if it adds nothing (false), the next call begins with another seed.
  bool probe();
  void solve(std::span<const double> b, std::span<double> x);

  SubproblemInput input_;
  Ldlt ldlt_;
  Subspace basis_;
  const BlockMatrix* h_ = nullptr;
  double shift_ = 0, dual_norm_ = 0;
  Inertia inertia_;               ///< of H + shift_ M
  std::map<double, int> counts_;  ///< negative eigenvalues of H + shift M by shift
  bool has_steepest_ = false;
  bool searched_ = false;  ///< for negative directions that g does not lead to, with this factorisation
  int seed_ = 0;           ///< of the current inverse iteration
  int probe_ = -1;         ///< vector of the basis that its last step made; -1: none
};

}  // namespace karcher
