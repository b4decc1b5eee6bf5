#pragma once
/// \file
/// Interpolation by a weighted mean that is given implicitly: sum_i l_i theta(q, p_i) = 0 in T_qM, for any manifold and any two-point tangent function theta.
///
/// theta(q, p) = log_q p is the Riemannian centre of mass, geodesic interpolation (Grohs 2013; Sander, "Geodesic finite elements of higher order", IMA J. Numer.
/// Anal. 2016); theta(q, p) = chord(q, p), the tangential part of p - q, is the projection rule. Gradient and both variations follow from the implicit
/// function theorem; derivatives of theta come from jets, so they are exact, and M needs to provide nothing but its exp and log (or chord).
///
/// In the exponential chart around q with a fixed frame E: w are the coordinates of q, k_a = d_a w, theta_i(w, v_i) = E^T theta(exp_q(E w), exp_{p_i}(E_i v_i)),
///   F0 = sum l_i theta_i = 0,   F_a = sum l_{i,a} theta_i + sum l_i (d_w theta_i) k_a = 0,   G = -sum l_i d_w theta_i.
/// The second variation is contracted with f through the Lagrangian f . y + eta . F0 + sum_a mu_a . F_a with the adjoints G^T mu_a = f_a,
/// G^T eta = f_0 + sum_a U_a^T mu_a, U_a = sum l_{j,a} d_w theta_j + sum l_j d_ww theta_j [k_a]; third derivatives of theta appear only inside it.

#include <algorithm>
#include <vector>

#include "karcher/interpolation/implicit_mean.hpp"

namespace karcher {

/// Two-point functions. `is_geodesic` says whether the mean is the Riemannian one. `Around<M, S, T>` is the moved point q(w) = exp_q(E w) over a scalar S with
/// derivatives; theta(p) and theta(p, e, v) are theta(q(w), p) and theta(q(w), exp_p(e v)) in a frame at q(w). Any smooth frame field will do, since every use is of
/// the equation sum l_i theta_i = 0 or of its derivatives: here the fixed frame E. Only derivatives at w = 0, v = 0 up to the third order in w and the second in v are
/// read.
template <class TwoPoint>
struct ByExponential {
  template <class M, class S, class T>
  class Around {
   public:
    Around(const Point<M, T>& q, const Mat<T, M::ambient, M::dim>& e, const Vec<S, M::dim>& w)
        : q0_(cast<S>(q)), e_(e), q_(M::exp(q0_, cast<S>(e) * w)) {}
    Vec<S, M::dim> theta(const Point<M, T>& p) const { return in_frame(TwoPoint::template at<M>(q_, cast<S>(p))); }
    Vec<S, M::dim> theta(const Point<M, T>& p, const Mat<T, M::ambient, M::dim>& e, const Vec<S, M::dim>& v) const {
      return in_frame(TwoPoint::template at<M>(q_, M::exp(cast<S>(p), cast<S>(e) * v)));
    }

   private:
    Vec<S, M::dim> in_frame(const Vec<S, M::ambient>& a) const {
      Vec<S, M::dim> c;
      for (int i = 0; i < M::dim; ++i) c[i] = M::inner(q0_, cast<S>(column(e_, i)), a);
      return c;
    }
    Point<M, S> q0_;
    Mat<T, M::ambient, M::dim> e_;
    Point<M, S> q_;
  };
};
struct LogFunction;
namespace mean_detail {
/// M::LogAround where a manifold has it (the same contract as Around, written by hand), else the general one.
template <class M, class S, class T>
struct LogAround {
  using type = typename ByExponential<LogFunction>::template Around<M, S, T>;
};
template <class M, class S, class T>
requires requires { typename M::template LogAround<S, T>; }
struct LogAround<M, S, T> {
  using type = typename M::template LogAround<S, T>;
};
}  // namespace mean_detail
struct LogFunction : ByExponential<LogFunction> {
  static constexpr bool is_geodesic = true;
  template <class M, class S, class T>
  using Around = typename mean_detail::LogAround<M, S, T>::type;
  template <class M, class T>
  static Vec<T, M::ambient> at(const Point<M, T>& q, const Point<M, T>& p) {
    return M::log(q, p);
  }
};
struct ChordFunction : ByExponential<ChordFunction> {
  static constexpr bool is_geodesic = false;
  template <class M, class T>
  static Vec<T, M::ambient> at(const Point<M, T>& q, const Point<M, T>& p) {
    return M::chord(q, p);
  }
};

template <class M, class TwoPoint, int D, class T>
class WeightedMean {
 public:
  using Manifold = M;
  using Chart = ExponentialChart;
  static constexpr int k = M::dim, N = M::ambient, L = local_dim<M, D>;

