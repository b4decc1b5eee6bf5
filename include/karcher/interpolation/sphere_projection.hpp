#pragma once
/// \file
/// The projection rule on unit spheres in closed form: q = X / |X| with X = sum l_i u_i.
///
/// Local coordinates in the projection (gnomonic) chart q(w) = (q + E w) / |q + E w|, where w = E^T X / (q . X) is rational in X, so that both variations are
/// short. Grohs, Hardering, Sander, Sprecher, "Projection-based finite elements for nonlinear function spaces" (SIAM J. Numer. Anal. 2019).

#include <vector>

#include "karcher/interpolation/interpolation.hpp"

namespace karcher {

/// M: a manifold whose points are the unit vectors of R^ambient (S^n, SU(2)).
template <class M, int D, class T>
class SphereProjection {
 public:
  using Manifold = M;
  using Chart = ProjectionChart;
  static constexpr int k = M::dim, N = M::ambient, L = local_dim<M, D>;

  MaskOf<T> begin_cell(const Point<M, T>* nodes, int count) {
    node_frames_.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) node_frames_[static_cast<std::size_t>(i)] = M::frame(nodes[i]);
    return T(0.0) < T(1.0);
  }

  /// Lanes where |X| is so small that the projection is not defined are false.
  MaskOf<T> evaluate(const Point<M, T>* nodes, const Weights<D, T>& weights) {
    weights_ = weights;
    Vec<T, N> x;
    std::array<Vec<T, N>, D> dx{};
    for (int i = 0; i < weights.count; ++i) {
      x += T(weights.l[i]) * nodes[i];
      for (std::size_t a = 0; a < D; ++a) dx[a] += weights.dl[i][a] * nodes[i];
    }
    const T x2 = norm2(x);
    const MaskOf<T> defined = x2 > T(1e-16);
    r_ = T(1.0) / sqrt(select(defined, x2, T(1.0)));
    jet_.value = r_ * x;
    frame_ = M::frame(jet_.value);
    for (std::size_t a = 0; a < D; ++a) {
      s_[a] = dot(jet_.value, dx[a]) * r_;
      y_[a] = r_ * transpose_times(frame_, dx[a]);
      jet_.d[a] = frame_ * y_[a];
    }
    return defined;
  }
  const FieldJet<M, D, T>& jet() const { return jet_; }
  const Mat<T, N, k>& frame() const { return frame_; }
  const Mat<T, N, k>& node_frame(std::size_t i) const { return node_frames_[i]; }
  const T& inverse_length() const { return r_; }           ///< 1 / |X|
  const T& stretch(std::size_t a) const { return s_[a]; }  ///< q . X_a / |X|
  Vec<T, L> local_coordinates() const {
    Vec<T, L> y;
    for (int a = 0; a < D; ++a)
      for (int c = 0; c < k; ++c) y[(1 + a) * k + c] = y_[static_cast<std::size_t>(a)][c];
    return y;
  }

  /// w_i = l_i B_i / |X|, k_{a,i} = ((l_{i,a} - l_i s_a) B_i - l_i k_a b_i^T) / |X| with B_i = E^T E_i, b_i = E_i^T q, s_a = q . X_a / |X|.
  void linearize(const Point<M, T>*, std::vector<Mat<T, L, k>>& maps) {
    b_.resize(static_cast<std::size_t>(weights_.count));
    B_.resize(static_cast<std::size_t>(weights_.count));
    for (int i = 0; i < weights_.count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const Mat<T, N, k>& node_frame = node_frames_[n];
      B_[n] = transpose_times(frame_, node_frame);
      b_[n] = transpose_times(node_frame, jet_.value);
      const T l = T(weights_.l[i]) * r_;
      for (int c = 0; c < k; ++c)
        for (int j = 0; j < k; ++j) {
          maps[n](c, j) = l * B_[n](c, j);
          for (std::size_t a = 0; a < D; ++a)
            maps[n](static_cast<int>(1 + a) * k + c, j) = (weights_.dl[i][a] * r_ - l * s_[a]) * B_[n](c, j) - l * y_[a][c] * b_[n][j];
        }
    }
  }

  /// Adds f . d2y/dv_i dv_j for i <= j to blocks[i * count + j]. Uses what linearize() left.
  void add_second_variation(const Point<M, T>* nodes, const Vec<T, L>& f, Mat<T, k, k>* blocks) {
    const auto count = static_cast<std::size_t>(weights_.count);
    Vec<T, k> f0;
    std::array<Vec<T, k>, D> fa;
    for (int c = 0; c < k; ++c) {
      f0[c] = f[c];
      for (std::size_t a = 0; a < D; ++a) fa[a][c] = f[static_cast<int>(1 + a) * k + c];
    }
    // X'' = -sum l_i |v_i|^2 u_i:  on the diagonal, the first-order formulas with u_i in place of E_i v_i.
    // Products of first variations: P_i (l_j b_j)^T + sum_a Q_{a,i} (l_{j,a} b_j)^T and their transposes.
    T fk = T(0.0);
    for (std::size_t a = 0; a < D; ++a) fk += dot(fa[a], y_[a]);
    p_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const T l = T(weights_.l[i]) * r_;
      const Vec<T, k> u = transpose_times(frame_, nodes[i]);
      T diagonal = l * dot(f0, u) - l * fk * dot(jet_.value, nodes[i]);
      Vec<T, k> p = (-l) * transpose_times(B_[i], f0) + (l * fk) * b_[i];
      for (std::size_t a = 0; a < D; ++a) {
        const T dl = weights_.dl[i][a] * r_;
        diagonal += (dl - l * s_[a]) * dot(fa[a], u);
        const Vec<T, k> g = transpose_times(B_[i], fa[a]);
        p += (T(2.0) * s_[a] * l - dl) * g;
        q_[a].resize(count);
        q_[a][i] = (-l) * g;
      }
      p_[i] = p;
      for (int c = 0; c < k; ++c) blocks[i * count + i](c, c) -= diagonal;
    }
    for (std::size_t i = 0; i < count; ++i) {
      Vec<T, k> left = p_[i];
      for (std::size_t j = i; j < count; ++j) {
        // coefficients of b_j^T on the right and of b_i on the left
        Vec<T, k> right_of_i = (T(weights_.l[j]) * r_) * left;
        Vec<T, k> left_of_j = (T(weights_.l[i]) * r_) * p_[j];
        for (std::size_t a = 0; a < D; ++a) {
          right_of_i += (weights_.dl[j][a] * r_) * q_[a][i];
          left_of_j += (weights_.dl[i][a] * r_) * q_[a][j];
        }
        Mat<T, k, k>& h = blocks[i * count + j];
        for (int c = 0; c < k; ++c)
          for (int e = 0; e < k; ++e) h(c, e) += right_of_i[c] * b_[j][e] + b_[i][c] * left_of_j[e];
      }
    }
  }

 private:
  Weights<D, T> weights_;
  FieldJet<M, D, T> jet_;
  Mat<T, N, k> frame_;
  T r_{};                         // 1 / |X|
  std::array<T, D> s_{};          // q . X_a / |X|
  std::array<Vec<T, k>, D> y_{};  // local coordinates k_a of the derivatives
  std::vector<Mat<T, N, k>> node_frames_;
  std::vector<Mat<T, k, k>> B_;
  std::vector<Vec<T, k>> b_, p_;
  std::array<std::vector<Vec<T, k>>, D> q_;
};

}  // namespace karcher
