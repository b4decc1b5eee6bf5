#pragma once
/// \file
/// Geodesic interpolation of rotations for the shell kernel: Q(x) is the weighted Riemannian mean, sum_i l_i theta_i = 0 with theta_i = log(Q^T R_i).
///
/// With tau = |theta|^2, D = I + 1/2 [theta] + beta(tau) [theta]^2 and G = sum_i l_i D_i: a nodal variation R_i [v_i] and a turn Q [w] change theta_i
/// by
/// D_i v_i - D_i^T w, the rates are G k_b = sum_i l_{i,b} theta_i. The adjoint is that of docs/cosserat-kernel.md, section 4.

#include "assembly/shell_algebra.hpp"
#include "assembly/shell_fallback.hpp"
#include "assembly/shell_series.hpp"
#include "karcher/assembly/shell_kernel.hpp"

namespace karcher::shell {

template <class T>
class GeodesicRule {
 public:
  /// Numbers per node and per point of a chunk.
  struct Nodes {
    Quaternion<T> q[max_nodes];
    Vec3<T> theta[max_nodes], phi[max_nodes], gradient[max_nodes];
    std::array<T, 3> beta[max_nodes];
    Sym3<T> block[max_nodes];
    Quaternion<T> found[max_chunk];
    T accuracy[max_chunk];
  };

  GeodesicRule(Nodes& nodes, const Tables& tables, const double* q) : n_(nodes), tables_(tables) {
    Quaternion<T> middle{};
    for (int i = 0; i < count(); ++i) {
      for (int c = 0; c < 4; ++c) n_.q[i][c] = load<T>(q + (4 * i + c) * lanes<T>);
      const auto flip = dot(n_.q[i], n_.q[0]) < T(0.0);
      for (int c = 0; c < 4; ++c) {
        n_.q[i][c] = select(flip, -n_.q[i][c], n_.q[i][c]);
        middle[c] += n_.q[i][c];
      }
      n_.gradient[i] = Vec3<T>{};
      n_.block[i] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    }
    // All rotations within 73 degrees of their plain mean: no need to look closer.
    T smallest(1.0);
    const T length2 = dot(middle, middle);
    for (int i = 0; i < count(); ++i) {
      const T cosine = dot(middle, n_.q[i]);
      smallest = min(smallest, select(cosine > T(0.0), cosine * cosine - T(0.64) * length2, T(-1.0)));
    }
    const auto close = smallest > T(0.0);
    if (!all(close)) check_spread(close);
  }

  T trouble{0.0};    ///< lanes where the rotation is not defined: not 0
  Mat3<T> rotation;  ///< Q
  Vec3<T> rate[2];   ///< k_b in the body frame

  /// Finds Q at the points first .. first + size - 1, all at once.
  void solve(int first, int size) {
    T step[max_chunk], accuracy[max_chunk];
    for (int p = 0; p < size; ++p) {
      const double* l = tables_.r_value.data() + (first + p) * count();
      Quaternion<T> q{};
      for (int i = 0; i < count(); ++i)
        for (int c = 0; c < 4; ++c) q[c] += T(l[i]) * n_.q[i][c];
      const T scale = T(1.0) / sqrt(dot(q, q));
      for (int c = 0; c < 4; ++c) n_.found[p][c] = scale * q[c];
      step[p] = T(1.0);
    }
    for (int iteration = 0; iteration < 20; ++iteration) {
      T worst(0.0);
      for (int p = 0; p < size; ++p) {
        const T last = step[p];
        step[p] = newton_step(tables_.r_value.data() + (first + p) * count(), n_.found[p]);
        // Steps shrink by step/last or faster, so that what remains is below step^2/last; all three are squared.
        accuracy[p] = step[p] * step[p] / max(last, T(1e-100));
        worst = max(worst, accuracy[p]);
      }
      if (all(worst < T(converged))) break;
    }
    for (int p = 0; p < size; ++p) n_.accuracy[p] = accuracy[p];
  }

