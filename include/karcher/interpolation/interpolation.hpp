#pragma once
/// \file
/// What an interpolation owes the kernels, and what both sides mean by local coordinates.
///
/// At a point of a cell, the first-order jet of a field is its value q and its derivatives d_a q in D orthonormal directions. Around the jet of the
/// accepted configuration, jets have local coordinates y = (w, k_1, ..., k_D): q(w) is a chart of the manifold around q (w in the frame E at q), and
/// k_a = d_a w. An interpolation gives
///   the jet itself,
///   A_i = dy/dv_i, the derivative with respect to the tangent coordinates v_i of node i (retraction of manifold.hpp), and
///   for a covector f on local coordinates, the contraction f . d2y/dv_i dv_j of the exact second variation;
/// a density W gives f = dW/dy and C = d2W/dy2 in the same coordinates. Then gradient_i = A_i^T f and Hessian_ij = A_i^T C A_j + contraction(f)_ij exactly.

#include <array>
#include <concepts>

#include "karcher/manifold/manifold.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

/// Value and derivatives of a field at a point, in ambient coordinates.
template <class M, int D, class T>
struct FieldJet {
  using Manifold = M;
  static constexpr int directions = D;
  Point<M, T> value;
  std::array<Vec<T, M::ambient>, static_cast<std::size_t>(D)> d{};
};

/// Number of local coordinates of a jet.
template <class M, int D>
inline constexpr int local_dim = (1 + D) * M::dim;

/// The weights of the nodes at a point: Lagrange basis values and derivatives in the D directions.
template <int D, class T>
struct Weights {
  int count = 0;
  const double* l = nullptr;                                       ///< [node]
  const std::array<T, static_cast<std::size_t>(D)>* dl = nullptr;  ///< [node][direction]
};

namespace chart_detail {
/// q and E w at the scalar U of w, for plain q and E.
template <class U, class T, int N>
Vec<U, N> constants(const Vec<T, N>& q) {
  Vec<U, N> r;
  for (int c = 0; c < N; ++c) r[c] = constant<U>(q[c]);
  return r;
}
template <class U, class T, int N, int K>
Vec<U, N> combination(const Mat<T, N, K>& e, const Vec<U, K>& w) {
  Vec<U, N> r;
  for (int c = 0; c < N; ++c) {
    r[c] = scaled(w[0], e(c, 0));
    for (int i = 1; i < K; ++i) add_scaled(r[c], w[i], e(c, i));
  }
  return r;
}
}  // namespace chart_detail

/// Charts around q with the frame e, at plain scalars T, of the point with the coordinates w at a scalar U with derivatives.
struct ExponentialChart {
  template <class M, class T, class U>
  static Point<M, U> at(const Point<M, T>& q, const Mat<T, M::ambient, M::dim>& e, const Vec<U, M::dim>& w) {
    return M::exp(chart_detail::constants<U>(q), chart_detail::combination(e, w));
  }
};
struct ProjectionChart {
  template <class M, class T, class U>
  static Point<M, U> at(const Point<M, T>& q, const Mat<T, M::ambient, M::dim>& e, const Vec<U, M::dim>& w) {
    return M::project(chart_detail::constants<U>(q) + chart_detail::combination(e, w));
  }
};

/// The jet with local coordinates y around (q, e, k), over any scalar S that carries derivatives (S = Jet<T, n>): the density's side of the contract.
template <class M, int D, class Chart, class T, class S>
FieldJet<M, D, S> jet_at(const Point<M, T>& q, const Mat<T, M::ambient, M::dim>& e, const Vec<S, local_dim<M, D>>& y) {
  constexpr int k = M::dim;
  FieldJet<M, D, S> jet;
  if constexpr (D == 0) {
    jet.value = Chart::template at<M>(q, e, y);
  } else if constexpr (lanes<T> > 1 && D * sizeof(S) > 16384) {
    // Dozens of such scalars do not fit into the caches, nor at length on the stack: lane by lane.
    for (int l = 0; l < lanes<T>; ++l) {
      const auto one = jet_at<M, D, Chart, double, OneLane<S>>(lane(q, l), lane(e, l), lane(y, l));
      set_lane(jet.value, l, one.value);
      for (std::size_t a = 0; a < D; ++a) set_lane(jet.d[a], l, one.d[a]);
    }
  } else {
    using U = Dual<S, D>;
    Vec<U, k> w;
    for (int i = 0; i < k; ++i) {
      w[i].v = y[i];
      for (int a = 0; a < D; ++a) w[i].d[static_cast<std::size_t>(a)] = y[(1 + a) * k + i];
    }
    const auto x = Chart::template at<M>(q, e, w);
    for (int c = 0; c < M::ambient; ++c) {
      jet.value[c] = x[c].v;
      for (int a = 0; a < D; ++a) jet.d[static_cast<std::size_t>(a)][c] = x[c].d[static_cast<std::size_t>(a)];
    }
  }
  return jet;
}

