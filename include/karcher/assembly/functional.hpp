#pragma once
/// \file
/// Functional: the sum of all terms of a problem on this rank's cells, its gradient and its Hessian in the local dofs of a Layout.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/assembly/term.hpp"
#include "karcher/field/layout.hpp"

namespace karcher {

struct EvaluationFailure {
  Trouble trouble = Trouble::none;
  int index = 0;         ///< of the term
  std::string term;      ///< its name
  Vec3<double> place{};  ///< centre of the cell
  std::string sentence() const;
};

struct Evaluation {
  double energy = 0;  ///< sum of terms; +infinity after a failure
  std::vector<double> terms;
  std::optional<EvaluationFailure> failure;
};

class Functional {
 public:
  /// The terms must hold this rank's cells only (see Layout::cell_rank).
  Functional(std::shared_ptr<const Layout> layout, std::vector<std::unique_ptr<Term>> terms);

  const Layout& layout() const { return *layout_; }
  const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }
  void set_load_parameter(double t);

  /// Local sums (no communication). The gradient has local_dofs() entries: contributions of this rank's cells to owned and ghost dofs; fixed dofs are included.
  Evaluation energy(const Configuration& u) const;
  Evaluation gradient(const Configuration& u, std::span<double> g) const;
  /// h must come from make_matrix(); it is zeroed first. Rows of fixed dofs are not treated here.
  Evaluation hessian(const Configuration& u, std::span<double> g, BlockMatrix& h) const;
  /// Zero matrix with the sparsity of this functional.
  BlockMatrix make_matrix() const;

 private:
  struct Scatter;  // per term and batch: where the blocks go
  Evaluation sum(const Configuration& u, Want want, std::span<double> g, BlockMatrix* h) const;
  EvaluationFailure failure(Trouble trouble, std::size_t term, int cell) const;
  EvaluationFailure find_not_finite(const Configuration& u, Want want) const;

  std::shared_ptr<const Layout> layout_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::vector<std::shared_ptr<Scatter>> scatter_;
  std::vector<int> row_begin_, column_;
};

}  // namespace karcher
