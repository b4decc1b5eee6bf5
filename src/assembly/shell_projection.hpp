#pragma once
/// \file
/// Projection interpolation of rotations for the shell kernel: Q(x) is the rotation closest to A = sum_i l_i R_i.
///
/// With Z_i = Q^T R_i, S = Q^T A, B_b = Q^T d_b A, G = tr(S) I - S: the rates are G k_b = Ax(B_b), a nodal variation R_i [v_i] turns Q by
/// G w = sum_i l_i D_i v_i with D_i = tr(Z_i) I - Z_i^T, and both are linear in the Z_i, which is what the adjoint below uses
/// (docs/cosserat-kernel.md).

#include <limits>

#include "assembly/shell_algebra.hpp"
#include "assembly/shell_fallback.hpp"
#include "karcher/assembly/shell_kernel.hpp"

namespace karcher::shell {

template <class T>
class ProjectionRule {
 public:
  /// Numbers per node and per point of a chunk.
  struct Nodes {
    Quaternion<T> q[max_nodes];
    T r[max_nodes][9], sum[max_nodes][9];
    T a[max_chunk][9];
    Quaternion<T> found[max_chunk];
    T converged[max_chunk];
  };

  ProjectionRule(Nodes& nodes, const Tables& tables, const double* q) : n_(nodes), tables_(tables) {
    for (int i = 0; i < count(); ++i) {
      for (int c = 0; c < 4; ++c) n_.q[i][c] = load<T>(q + (4 * i + c) * lanes<T>);
      const auto flip = dot(n_.q[i], n_.q[0]) < T(0.0);
      for (int c = 0; c < 4; ++c) n_.q[i][c] = select(flip, -n_.q[i][c], n_.q[i][c]);
      const Mat3<T> r = rotation_matrix(n_.q[i]);
      for (int k = 0; k < 9; ++k) n_.r[i][k] = r.e[static_cast<std::size_t>(k)];
      for (int k = 0; k < 9; ++k) n_.sum[i][k] = T(0.0);
    }
  }

  T trouble{0.0};    ///< lanes where the rotation is not defined: not 0
  Mat3<T> rotation;  ///< Q
  Vec3<T> rate[2];   ///< k_b in the body frame

  /// Finds Q at the points first .. first + size - 1, all at once, since each is a long chain of dependent operations.
  void solve(int first, int size) {
    T step[max_chunk];
    for (int p = 0; p < size; ++p) {
      const double* l = tables_.r_value.data() + (first + p) * count();
      Quaternion<T> q{};
      for (int k = 0; k < 9; ++k) n_.a[p][k] = T(0.0);
      for (int i = 0; i < count(); ++i) {
        for (int k = 0; k < 9; ++k) n_.a[p][k] += T(l[i]) * n_.r[i][k];
        for (int c = 0; c < 4; ++c) q[c] += T(l[i]) * n_.q[i][c];
      }
      n_.found[p] = q;
    }
    for (int iteration = 0; iteration < 12; ++iteration) {
      T largest(0.0);
      for (int p = 0; p < size; ++p) {
        step[p] = newton_step(n_.a[p], n_.found[p]);
        largest = max(largest, step[p]);
      }
      if (all(largest < T(converged))) break;
    }
    for (int p = 0; p < size; ++p) n_.converged[p] = step[p];
  }

  /// Goes to point number p of the chunk. \param lb  [node]: derivatives of the basis in the two principal directions
  void go_to(int p, const double* l, const T (*lb)[2]) {
    const Mat3<T> a = matrix(n_.a[p]);
    Mat3<T> a1{}, a2{};
    for (int i = 0; i < count(); ++i)
      for (int k = 0; k < 9; ++k) {
        const auto e = static_cast<std::size_t>(k);
        a1.e[e] += lb[i][0] * n_.r[i][k];
        a2.e[e] += lb[i][1] * n_.r[i][k];
      }
    auto ok = n_.converged[p] < T(converged);
    for (int attempt = 0; attempt < 2; ++attempt) {
      rotation = matrix_of(n_.found[p]);
      s_ = symmetric_part(transpose_times(rotation, a));
      const Sym3<T> g{s_.yy + s_.zz, -s_.xy, -s_.xz, s_.xx + s_.zz, -s_.yz, s_.xx + s_.yy};
      const Sym3<T> c = cofactor(g);
      const T det = g.xx * c.xx + g.xy * c.xy + g.xz * c.xz;
      inverse_ = scaled(T(1.0) / det, c);
      // G positive definite (it is 2 I where all rotations agree): then Q is the closest rotation, because tr(Q^T A) is a Rayleigh quotient of the
      // quaternion.
      ok = ok & (g.xx > T(0.0)) & (c.zz > T(1e-12)) & (det > T(1e-6) * c.zz);
      if (all(ok)) break;
      if (attempt == 0) {
        repair(p, l, ok);
        ok = T(0.0) < T(1.0);
      }
    }
    b_[0] = transpose_times(rotation, a1);
    b_[1] = transpose_times(rotation, a2);
    for (int b = 0; b < 2; ++b) rate[b] = times(inverse_, ax(b_[b]));
  }

