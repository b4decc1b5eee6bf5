#pragma once
/// \file
/// log_q(w)(p(v)) on unit vectors, with q(w) = exp_q(E w) and p(v) = exp_p(F v) moving, in the frame that is E moved parallel along the geodesic w.
///
/// With tau = |w|^2, alpha = <q, p(v)>, beta = E^T p(v):
///   c = <q(w), p(v)> = c_0(tau) alpha + c_1(tau) w . beta,
///   theta = a(c) ( beta - (c_1(tau) alpha + c_2(tau) w . beta) w ),
/// (for the chord of rotations, 4 c s instead of 2 a(c) s, the factor a(c) is replaced by 2 c) where c_k are the Stumpff functions and a(c) the arc ratio. w and v carry derivatives only (plain value zero), so the c_k are their Taylor polynomials; the
/// result is right to the third order in w and the second in v, which is what a Riemannian mean differentiates.

#include "karcher/math/functions.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

/// \tparam K          dimension
/// \tparam Scale      metric of the manifold is Scale^2 times that of the ambient space: 1, or 2 for rotations
/// \tparam Projective p and -p are the same point
/// \tparam Chord      the chord of rotations instead of the logarithm
template <int K, int Scale, bool Projective, bool Chord, class S, class T>
class UnitVectorAround {
  static constexpr int M = Scale == 2 ? 4 : K + 1;

 public:
  UnitVectorAround(const Vec<T, M>& q, const Mat<T, M, K>& e, const Vec<S, K>& w) : q_(q), e_(T(1.0 * Scale) * e), w_((1.0 / Scale) * w) {
    const S tau = norm2(w_);
    c0_ = 1.0 - 0.5 * tau;
    c1_ = 1.0 - (1.0 / 6) * tau;
  }
  Vec<S, K> theta(const Vec<T, M>& p) const {
    const T sign = sign_of(p);
    return theta(constant<S>(sign * dot(q_, p)), cast<S>(transpose_times(e_, sign * p - q_)));
  }
  /// f = frame(p)
  Vec<S, K> theta(const Vec<T, M>& p, const Mat<T, M, K>& f, const Vec<S, K>& v) const {
    const T sign = sign_of(p);
    // p(v) = (1 - |v|^2/2) p + F v, |v| in the ambient metric
    const S c0 = 1.0 - (0.5 / (Scale * Scale)) * norm2(v);
    const Vec<T, K> b = transpose_times(e_, sign * p - q_);
    const Vec<T, K> a1 = sign * transpose_times(f, q_);
    const Mat<T, K, K> b1 = sign * transpose_times(e_, f);
    S alpha = scaled(c0, sign * dot(q_, p));
    Vec<S, K> beta;
    for (int i = 0; i < K; ++i) {
      add_scaled(alpha, v[i], a1[i]);
      beta[i] = scaled(c0, b[i]);
      for (int j = 0; j < K; ++j) add_scaled(beta[i], v[j], b1(i, j));
    }
    return theta(alpha, beta);
  }

 private:
  Vec<S, K> theta(const S& alpha, const Vec<S, K>& beta) const {
    const S along = dot(w_, beta);
    const S c = c0_ * alpha + c1_ * along;
    S a;
    if constexpr (Chord) {
      a = (2.0 * Scale) * c;
    } else {
      a = (1.0 * Scale) * arc_ratio(c);
    }
    const S back = a * (c1_ * alpha + 0.5 * along);
    Vec<S, K> r;
    for (int i = 0; i < K; ++i) r[i] = a * beta[i] - back * w_[i];
    return r;
  }
  T sign_of(const Vec<T, M>& p) const {
    if constexpr (!Projective) return T(1.0);
    return select(dot(q_, p) < T(0.0), T(-1.0), T(1.0));
  }

  Vec<T, M> q_;
  Mat<T, M, K> e_;  // orthonormal in the ambient metric
  Vec<S, K> w_;
  S c0_, c1_;
};

template <int K, int Scale, bool Projective, class S, class T>
using UnitLogAround = UnitVectorAround<K, Scale, Projective, false, S, T>;

}  // namespace karcher
