#pragma once
/// \file
/// The rotation closest to a 3x3 matrix A: the maximiser of tr(Q^T A), which is the polar factor where det A > 0, and the projection of an average of rotations.
///
/// Newton's method on SO(3): S = Q^T A, G = tr(S) I - sym S, q <- q * (1, w/2)/|.| with G w = Ax(S). tr(Q^T A) is a quadratic form in the quaternion of Q,
/// x^T K x, so a local maximum (G positive definite) is the global one; where Newton ends elsewhere, the eigenvector of the largest eigenvalue of K starts it
/// again. A largest eigenvalue that is not simple (G singular) means that there is no closest rotation, or more than one: reported, not guessed.
///
/// Davenport's K matrix: Wertz (ed.), "Spacecraft Attitude Determination and Control" (1978), section 12.2.2;
/// Horn, "Closed-form solution of absolute orientation using unit quaternions" (JOSA A, 1987).

#include "karcher/manifold/quaternion.hpp"
#include "karcher/math/symmetric.hpp"

namespace karcher {

template <class T>
struct PolarFactor {
  Quaternion<T> q{};
  MaskOf<T> defined{};  ///< false: no unique closest rotation (q is then a unit quaternion without meaning)
  int iterations = 0;   ///< Newton steps, of the slowest lane
};

namespace polar_detail {

/// Largest eigenvector of K (unit quaternion).
inline Quaternion<double> largest_eigenvector(const Mat3<double>& a) {
  const double t = trace(a);
  const Vec3<double> z = ax(a);
  Mat<double, 4, 4> k;
  k(0, 0) = t;
  for (int i = 0; i < 3; ++i) {
    k(0, i + 1) = k(i + 1, 0) = z[i];
    for (int j = 0; j < 3; ++j) k(i + 1, j + 1) = a(i, j) + a(j, i) - (i == j ? t : 0.0);
  }
  const auto e = eigen(k);
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (e.values[i] > e.values[best]) best = i;
  return column(e.vectors, best);
}

template <class T>
struct NewtonStep {
  Vec3<T> w;
  MaskOf<T> maximum;  ///< G is positive definite, with room for rounding
};

/// size2: |A|_F^2, against which G counts as singular.
template <class T>
NewtonStep<T> newton_step(const Mat3<T>& a, const Quaternion<T>& q, const Base<T>& size2) {
  using B = Base<T>;
  const Mat3<T> s = transpose_times(rotation_matrix(q), a);
  const T t = trace(s);
  Mat3<T> g = T(-0.5) * (s + transpose(s));
  for (int i = 0; i < 3; ++i) g(i, i) += t;
  const Mat3<T> c = cofactor(g);  // symmetric
  const T det = g(0, 0) * c(0, 0) + g(0, 1) * c(0, 1) + g(0, 2) * c(0, 2);
  NewtonStep<T> r;
  const B tiny = B(1e-12) * size2;  // squares: G within 1e-6 |A| of singular has lost half of the digits of Q
  r.maximum = (base(g(0, 0)) > B(0.0)) & (base(c(2, 2)) > tiny) & (base(det) > B(1e-6) * base(c(2, 2)) * sqrt(size2));
  const auto regular = (base(det) > B(0.0)) | (base(det) < B(0.0));
  r.w = (T(1.0) / select(regular, det, T(1.0))) * (c * ax(s));
  return r;
}

template <class T>
Quaternion<T> moved(const Quaternion<T>& q, const Vec3<T>& w) {
  const Quaternion<T> x = q + times_imaginary(q, T(0.5) * w);
  return (T(1.0) / sqrt(norm2(x))) * x;
}

}  // namespace polar_detail

/// The closest rotation to A, beginning at the unit quaternion `start`. Any scalar; derivatives come from two Newton steps at the solution of the plain values.
template <class T>
PolarFactor<T> polar_factor(const Mat3<T>& a, const Quaternion<Base<T>>& start) {
  namespace d = polar_detail;
  using B = Base<T>;
  if constexpr (!is_base<T>) {
    const PolarFactor<B> plain = polar_factor(symmetric_detail::plain(a), start);
    PolarFactor<T> r;
    r.defined = plain.defined;
    r.iterations = plain.iterations;
    for (int i = 0; i < 4; ++i) r.q[i] = constant<T>(plain.q[i]);
    // Each step doubles the order to which the derivatives are right: 1, then 3.
    for (int step = 0; step < 2; ++step) r.q = d::moved(r.q, d::newton_step(a, r.q, norm2(symmetric_detail::plain(a))).w);
    return r;
  } else {
    constexpr int most = 8;
    const B size2 = norm2(a);
    PolarFactor<T> r;
    r.q = start;
    // The last step, from |w| < 1e-7, ends at rounding level.
    const auto newton = [&] {
      for (int step = 0; step < most; ++step, ++r.iterations) {
        const auto n = d::newton_step(a, r.q, size2);
        const B w2 = norm2(n.w);
        // Far from the solution a step may be long: at most about a radian.
        const B shorten = select(w2 > B(1.0), B(1.0) / sqrt(max(w2, B(1.0))), B(1.0));
        r.q = d::moved(r.q, shorten * n.w);
        r.defined = n.maximum & (w2 < B(1e-14));
        if (all(w2 < B(1e-14))) return;
      }
    };
    newton();
    if (all(r.defined)) return r;
    for (int l = 0; l < lanes<T>; ++l) {
      if (lane(B(select(r.defined, B(1.0), B(0.0))), l) > 0) continue;
      Mat3<double> m;
      bool finite = true;
      for (std::size_t i = 0; i < 9; ++i) {
        m.e[i] = lane(a.e[i], l);
        finite = finite && m.e[i] - m.e[i] == 0;
      }
      const Quaternion<double> q = finite ? d::largest_eigenvector(m) : Quaternion<double>{{1.0, 0.0, 0.0, 0.0}};
      for (int i = 0; i < 4; ++i) set_lane(r.q[i], l, q[i]);
    }
    newton();
    return r;
  }
}

/// The closest rotation to A.
inline PolarFactor<double> polar_factor(const Mat3<double>& a) { return polar_factor(a, polar_detail::largest_eigenvector(a)); }

/// The projected average of rotations: closest to sum_i l_i R(q_i), for n unit quaternions of any signs and weights of any sign.
template <class T, class Weight>
PolarFactor<T> rotation_average(const Quaternion<T>* q, const Weight* l, int n) {
  using B = Base<T>;
  Mat3<T> a;
  Quaternion<B> start;
  for (int i = 0; i < n; ++i) {
    a += T(l[i]) * rotation_matrix(q[i]);
    Quaternion<B> x;
    for (int c = 0; c < 4; ++c) x[c] = base(q[i][c]);
    B s = x[0] * base(q[0][0]);
    for (int c = 1; c < 4; ++c) s += x[c] * base(q[0][c]);
    start += base(l[i]) * select(s < B(0.0), B(-1.0), B(1.0)) * x;
  }
  const B size2 = norm2(start);
  const auto good = size2 > B(1e-3);
  const B r = B(1.0) / sqrt(select(good, size2, B(1.0)));
  for (int c = 0; c < 4; ++c) start[c] = select(good, r * start[c], base(q[0][c]));
  return polar_factor(a, start);
}

}  // namespace karcher