  /// Solves the adjoint equations. \param f  principal frame \param moment  sum_b E_b x e_b and \param k  K_b, both in the frame
  void adjoint(const Mat3<T>& f, const Vec3<T>& moment, const Vec3<T> (&k)[2], const double*, const T (*)[2]) {
    n0_ = Mat3<T>{};
    Vec3<T> right = f * moment;
    T diagonal(0.0);
    for (int b = 0; b < 2; ++b) {
      mu_[b] = times(inverse_, f * k[b]);
      sk_[b] = times(s_, rate[b]);
      n0_ += outer(mu_[b], rate[b]);
      diagonal += dot(mu_[b], rate[b]);
      // Ax of mu k^T S and of [mu] B^T
      right -= cross(sk_[b], mu_[b]) + trace(b_[b]) * mu_[b] - transpose_times(b_[b], mu_[b]);
    }
    eta_ = times(inverse_, right);
    for (int i = 0; i < 3; ++i) n0_(i, i) -= diagonal;
    n0_ += hat(eta_);
  }

  /// Adds the point's share of the gradient to the nodes' sums. \param jacobian  [a][b]
  void add_gradient(const double* l, const double* dl, const T (&jacobian)[2][2]) {
    // <N_i, Z_i [v]> = v . Ax(R_i^T (Q N_i)): the product with R_i^T waits until the sum over the points is known.
    const Mat3<T> x0 = rotation * n0_, x1 = rotation * hat(jacobian[0][0] * mu_[0] + jacobian[0][1] * mu_[1]),
                  x2 = rotation * hat(jacobian[1][0] * mu_[0] + jacobian[1][1] * mu_[1]);
    for (int i = 0; i < count(); ++i)
      for (int k = 0; k < 9; ++k) {
        const auto e = static_cast<std::size_t>(k);
        n_.sum[i][k] += T(l[i]) * x0.e[e];
        n_.sum[i][k] += T(dl[2 * i]) * x1.e[e];
        n_.sum[i][k] += T(dl[2 * i + 1]) * x2.e[e];
      }
  }
  /// Gradient of node i, after all points, where add_gradient was used.
  Vec3<T> gradient(int i) const { return ax(transpose_times(matrix(n_.r[i]), matrix(n_.sum[i]))); }

  /// Prepares `node`.
  void linearize(const Mat3<T>& f, const double*, const T (*)[2], T (*)[27], T (*)[27]) {
    const Mat3<T> inverse = full(inverse_);
    fk_ = transpose_times(f, inverse);
    f_ = f;
    for (int b = 0; b < 2; ++b) {
      const Vec3<T> smu = times(s_, mu_[b]);
      // U_b = tr(B_b) I - B_b - [S k_b]
      Mat3<T> u = -b_[b] - hat(sk_[b]);
      const T t = trace(b_[b]);
      for (int i = 0; i < 3; ++i) u(i, i) += t;
      v_[b] = fk_ * (u * f);
      fkk_[b] = times_hat(fk_, rate[b]);
      fmu_[b] = transpose_times(f, mu_[b]);
      fsmu_[b] = transpose_times(f, smu);
    }
  }

  /// Block (w, w) of the second variation that does not pass through the strains, in the principal frame: sym M - tr(M) I.
  Sym3<T> value_block() const {
    Mat3<T> m = n0_ * full(s_);
    for (int b = 0; b < 2; ++b) m += hat(mu_[b]) * transpose(b_[b]);
    const Sym3<T> s = symmetric_part(m);
    const T t = s.xx + s.yy + s.zz;
    const Sym3<T> body{s.xx - t, s.xy, s.xz, s.yy - t, s.yz, s.zz - t};
    return symmetric_part(transpose_times(f_, full(body) * f_));
  }

  /// Maps of node i: `a` holds w, k_1', k_2' (3 x 3 each) per v_i, `b` holds -T_i, c_1, c_2; rows in the principal frame.
  void node(int i, const double* ls, const T (*lb)[2], T* a, T* b) {
    const T l(ls[i]);
    const Mat3<T> z = transpose_times(rotation, matrix(n_.r[i]));
    Mat3<T> n = l * n0_;
    add_hat(n, lb[i][0] * mu_[0] + lb[i][1] * mu_[1]);
    Mat3<T> p = transpose_times(z, n);
    for (int k = 0; k < 9; ++k) n_.sum[i][k] += p.e[static_cast<std::size_t>(k)];
    const T tp = trace(p);
    for (int k = 0; k < 3; ++k) p(k, k) -= tp;

    const Mat3<T> fz = transpose_times(f_, z);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) b[3 * r + c] = -(fz(r, 0) * p(c, 0)) - fz(r, 1) * p(c, 1) - fz(r, 2) * p(c, 2);

