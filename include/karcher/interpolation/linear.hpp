#pragma once
/// \file
/// Lagrange interpolation in R^n, in the form that interpolation.hpp asks of every rule. A_i is constant and the second variation vanishes.

#include <vector>

#include "karcher/interpolation/interpolation.hpp"

namespace karcher {

template <class M, int D, class T>
class LinearInterpolation {
 public:
  using Manifold = M;
  using Chart = ExponentialChart;
  static constexpr int k = M::dim, L = local_dim<M, D>;

  MaskOf<T> begin_cell(const Point<M, T>*, int) { return T(0.0) < T(1.0); }

  MaskOf<T> evaluate(const Point<M, T>* nodes, const Weights<D, T>& weights) {
    weights_ = weights;
    jet_ = {};
    for (int i = 0; i < weights.count; ++i) {
      jet_.value += T(weights.l[i]) * nodes[i];
      for (std::size_t a = 0; a < D; ++a) jet_.d[a] += weights.dl[i][a] * nodes[i];
    }
    return T(0.0) < T(1.0);
  }
  const FieldJet<M, D, T>& jet() const { return jet_; }
  Mat<T, M::ambient, k> frame() const { return identity<T, k>(); }
  Vec<T, L> local_coordinates() const {
    Vec<T, L> y;
    for (int a = 0; a < D; ++a)
      for (int c = 0; c < k; ++c) y[(1 + a) * k + c] = jet_.d[static_cast<std::size_t>(a)][c];
    return y;
  }

  void linearize(const Point<M, T>*, std::vector<Mat<T, L, k>>& maps) const {
    for (int i = 0; i < weights_.count; ++i) {
      Mat<T, L, k>& m = maps[static_cast<std::size_t>(i)];
      m = {};
      for (int c = 0; c < k; ++c) {
        m(c, c) = T(weights_.l[i]);
        for (int a = 0; a < D; ++a) m((1 + a) * k + c, c) = weights_.dl[i][static_cast<std::size_t>(a)];
      }
    }
  }
  void add_second_variation(const Point<M, T>*, const Vec<T, L>&, Mat<T, k, k>*) const {}

 private:
  Weights<D, T> weights_;
  FieldJet<M, D, T> jet_;
};

}  // namespace karcher
