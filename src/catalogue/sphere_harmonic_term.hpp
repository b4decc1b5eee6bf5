#pragma once
/// \file
/// Harmonic maps into unit spheres by the projection rule, with the Hessian in closed form.
///
/// With X = sum l_i u_i, q = X/|X|, r = 1/|X|, g_a = d_a q, s_a = r q.X_a, the energy 1/2 sum |g_a|^2 as a function of the ambient X and X_a has
///   W_X = -r sum (|g_a|^2 q + s_a g_a),   W_Xa = r g_a,   W_XaXb = delta_ab r^2 P,   W_XaX = -r^2 (2 g_a q^T + q g_a^T + s_a P),
///   W_XX = r^2 sum ((s_a^2 - |g_a|^2) P + 3 |g_a|^2 q q^T - g_a g_a^T + 3 s_a (g_a q^T + q g_a^T)),   P = I - q q^T.
/// The nodes' contributions are l_i, l_{i,a} times these. They are summed over the points as matrices of the ambient space,
///   M_ij = sigma_ij P + l_j V_i + l_i V_j^T,   sigma_ij = sum t_ia t_ja - r^2 l_i l_j sum |g_a|^2,   t_ia = r (l_{i,a} - l_i s_a),
/// and taken into the frames of the nodes once per cell: H_ij = E_i^T M_ij E_j, less <u_i, dW/du_i> on the diagonal, since u_i(v) = u_i + E_i v - |v|^2/2 u_i.

#include "karcher/assembly/density_term.hpp"
#include "karcher/energy/harmonic.hpp"
#include "karcher/interpolation/sphere_projection.hpp"

namespace karcher::catalogue {

template <class M, int D>
class SphereHarmonicTerm : public DensityTerm<VaryingDensity<Harmonic>, D, SphereProjection<M, D, NativeScalar>> {
  using T = NativeScalar;
  using Base = DensityTerm<VaryingDensity<Harmonic>, D, SphereProjection<M, D, T>>;
  static constexpr int N = M::ambient, k = M::dim;
  using Vector = Vec<T, N>;
  using Matrix = Mat<T, N, N>;

 public:
  using Base::Base;

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    if (want != Want::hessian) return Base::evaluate(u, b, want, out);
    typename Base::States states;
    MaskOf<T> defined = this->template gather<0>(u, b, states);
    auto& state = std::get<0>(states);
    const std::size_t count = state.nodes.size();
    std::vector<T> sigma_sum(count * count, T(0.0));
    std::vector<Matrix> sum(count * count), v(count);
    std::vector<Vector> force(count);
    std::vector<std::array<T, D>> t(count);
    T energy = T(0.0);
    for (int p = 0; p < this->batches().kind(b).quadrature->size(); ++p) {
      defined = defined & this->template move_to<0>(b, p, states);
      const auto& interpolation = state.interpolation;
      const auto& weights = state.weights;
      const Vector& q = interpolation.jet().value;
      const auto& g = interpolation.jet().d;
      const T r = interpolation.inverse_length(), w = this->batches().point(b, p).weight * this->density(b, p).scale, wr = w * r, wr2 = wr * r;

      T g2 = T(0.0);
      Vector force_x, sg;
      for (std::size_t a = 0; a < D; ++a) {
        g2 += norm2(g[a]);
        sg += interpolation.stretch(a) * g[a];
      }
      energy += T(0.5) * w * g2;
      force_x = -wr * (g2 * q + sg);
      // half of W_XX without P, and -(2 g_a q^T + q g_a^T), without P, too
      Matrix half;
      std::array<Matrix, D> mixed;
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) {
          T x = T(1.5) * (g2 * q[i] * q[j] + sg[i] * q[j] + q[i] * sg[j]);
          for (std::size_t a = 0; a < D; ++a) {
            x -= T(0.5) * g[a][i] * g[a][j];
            mixed[a](i, j) = -wr2 * (T(2.0) * g[a][i] * q[j] + q[i] * g[a][j]);
          }
          half(i, j) = wr2 * x;
        }
      for (std::size_t i = 0; i < count; ++i) {
        const T l = T(weights.l[i]);
        force[i] += l * force_x;
        v[i] = l * half;
        for (std::size_t a = 0; a < D; ++a) {
          const T dl = weights.dl[i][a];
          force[i] += (wr * dl) * g[a];
          v[i] += dl * mixed[a];
          t[i][a] = dl - l * interpolation.stretch(a);
        }
      }
      const Matrix qq = outer(q, q);
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i; j < count; ++j) {
          T sigma = -(T(weights.l[i] * weights.l[j]) * g2);
          for (std::size_t a = 0; a < D; ++a) sigma += t[i][a] * t[j][a];
          sigma *= wr2;
          sigma_sum[i * count + j] += sigma;
          const T li = T(weights.l[i]), lj = T(weights.l[j]);
          Matrix& m = sum[i * count + j];
          for (int x = 0; x < N; ++x)
            for (int y = 0; y < N; ++y) m(x, y) += lj * v[i](x, y) + li * v[j](y, x) - sigma * qq(x, y);
        }
    }

    const std::size_t n = count * k;
    for (std::size_t i = 0; i < count; ++i) {
      const Mat<T, N, k>& e = state.interpolation.node_frame(i);
      const Vec<T, k> gradient = transpose_times(e, force[i]);
      for (std::size_t c = 0; c < k; ++c) store_lanes(gradient[static_cast<int>(c)], i * k + c, out.gradient);
      const T inward = dot(state.nodes[i], force[i]);
      for (std::size_t j = i; j < count; ++j) {
        Matrix m = sum[i * count + j];
        const T on_diagonal = i == j ? sigma_sum[i * count + j] - inward : sigma_sum[i * count + j];  // E_i^T E_i = I
        for (int c = 0; c < N; ++c) m(c, c) += on_diagonal;
        const Mat<T, k, k> h = transpose_times(e, m * state.interpolation.node_frame(j));
        for (std::size_t x = 0; x < k; ++x)
          for (std::size_t y = 0; y < k; ++y) store_lanes(h(static_cast<int>(x), static_cast<int>(y)), (i * k + x) * n + j * k + y, out.hessian);
      }
    }
    report_lanes(energy, defined, out);
  }
};

}  // namespace karcher::catalogue