  /// Once per cell, before evaluate(): starts the iterations and tests that the nodal values are close enough for a unique mean. Lanes where they are not are
  /// false. Geodesic rule: all values must lie in the ball of half the injectivity radius around their plain mean; two values need only be closer than the
  /// injectivity radius, which is the same.
  MaskOf<T> begin_cell(const Point<M, T>* nodes, int count) {
    start_ = nodes[0];
    const std::vector<double> equal(static_cast<std::size_t>(count), 1.0 / count);
    MaskOf<T> ok = find(nodes, count, equal.data(), start_);
    if constexpr (TwoPoint::is_geodesic) ok = ok & implicit_mean::close_to<M>(start_, nodes, count);
    return ok;
  }

  /// Value and derivatives. False in lanes where the iteration does not arrive at a minimiser (G positive definite) within the injectivity radius of all values.
  MaskOf<T> evaluate(const Point<M, T>* nodes, const Weights<D, T>& weights) {
    weights_ = weights;
    q_ = start_;
    MaskOf<T> ok = find(nodes, weights.count, weights.l, q_);
    jet_.value = q_;
    frame_ = M::frame(q_);
    if constexpr (D > 0) {
      Mat<T, k, D> right;
      Mat<T, k, k> g;
      const auto q = around();
      for (int i = 0; i < weights.count; ++i) {
        const auto theta = q.theta(nodes[i]);
        for (int c = 0; c < k; ++c) {
          for (int e = 0; e < k; ++e) g(c, e) -= T(weights.l[i]) * theta[c].d[static_cast<std::size_t>(e)];
          for (int a = 0; a < D; ++a) right(c, a) += weights.dl[i][static_cast<std::size_t>(a)] * theta[c].v;
        }
      }
      ok = ok & solve_in_place(g, right);
      for (int a = 0; a < D; ++a) {
        k_[static_cast<std::size_t>(a)] = column(right, a);
        jet_.d[static_cast<std::size_t>(a)] = frame_ * k_[static_cast<std::size_t>(a)];
      }
    }
    return ok;
  }
  const FieldJet<M, D, T>& jet() const { return jet_; }
  const Mat<T, N, k>& frame() const { return frame_; }
  Vec<T, L> local_coordinates() const {
    Vec<T, L> y;
    for (int a = 0; a < D; ++a)
      for (int c = 0; c < k; ++c) y[(1 + a) * k + c] = k_[static_cast<std::size_t>(a)][c];
    return y;
  }

  void linearize(const Point<M, T>* nodes, std::vector<Mat<T, L, k>>& maps);
  void add_second_variation(const Point<M, T>* nodes, const Vec<T, L>& f, Mat<T, k, k>* blocks);

 private:
  using J = Jet<T, 2 * k>;  // variables (w, v_i)

  template <class S>
  using Around = typename TwoPoint::template Around<M, S, T>;

  /// The moved point whose derivatives in w are the derivatives of theta (first order).
  auto around() const {
    using U = Dual<T, k>;
    Vec<U, k> w;
    for (int i = 0; i < k; ++i) w[i].d[static_cast<std::size_t>(i)] = T(1.0);
    return Around<U>(q_, frame_, w);
  }
  /// Newton's method for F0 = 0, from q.
  MaskOf<T> find(const Point<M, T>* nodes, int count, const double* l, Point<M, T>& q);

  Weights<D, T> weights_;
  Point<M, T> start_, q_;
  FieldJet<M, D, T> jet_;
  Mat<T, N, k> frame_;
  std::array<Vec<T, k>, D> k_{};
  Mat<T, k, k> inverse_;                                    // of G
  std::array<Mat<T, k, k>, D> u_{};                         // U_a
  std::vector<std::array<Mat<T, k, k>, 1 + D>> variation_;  // w_i, k_{a,i}
};

// ---------------------------------------------------------------------------------------------------------------------------------------------------

template <class M, class TwoPoint, int D, class T>
MaskOf<T> WeightedMean<M, TwoPoint, D, T>::find(const Point<M, T>* nodes, int count, const double* l, Point<M, T>& q) {
  constexpr int max_iterations = 40;
  MaskOf<T> done = T(1.0) < T(0.0);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    q_ = q;
    frame_ = M::frame(q);
    Mat<T, k, k> g;
    Mat<T, k, 1> residual;
    const auto moved = around();
    for (int i = 0; i < count; ++i) {
      if (l[i] == 0) continue;
      const auto theta = moved.theta(nodes[i]);
      for (int c = 0; c < k; ++c) {
        residual(c, 0) += T(l[i]) * theta[c].v;
        for (int e = 0; e < k; ++e) g(c, e) -= T(l[i]) * theta[c].d[static_cast<std::size_t>(e)];
      }
    }
    q = M::exp(q, frame_ * implicit_mean::newton_step(g, residual, 1e-18, done));
    if (all(done)) break;
  }
  return done;
}

