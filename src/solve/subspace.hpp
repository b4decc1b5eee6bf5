#pragma once
/// \file
/// Subspace: an M-orthonormal basis V of a few vectors, and the subproblem  min g.s + 1/2 s.H s, |s|_M <= radius  in span V, which is small and solved exactly,
/// hard case included.

#include <span>
#include <vector>

#include "karcher/solve/dense.hpp"
#include "solve/subproblem.hpp"

namespace karcher {

class Subspace {
 public:
  /// References must outlive it. Of the input the exchange, fixed, mass and tuning are used.
  explicit Subspace(const SubproblemInput& input);

  /// Another matrix, kept by reference: the basis is empty.
  void set_matrix(const BlockMatrix& h);
  /// Another gradient, by value.
  void set_gradient(std::span<const double> g);
  const std::vector<double>& gradient() const { return g_; }

  int size() const { return static_cast<int>(basis_.size()); }
  bool empty() const { return basis_.empty(); }
  const std::vector<double>& vector(int i) const { return basis_[static_cast<std::size_t>(i)]; }
  /// Of V^T H V.
  const Spectrum& spectrum() const { return spectrum_; }

  /// Adds w (ghosts filled), made M-orthonormal to the basis. False, and nothing is added, if that leaves less than SolverTuning::smallest_rest of w.
  bool expand(std::vector<double> w);
  /// Collective. across: coordinates of a vector to which the minimiser is orthogonal; may be empty.
  DenseStep minimise(double radius, std::span<const double> across) const;
  /// Its ghosts are copies from their owners: what moves the nodes is the same to the last bit on all ranks.
  Step step_of(DenseStep dense) const;
  /// V y and H V y, with ghosts, to rounding.
  std::vector<double> combine(std::span<const double> y) const { return combine(basis_, y); }
  std::vector<double> combine_products(std::span<const double> y) const { return combine(h_basis_, y); }

 private:
  std::vector<double> combine(const std::vector<std::vector<double>>& vectors, std::span<const double> y) const;
  /// V^T w
  std::vector<double> against_basis(std::span<const double> w) const;
  /// symmetric_eigen of a matrix that all ranks have. Collective: the ranks must take the same decisions, and LAPACK may round as memory happens to lie.
  static Spectrum same_on_all_ranks(int n, std::vector<double> matrix);
  /// The upper triangle of V^T H V, column-major.
  std::vector<double> projected_matrix() const;

  const Exchange& exchange_;
  const std::vector<char>& fixed_;
  const std::vector<double>& mass_;
  const SolverTuning& tuning_;
  const BlockMatrix* h_ = nullptr;
  std::vector<double> g_;
  std::vector<std::vector<double>> basis_, h_basis_;
  std::vector<double> projected_h_, projected_g_;  ///< V^T H V in packed growing storage: entry (i, j), i <= j at j (j + 1) / 2 + i
  Spectrum spectrum_;
};

}  // namespace karcher
