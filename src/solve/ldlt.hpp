#pragma once
/// \file
/// Ldlt: sparse factorisation P^T (H + shift M) P = L D L^T on the free unknowns by MUMPS (Amestoy, Duff, L'Excellent, Koster 2001), with the inertia of the
/// matrix (Sylvester: the signs of D). MUMPS is called directly, not through PETSc: PETSc does not hand on an elimination order for symmetric matrices, and
/// copies the matrix once more. The contributions of the ranks are summed by MUMPS, so no rank assembles another's rows; right-hand sides and solutions are
/// distributed, so no rank holds a whole vector.

#include <memory>
#include <span>
#include <vector>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/solve/exchange.hpp"
#include "solve/inertia.hpp"

namespace karcher {

class Ldlt {
 public:
  /// Analyses the pattern once; values do not matter. fixed: one flag for each local dof; fixed rows and columns are those of the identity. Collective.
  Ldlt(const Exchange& exchange, const BlockMatrix& pattern, std::vector<char> fixed);
  ~Ldlt();
  Ldlt(const Ldlt&) = delete;
  Ldlt& operator=(const Ldlt&) = delete;

  /// H + shift * diag(mass), mass by local dof (owned entries are used). \throws Error if MUMPS gives up (memory). Collective.
  Inertia factor(const BlockMatrix& h, double shift, std::span<const double> mass);
  /// Factorisations so far, those included that had to be done again with more memory.
  long factorisations() const;
  /// x = (P L D L^T P^T)^-1 b for `count` vectors of local dofs, one after the other in b and x, which may be the same. The owned entries of b are read; ghosts of
  /// x are filled, fixed entries are 0. Several at once read the factor once. Collective.
  void solve(std::span<const double> b, std::span<double> x, int count = 1);

 private:
  struct Mumps;
  const Exchange& exchange_;
  std::vector<char> fixed_;
  std::unique_ptr<Mumps> mumps_;
};

}  // namespace karcher