    const Vec3<T> lg = l * ax(z);
    const T tz = trace(z), ltz = l * tz;
    Mat3<T> d = -transpose(z);
    for (int k = 0; k < 3; ++k) d(k, k) += tz;
    const Mat3<T> y = fk_ * d, w = l * y;
    write(w, a);
    for (int s = 0; s < 2; ++s) {
      Mat3<T> c = outer(fmu_[s], lg);
      subtract_times_hat(c, fz, l * mu_[s]);
      add_hat_times(c, fsmu_[s], w);
      write(c, b + 9 * (s + 1));
    }
    for (int s = 0; s < 2; ++s) {
      Mat3<T> k = lb[i][s] * y;
      add_times_hat(k, w, rate[s]);
      subtract_product(k, v_[s], w);
      add_scaled(k, dot(lg, rate[s]), fk_);
      subtract_scaled(k, ltz, fkk_[s]);
      write(k, a + 9 * (s + 1));
    }
  }
  /// Gradient of node i, and sym P_i - tr(P_i) I, after all points, where `node` was used.
  Vec3<T> node_gradient(int i) const { return ax(matrix(n_.sum[i])); }
  Sym3<T> node_block(int i) const {
    const Sym3<T> s = symmetric_part(matrix(n_.sum[i]));
    const T t = s.xx + s.yy + s.zz;
    return {s.xx - t, s.xy, s.xz, s.yy - t, s.yz, s.zz - t};
  }

 private:
  // The last step before the convergence is cubic (quadratic far away), so that what remains after a step of 1e-7 is below rounding.
  static constexpr double converged = 1e-14;

  int count() const { return tables_.r_nodes; }

  /// The rotation of a quaternion of any length.
  static Mat3<T> matrix_of(const Quaternion<T>& q) {
    const T s = T(2.0) / dot(q, q), x = s * q[1], y = s * q[2], z = s * q[3];
    const T xx = q[1] * x, yy = q[2] * y, zz = q[3] * z, xy = q[1] * y, xz = q[1] * z, yz = q[2] * z, wx = q[0] * x, wy = q[0] * y, wz = q[0] * z;
    const T one(1.0);
    return {{one - (yy + zz), xy - wz, xz + wy, xy + wz, one - (xx + zz), yz - wx, xz - wy, yz + wx, one - (xx + yy)}};
  }

  /// One Newton step for the maximum of tr(Q^T A); returns the square of its angle. The quaternion need not have length one (and its length grows
  /// with every
  /// step): all is done with |q|^2 Q, and the step does not feel the factor.
  static T newton_step(const T (&a)[9], Quaternion<T>& q) {
    const T ww = q[0] * q[0], xx = q[1] * q[1], yy = q[2] * q[2], zz = q[3] * q[3];
    const T x2 = q[1] + q[1], y2 = q[2] + q[2], z2 = q[3] + q[3];
    const T xy = q[1] * y2, xz = q[1] * z2, yz = q[2] * z2, wx = q[0] * x2, wy = q[0] * y2, wz = q[0] * z2;
    const T u = ww - xx, v = yy - zz, t = ww + xx, r = yy + zz;
    const Mat3<T> rotation_times_length{{t - r, xy - wz, xz + wy, xy + wz, u + v, yz - wx, xz - wy, yz + wx, u - v}};
    const Mat3<T> s = transpose_times(rotation_times_length, matrix(a));
    const Sym3<T> g = trace_minus(s), c = cofactor(g);
    const T det = g.xx * c.xx + g.xy * c.xy + g.xz * c.xz;
    const Vec3<T> w = (T(1.0) / det) * times(c, ax(s));
    const T half(0.5);
    q = quaternion_product(q, Quaternion<T>{{T(1.0), half * w[0], half * w[1], half * w[2]}});
    return dot(w, w);
  }

  /// Second try for the lanes where Newton's method did not end in the closest rotation.
  [[gnu::noinline]] void repair(int p, const double* l, MaskOf<T> ok) {
    for (int k = 0; k < lanes<T>; ++k) {
      if (lane_of(ok, k)) continue;
      Quaternion<double> q[max_nodes], found;
      for (int i = 0; i < count(); ++i)
        for (int c = 0; c < 4; ++c) q[i][c] = lane(n_.q[i][c], k);
      if (!closest_rotation(q, l, count(), found)) set_lane(trouble, k, 1.0);
      for (int c = 0; c < 4; ++c) set_lane(n_.found[p][c], k, found[c]);
    }
  }

  Nodes& n_;
  const Tables& tables_;
  Sym3<T> s_, inverse_;  // S and G^-1
  Mat3<T> b_[2], n0_, f_, fk_, v_[2], fkk_[2];
  Vec3<T> mu_[2], eta_, sk_[2], fmu_[2], fsmu_[2];
};

}  // namespace karcher::shell