template <class M, class TwoPoint, int D, class T>
void WeightedMean<M, TwoPoint, D, T>::linearize(const Point<M, T>* nodes, std::vector<Mat<T, L, k>>& maps) {
  const auto count = static_cast<std::size_t>(weights_.count);
  variation_.resize(count);
  Vec<J, k> w;
  for (int i = 0; i < k; ++i) w[i] = J::variable(T(0.0), i);
  const Around<J> q(q_, frame_, w);

  Mat<T, k, k> g;
  for (auto& u : u_) u = {};
  for (std::size_t i = 0; i < count; ++i) {
    const T l = T(weights_.l[i]);
    Vec<J, k> v;
    for (int c = 0; c < k; ++c) v[c] = J::variable(T(0.0), k + c);
    const auto theta = q.theta(nodes[i], M::frame(nodes[i]), v);
    for (int c = 0; c < k; ++c)
      for (int e = 0; e < k; ++e) {
        g(c, e) -= l * theta[c].gradient(e);
        variation_[i][0](c, e) = l * theta[c].gradient(k + e);
        for (std::size_t a = 0; a < D; ++a) {
          T ww = T(0.0), vw = T(0.0);
          for (int m = 0; m < k; ++m) {
            ww += theta[c].hessian(m, e) * k_[a][m];
            vw += theta[c].hessian(m, k + e) * k_[a][m];
          }
          u_[a](c, e) += weights_.dl[i][a] * theta[c].gradient(e) + l * ww;
          variation_[i][1 + a](c, e) = weights_.dl[i][a] * theta[c].gradient(k + e) + l * vw;
        }
      }
  }
  inverse_ = identity<T, k>();
  solve_in_place(g, inverse_);
  implicit_mean::solve_variations(inverse_, u_, variation_, maps);
}

template <class M, class TwoPoint, int D, class T>
void WeightedMean<M, TwoPoint, D, T>::add_second_variation(const Point<M, T>* nodes, const Vec<T, L>& f, Mat<T, k, k>* blocks) {
  const auto count = static_cast<std::size_t>(weights_.count);
  // adjoints
  std::array<Vec<T, k>, D> mu;
  Vec<T, k> eta;
  for (int c = 0; c < k; ++c) eta[c] = f[c];
  for (std::size_t a = 0; a < D; ++a) {
    Vec<T, k> fa;
    for (int c = 0; c < k; ++c) fa[c] = f[static_cast<int>(1 + a) * k + c];
    mu[a] = transpose_times(inverse_, fa);
    eta += transpose_times(u_[a], mu[a]);
  }
  eta = transpose_times(inverse_, eta);

  // theta with the directional derivatives along k_a: Dual over jets in (w, v_i).
  using U = std::conditional_t<D == 0, J, Dual<J, D == 0 ? 1 : D>>;
  Vec<U, k> w;
  for (int c = 0; c < k; ++c) {
    if constexpr (D == 0) {
      w[c] = J::variable(T(0.0), c);
    } else {
      w[c].v = J::variable(T(0.0), c);
      for (std::size_t a = 0; a < D; ++a) w[c].d[a] = J(k_[a][c]);
    }
  }
  const Around<U> q(q_, frame_, w);

  Mat<T, k, k> sum_ww;                  // of the scalars s_i
  std::array<Mat<T, k, k>, D> sum_n{};  // N_a
  std::vector<Mat<T, k, k>> wv(count);  // s_i in (w, v_i)
  std::vector<std::array<Mat<T, k, k>, D>> c_ai(count);
  for (std::size_t i = 0; i < count; ++i) {
    const T l = T(weights_.l[i]);
    Vec<U, k> v;
    for (int c = 0; c < k; ++c) v[c] = U(J::variable(T(0.0), k + c));
    const auto theta = q.theta(nodes[i], M::frame(nodes[i]), v);

    J s;
    for (int c = 0; c < k; ++c) {
      T omega = l * eta[c];
      for (std::size_t a = 0; a < D; ++a) omega += weights_.dl[i][a] * mu[a][c];
      if constexpr (D == 0) {
        J term = theta[c];
        s += term.scale(omega);
      } else {
        J term = theta[c].v;
        s += term.scale(omega);
        for (std::size_t a = 0; a < D; ++a) {
          J derivative = theta[c].d[a];
          s += derivative.scale(l * mu[a][c]);
        }
      }
    }
    for (std::size_t a = 0; a < D; ++a) c_ai[i][a] = {};
    for (int c = 0; c < k; ++c)
      for (int e = 0; e < k; ++e) {
        sum_ww(c, e) += s.hessian(c, e);
        wv[i](c, e) = s.hessian(c, k + e);
        blocks[i * count + i](c, e) += s.hessian(k + c, k + e);
        if constexpr (D > 0) {
          for (std::size_t a = 0; a < D; ++a) {
            T ww = T(0.0), mixed = T(0.0);
            for (int m = 0; m < k; ++m) {
              ww += mu[a][m] * theta[m].v.hessian(c, e);
              mixed += mu[a][m] * theta[m].v.hessian(c, k + e);
            }
            sum_n[a](c, e) += l * ww;
            c_ai[i][a](c, e) = l * mixed;
          }
        }
      }
  }
  implicit_mean::add_products(sum_ww, sum_n, variation_, wv, c_ai, blocks);
}

}  // namespace karcher
