#pragma once
/// \file
/// Densities of the gradient of one field with values in R^K on a D-dimensional domain: their derivatives come from jets in its K D entries, in which it is linear, and
/// the Hessian of a cell from PairSums.

#include <array>
#include <cstddef>
#include <vector>

#include "karcher/interpolation/interpolation.hpp"
#include "karcher/math/combination.hpp"
#include "karcher/math/jet.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

/// A density with `template <class W, class S> void add_energy_of_gradient(W& w, const Mat<S, K, D>& f) const`, f_ia the derivative of component i along the direction t_a
/// (reference_point.hpp): an axis of space, or of the plane z = 0. The
/// entries are variables, S a Combination<T, K D>, and enter W as those of energy/body_strains.hpp.
template <class Density, int K, int D, class T>
concept OfGradient = requires(const Density& w, Jet<T, K * D>& sum, const Mat<Combination<T, K * D>, K, D>& f) {
  w.add_energy_of_gradient(sum, f);
};

/// W, a Jet or a Dual in the entries of f, row by row.
template <class W, int K, int D, class T, class Density>
W of_gradient(const Density& density, const Mat<T, K, D>& f) {
  using Variable = Combination<T, K * D>;
  Mat<Variable, K, D> variables;
  for (std::size_t i = 0; i < f.e.size(); ++i) variables.e[i] = Variable::variable(f.e[i], static_cast<int>(i));
  W w(0.0);
  density.add_energy_of_gradient(w, variables);
  return w;
}

/// H_ij = sum over points of g_i^T C g_j for all pairs of nodes i <= j, (g_i^T C g_j)_rc = sum_ab g_ia C_(ra)(cb) g_jb, g_i the derivatives of the basis function i. Points
/// are taken in groups that fit into the first cache, nodes i in groups whose sums stay in registers.
template <int K, int D, class T>
class PairSums {
  static constexpr std::size_t points = 3;
  static constexpr std::size_t rows = lanes<T> >= 8 ? 3 : 1;  // of the 32 or 16 registers, nine for each
  static constexpr std::size_t blocks = K * K, entries = K * D;

 public:
  /// Sums of 0 for that many nodes.
  void begin(std::size_t nodes) {
    nodes_ = nodes;
    padded_ = (nodes + rows - 1) / rows * rows;
    sums_.assign(nodes_ * padded_ * blocks, T(0.0));
    for (Point& p : group_) p.g.assign(padded_ * D, T(0.0));
  }

  /// \param g  derivatives of the basis functions  \param w  second derivatives of the density, times the weight
  void add(const std::array<T, D>* g, const Jet<T, K * D>& w) {
    Point& p = group_[filled_];
    for (std::size_t i = 0; i < nodes_; ++i) std::copy(g[i].begin(), g[i].end(), p.g.begin() + static_cast<std::ptrdiff_t>(i * D));
    for (int r = 0; r < K * D; ++r)
      for (int s = 0; s < K * D; ++s) p.c(r, s) = w.hessian(r, s);
    if (++filled_ == points) add_group();
  }

  /// store(i, j, block) for all pairs i <= j, block by rows.
  template <class Store>
  void finish(const Store& store) {
    if (filled_ > 0) add_group();
    for (std::size_t j = 0; j < nodes_; ++j)
      for (std::size_t i = 0; i <= j; ++i) store(i, j, sums_.data() + (j * padded_ + i) * blocks);
  }

 private:
  struct Point {
    std::vector<T> g;  // [node][direction]
    Mat<T, K * D, K * D> c;
  };

  void add_group() {
    std::array<std::array<T, blocks * D>, points> cg;  // sum_b C_(ra)(cb) g_jb: [a][r][c]
    for (std::size_t j = 0; j < nodes_; ++j) {
      for (std::size_t p = 0; p < filled_; ++p) {
        const T* g = group_[p].g.data() + j * D;
        for (int r = 0; r < K; ++r)
          for (int a = 0; a < D; ++a)
            for (int c = 0; c < K; ++c) {
              T sum = group_[p].c(r * D + a, c * D) * g[0];
              for (int b = 1; b < D; ++b) sum += group_[p].c(r * D + a, c * D + b) * g[b];
              cg[p][static_cast<std::size_t>((a * K + r) * K + c)] = sum;
            }
      }
      for (std::size_t i = 0; i <= j; i += rows) add_rows(cg, i, sums_.data() + (j * padded_ + i) * blocks);
    }
    filled_ = 0;
  }

  void add_rows(const std::array<std::array<T, blocks * D>, points>& cg, std::size_t i, T* to) const {
    std::array<T, rows * blocks> sum;
#pragma GCC unroll 32
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] = to[n];
    for (std::size_t p = 0; p < filled_; ++p) {
      const T* g = group_[p].g.data() + i * D;
      const T* c = cg[p].data();
#pragma GCC unroll 3
      for (std::size_t a = 0; a < D; ++a)
#pragma GCC unroll 9
        for (std::size_t n = 0; n < blocks; ++n) {
          const T x = c[a * blocks + n];
#pragma GCC unroll 3
          for (std::size_t row = 0; row < rows; ++row) sum[row * blocks + n] += g[row * D + a] * x;
        }
    }
#pragma GCC unroll 32
    for (std::size_t n = 0; n < sum.size(); ++n) to[n] = sum[n];
  }

  std::size_t nodes_ = 0, padded_ = 0, filled_ = 0;
  std::array<Point, points> group_;
  std::vector<T> sums_;  // [j][i][r][c]
};

}  // namespace karcher