  /// Goes to point number p of the chunk. \param lb  [node]: derivatives of the basis in the two principal directions
  void go_to(int p, const double* l, const T (*lb)[2]) {
    auto ok = n_.accuracy[p] < T(converged);
    for (int attempt = 0; attempt < 2; ++attempt) {
      rotation = rotation_matrix(n_.found[p]);
      Sym3<T> g{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
      rate[0] = rate[1] = Vec3<T>{};
      for (int i = 0; i < count(); ++i) {
        const Vec3<T> t = logarithm(quaternion_product(conjugate(n_.found[p]), n_.q[i]));
        n_.theta[i] = t;
        const T tau = dot(t, t);
        n_.beta[i] = beta_jet(tau);
        add_symmetric_part(g, T(l[i]), t, tau, n_.beta[i][0]);
        for (int b = 0; b < 2; ++b) rate[b] += lb[i][b] * t;
      }
      const Sym3<T> c = cofactor(g);
      const T det = g.xx * c.xx + g.xy * c.xy + g.xz * c.xz;
      inverse_ = scaled(T(1.0) / det, c);
      ok = ok & (g.xx > T(0.0)) & (c.zz > T(1e-12)) & (det > T(1e-6) * c.zz);  // G is I where all rotations agree
      if (all(ok)) break;
      if (attempt == 0) {
        repair(p, l, ok);
        ok = T(0.0) < T(1.0);
      }
    }
    for (int b = 0; b < 2; ++b) rate[b] = times(inverse_, rate[b]);
  }

  /// Solves the adjoint equations. \param f  principal frame \param moment  sum_b E_b x e_b and \param k  K_b, both in the frame
  void adjoint(const Mat3<T>& f, const Vec3<T>& moment, const Vec3<T> (&k)[2], const double* l, const T (*lb)[2]) {
    Mat3<T> outer_product{};
    turn_ = Vec3<T>{};
    for (int b = 0; b < 2; ++b) {
      mu_[b] = times(inverse_, f * k[b]);
      outer_product += outer(mu_[b], rate[b]);
      turn_ += T(0.5) * cross(rate[b], mu_[b]);
    }
    sg_ = symmetric_part(outer_product);
    const T work = sg_.xx + sg_.yy + sg_.zz;
    sg_.xx -= work;
    sg_.yy -= work;
    sg_.zz -= work;
    Vec3<T> right = f * moment;
    for (int i = 0; i < count(); ++i) {
      const Vec3<T>& t = n_.theta[i];
      const Vec3<T> y = T(2.0) * times(sg_, t);
      const T psi = T(0.5) * dot(t, y), factor = T(2.0) * n_.beta[i][1] * psi;
      n_.phi[i] = lb[i][0] * mu_[0] + lb[i][1] * mu_[1] + T(l[i]) * (turn_ - n_.beta[i][0] * y - factor * t);
      right -= jacobian_times(i, n_.phi[i]);
    }
    const Vec3<T> eta = times(inverse_, right);
    for (int i = 0; i < count(); ++i) n_.phi[i] += T(l[i]) * eta;
  }

  /// Adds the point's share of the gradient to the nodes' sums.
  void add_gradient(const double*, const double*, const T (&)[2][2]) {
    for (int i = 0; i < count(); ++i) n_.gradient[i] += transposed_jacobian_times(i, n_.phi[i]);
  }
  /// Gradient of node i after all points.
  Vec3<T> gradient(int i) const { return n_.gradient[i]; }

  /// Prepares `node`: writes the parts of the maps that do not need the sums over the nodes, and forms these sums.
  void linearize(const Mat3<T>& f, const double* ls, const T (*lb)[2], T (*a)[27], T (*b)[27]) {
    const Mat3<T> fk = transpose_times(f, full(inverse_));
    Mat3<T> u[2] = {}, v[2] = {}, ww{};
    for (int i = 0; i < count(); ++i) {
      const T l(ls[i]), l2 = T(2.0) * l;
      const Vec3<T>& t = n_.theta[i];
      const T tau = dot(t, t), b0 = n_.beta[i][0], b1 = n_.beta[i][1], b2 = n_.beta[i][2];
      const Mat3<T> d = jacobian(i), dt = transpose(d);
      write(l * (fk * d), a[i]);
      // B(x) = beta ((theta.x) I + theta x^T - 2 x theta^T) + 2 beta' ((theta.x) theta - tau x) theta^T
      const auto bracket = [&](const Vec3<T>& x) {
        const T tx = dot(t, x), s = b0 * tx;
        const Vec3<T> z = (T(2.0) * b1 * tx) * t - (T(2.0) * (b0 + b1 * tau)) * x;
        Mat3<T> m = outer(b0 * t, x) + outer(z, t);
        for (int k = 0; k < 3; ++k) m(k, k) += s;
        return m;
      };
      for (int s = 0; s < 2; ++s) {
        // E(k) = B(k) + 1/2 [k], E~(mu) = B(mu) - 1/2 [mu]
        Mat3<T> y = (-l) * (bracket(rate[s]) + hat(T(0.5) * rate[s]));
        for (int k = 0; k < 3; ++k) y(k, k) += lb[i][s];
        const Mat3<T> c = (-l) * (bracket(mu_[s]) - hat(T(0.5) * mu_[s]));
        u[s] += y * dt;
        v[s] -= c * dt;
        write(fk * (y * d), a[i] + 9 * (s + 1));
        write(transpose_times(f, c * d), b[i] + 9 * (s + 1));
      }
      const Vec3<T> y = times(sg_, t);  // half of the y of adjoint
      const T psi = dot(t, y);
      const Mat3<T> yt = outer((T(2.0) * l2 * b1) * y, t);
      Mat3<T> h = -(yt + transpose(yt)) - outer((T(4.0) * l * b2 * psi) * t, t);
      const T s = l2 * b0, identity_part = l2 * b1 * psi;
      h(0, 0) -= s * sg_.xx + identity_part;
      h(0, 1) -= s * sg_.xy;
      h(0, 2) -= s * sg_.xz;
      h(1, 0) -= s * sg_.xy;
      h(1, 1) -= s * sg_.yy + identity_part;
      h(1, 2) -= s * sg_.yz;
      h(2, 0) -= s * sg_.xz;
      h(2, 1) -= s * sg_.yz;
      h(2, 2) -= s * sg_.zz + identity_part;

      const Mat3<T> bp = bracket(n_.phi[i]), half = hat(T(0.5) * n_.phi[i]), e = bp + half, et = bp - half, dh = d * h;
      ww += (dh + et) * dt;
      write(-transpose_times(f, (dh + T(0.5) * et) * d + T(0.5) * (d * transpose(e))), b[i]);
      const Sym3<T> own = symmetric_part((dt * h + e) * d);
      n_.block[i].xx += own.xx;
      n_.block[i].xy += own.xy;
      n_.block[i].xz += own.xz;
      n_.block[i].yy += own.yy;
      n_.block[i].yz += own.yz;
      n_.block[i].zz += own.zz;
      n_.gradient[i] += dt * n_.phi[i];
    }
    for (int s = 0; s < 2; ++s) {
      u_[s] = fk * (u[s] * f);
      v_[s] = transpose_times(f, v[s] * f);
    }
    value_block_ = symmetric_part(transpose_times(f, full(symmetric_part(ww)) * f));
  }

  /// Block (w, w) of the second variation that does not pass through the strains, in the principal frame.
  Sym3<T> value_block() const { return value_block_; }

  /// Maps of node i: `a` holds w, k_1', k_2' (3 x 3 each) per v_i, `b` holds -T_i, c_1, c_2; rows in the principal frame.
  void node(int, const double*, const T (*)[2], T* a, T* b) {
    const Mat3<T> w = matrix(a);
    for (int s = 0; s < 2; ++s) {
      write(matrix(a + 9 * (s + 1)) - u_[s] * w, a + 9 * (s + 1));
      write(matrix(b + 9 * (s + 1)) + v_[s] * w, b + 9 * (s + 1));
    }
  }
  Vec3<T> node_gradient(int i) const { return n_.gradient[i]; }
  Sym3<T> node_block(int i) const { return n_.block[i]; }

 private:
  static constexpr double converged = 1e-31;  // squared angle that remains

  int count() const { return tables_.r_nodes; }

  /// Rotation vector of a unit quaternion.
  static Vec3<T> logarithm(const Quaternion<T>& p) {
    const auto flip = p[0] < T(0.0);
    const T c = select(flip, -p[0], p[0]), factor = angle_over_sine(c), f = select(flip, -factor, factor);
    return {{f * p[1], f * p[2], f * p[3]}};
  }
  /// g += l (I + beta [theta]^2)
  static void add_symmetric_part(Sym3<T>& g, const T& l, const Vec3<T>& t, const T& tau, const T& beta) {
    const T lb = l * beta, diagonal = l - lb * tau;
    g.xx += diagonal + lb * t[0] * t[0];
    g.xy += lb * t[0] * t[1];
    g.xz += lb * t[0] * t[2];
    g.yy += diagonal + lb * t[1] * t[1];
    g.yz += lb * t[1] * t[2];
    g.zz += diagonal + lb * t[2] * t[2];
  }
  /// D_i = (1 - beta tau) I + beta theta theta^T + 1/2 [theta]
  Mat3<T> jacobian(int i) const {
    const Vec3<T>& t = n_.theta[i];
    const T diagonal = T(1.0) - n_.beta[i][0] * dot(t, t);
    Mat3<T> d = outer(n_.beta[i][0] * t, t) + hat(T(0.5) * t);
    for (int k = 0; k < 3; ++k) d(k, k) += diagonal;
    return d;
  }
  Vec3<T> jacobian_times(int i, const Vec3<T>& x) const {
    const Vec3<T>& t = n_.theta[i];
    const T b = n_.beta[i][0];
    return (T(1.0) - b * dot(t, t)) * x + (b * dot(t, x)) * t + T(0.5) * cross(t, x);
  }
  Vec3<T> transposed_jacobian_times(int i, const Vec3<T>& x) const {
    const Vec3<T>& t = n_.theta[i];
    const T b = n_.beta[i][0];
    return (T(1.0) - b * dot(t, t)) * x + (b * dot(t, x)) * t - T(0.5) * cross(t, x);
  }

  /// One Newton step for sum_i l_i theta_i = 0; returns the square of its angle. The first terms of beta will do: they decide the speed, not the
  /// result.
  T newton_step(const double* l, Quaternion<T>& q) const {
    Sym3<T> g{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    Vec3<T> sum{};
    for (int i = 0; i < count(); ++i) {
      const Vec3<T> t = logarithm(quaternion_product(conjugate(q), n_.q[i]));
      const T tau = dot(t, t);
      const T beta = (((T(1.0 / 47900160) * tau + T(1.0 / 1209600)) * tau + T(1.0 / 30240)) * tau + T(1.0 / 720)) * tau + T(1.0 / 12);
      add_symmetric_part(g, T(l[i]), t, tau, beta);
      sum += T(l[i]) * t;
    }
    const Sym3<T> c = cofactor(g);
    const T det = g.xx * c.xx + g.xy * c.xy + g.xz * c.xz;
    const Vec3<T> w = (T(1.0) / det) * times(c, sum);
    const T angle2 = dot(w, w), scale = T(1.0) / sqrt(T(1.0) + T(0.25) * angle2), half = T(0.5) * scale;
    q = quaternion_product(q, Quaternion<T>{{scale, half * w[0], half * w[1], half * w[2]}});
    return angle2;
  }

  void copy_lane(int k, Quaternion<double>* q) const {
    for (int i = 0; i < count(); ++i)
      for (int c = 0; c < 4; ++c) q[i][c] = lane(n_.q[i][c], k);
  }
  /// Lanes whose rotations are so far apart that their mean may not be unique.
  [[gnu::noinline]] void check_spread(MaskOf<T> close) {
    for (int k = 0; k < lanes<T>; ++k) {
      if (lane_of(close, k)) continue;
      Quaternion<double> q[max_nodes];
      copy_lane(k, q);
      if (!unique_mean(q, count())) set_lane(trouble, k, 1.0);
    }
  }
  /// Second try for the lanes where Newton's method did not arrive.
  [[gnu::noinline]] void repair(int p, const double* l, MaskOf<T> ok) {
    for (int k = 0; k < lanes<T>; ++k) {
      if (lane_of(ok, k)) continue;
      Quaternion<double> q[max_nodes], found;
      copy_lane(k, q);
      if (!riemannian_mean(q, l, count(), found)) set_lane(trouble, k, 1.0);
      for (int c = 0; c < 4; ++c) set_lane(n_.found[p][c], k, found[c]);
    }
  }

  Nodes& n_;
  const Tables& tables_;
  Sym3<T> inverse_, sg_, value_block_;  // G^-1
  Mat3<T> u_[2], v_[2];
  Vec3<T> mu_[2], turn_;
};

}  // namespace karcher::shell