namespace chart_detail {
template <class T, int L>
Jet<T, L> variable(const T& x, int i, const Jet<T, L>*) {
  return Jet<T, L>::variable(x, i);
}
template <class T, int L>
Dual<T, L> variable(const T& x, int i, const Dual<T, L>*) {
  Dual<T, L> r;
  r.v = x;
  r.d[static_cast<std::size_t>(i)] = T(1.0);
  return r;
}
template <class T, int L>
T& slope(Jet<T, L>& x, int i) {
  return x.g[static_cast<std::size_t>(i)];
}
template <class T, int L>
T& slope(Dual<T, L>& x, int i) {
  return x.d[static_cast<std::size_t>(i)];
}
}  // namespace chart_detail

/// The jet as a function of local coordinates that are variables of S: the coordinates y (w = 0) of this field are the variables from `first` on.
/// S is Jet<T, L> or Dual<T, L>.
template <class M, int D, class Chart, class S, class T>
FieldJet<M, D, S> seeded_jet(const Point<M, T>& q, const Mat<T, M::ambient, M::dim>& e, const Vec<T, local_dim<M, D>>& y, int first) {
  using chart_detail::slope;
  constexpr int k = M::dim;
  if constexpr (requires { M::unit_scale; } && std::is_same_v<Chart, ProjectionChart>) {
    // With the metric s^2 times that of the ambient space, to second order in w:
    // q(w) = q + E w - |w|^2/(2 s^2) q,  d_a q = E k_a - (w.k_a)/s^2 (q + E w) - |w|^2/(2 s^2) E k_a
    const T curvature = T(1.0 / (M::unit_scale * M::unit_scale));
    FieldJet<M, D, S> jet;
    for (int c = 0; c < M::ambient; ++c) {
      const T back = -(curvature * q[c]);
      jet.value[c].v = q[c];
      for (int i = 0; i < k; ++i) slope(jet.value[c], first + i) = e(c, i);
      if constexpr (requires(S s) { s.h; })
        for (int i = 0; i < k; ++i) jet.value[c].h[S::index(first + i, first + i)] = back;
      for (int a = 0; a < D; ++a) {
        S& d = jet.d[static_cast<std::size_t>(a)][c];
        const int at = (1 + a) * k;
        T along = T(0.0);
        for (int i = 0; i < k; ++i) {
          along += e(c, i) * y[at + i];
          slope(d, first + i) = back * y[at + i];
          slope(d, first + at + i) = e(c, i);
        }
        d.v = along;
        if constexpr (requires(S s) { s.h; })
          for (int i = 0; i < k; ++i) {
            d.h[S::index(first + i, first + at + i)] = back;
            for (int j = i; j < k; ++j)
              d.h[S::index(first + i, first + j)] = -(curvature * (e(c, i) * y[at + j] + e(c, j) * y[at + i] + (i == j ? along : T(0.0))));
          }
      }
    }
    return jet;
  } else {
    Vec<S, local_dim<M, D>> variables;
    for (int i = 0; i < local_dim<M, D>; ++i) variables[i] = chart_detail::variable(y[i], first + i, static_cast<const S*>(nullptr));
    return jet_at<M, D, Chart, T, S>(q, e, variables);
  }
}

/// Gaussian elimination of G X = B without pivoting, for the well-conditioned small matrices of the interpolations. Returns where all pivots are positive.
template <class T, int N, int K>
MaskOf<T> solve_in_place(Mat<T, N, N> g, Mat<T, N, K>& b) {
  MaskOf<T> ok = g(0, 0) > T(0.0);
  for (int p = 0; p < N; ++p) {
    ok = ok & (g(p, p) > T(1e-10));
    const T r = T(1.0) / g(p, p);
    for (int i = p + 1; i < N; ++i) {
      const T m = g(i, p) * r;
      for (int j = p + 1; j < N; ++j) g(i, j) -= m * g(p, j);
      for (int j = 0; j < K; ++j) b(i, j) -= m * b(p, j);
    }
  }
  for (int p = N - 1; p >= 0; --p) {
    const T r = T(1.0) / g(p, p);
    for (int j = 0; j < K; ++j) {
      T s = b(p, j);
      for (int i = p + 1; i < N; ++i) s -= g(p, i) * b(i, j);
      b(p, j) = s * r;
    }
  }
  return ok;
}

}  // namespace karcher
