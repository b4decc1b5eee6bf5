#pragma once
/// \file
/// Sphere<N>: the unit sphere S^N in R^(N+1).
///
///   exp_p(a) = cos|a| p + sin|a|/|a| a = c_0(|a|^2) p + c_1(|a|^2) a      (stumpff.hpp)
///   log_p(q) = a(c) (q - c p),  c = <p, q>                                (arc_ratio.hpp)
///   dist = arccos c, project x = x/|x|, chord(q, p) = p - <p, q> q, injectivity radius pi.
///
/// Absil, Mahony, Sepulchre (2008), examples 3.5.1 and 5.4.1.

#include <cmath>
#include <numbers>

#include "karcher/manifold/traits.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

/// Unit vectors of R^M, whatever their manifold is called.
namespace unit_vector {

template <class T, int M>
Vec<T, M> exp(const Vec<T, M>& p, const Vec<T, M>& a) {
  const auto c = stumpff<1>(norm2(a));
  Vec<T, M> q = c[0] * p + c[1] * a;
  // One Newton step for the length keeps rounding errors from growing over many steps; derivatives do not see it.
  if constexpr (is_base<T>) q = (T(1.5) - T(0.5) * norm2(q)) * q;
  return q;
}

template <class T, int M>
Vec<T, M> log(const Vec<T, M>& p, const Vec<T, M>& q) {
  // q - c p is taken from the difference (beyond the equator: sum) of the points, so that its relative error is small for near and for opposite points.
  const T c = dot(p, q);
  const auto far = base(c) < Base<T>(0.0);
  Vec<T, M> h;
  if (!any(far)) {
    h = q - p;
  } else {
    for (int i = 0; i < M; ++i) h[i] = select(far, q[i] + p[i], q[i] - p[i]);
  }
  h -= dot(h, p) * p;
  const auto opposite = base(c) < Base<T>(-0.5);
  if (!any(opposite)) return arc_ratio(c) * h;
  // a(c) = pi / |h| - a(-c): the sine comes from h, because the cosine has lost it.
  const T a = arc_ratio(select(opposite, -c, c));
  const T sine = sqrt(select(opposite, norm2(h), T(1.0)));
  return select(opposite, T(std::numbers::pi) / sine - a, a) * h;
}

/// log for points of which p and -p are the same.
template <class T, int M>
Vec<T, M> projective_log(const Vec<T, M>& p, const Vec<T, M>& q) {
  const T c = dot(p, q);
  const auto far = base(c) < Base<T>(0.0);
  Vec<T, M> h;
  for (int i = 0; i < M; ++i) h[i] = any(far) ? select(far, -q[i], q[i]) - p[i] : q[i] - p[i];
  h -= dot(h, p) * p;
  return arc_ratio(abs(c)) * h;
}

/// Infinite or NaN at x = 0, which has no closest point.
template <class T, int M>
Vec<T, M> project(const Vec<T, M>& x) {
  return (T(1.0) / sqrt(norm2(x))) * x;
}

template <class T, int M>
Vec<T, M> chord(const Vec<T, M>& q, const Vec<T, M>& p) {
  return p - dot(p, q) * q;
}

template <int M>
double defect(const Vec<double, M>& x) {
  return std::abs(std::sqrt(norm2(x)) - 1);
}

}  // namespace unit_vector

template <int N>
struct Sphere {
  static_assert(N >= 1 && N <= 3, "Sphere<N> is named for N = 1, 2, 3");
  static constexpr std::string_view name = N == 1 ? "S1" : N == 2 ? "S2" : "S3";
  static constexpr std::string_view description = N == 1   ? "the unit circle; points are unit vectors of R^2"
                                                  : N == 2 ? "the unit sphere; points are unit vectors of R^3"
                                                           : "the unit sphere of R^4";
  static constexpr int ambient = N + 1;
  static constexpr int dim = N;
  static constexpr double injectivity_radius = std::numbers::pi;
  static constexpr int unit_scale = 1;
  static constexpr bool directions = N == 2;

  /// The first unit vector.
  static Vec<double, N + 1> origin() { return {{1.0}}; }
  /// The last unit vector.
  static Vec<double, N + 1> standard_point() {
    Vec<double, N + 1> p;
    p[N] = 1;
    return p;
  }
  static Drawing drawing() {
    if (N == 1) return {.glyph = Glyph::arrow, .coordinates = {0, 1}, .place = true};
    if (N == 2) return {.glyph = Glyph::arrow, .coordinates = {0, 1, 2}, .place = true, .sphere = true};
    return {};
  }
  template <class T>
  static Vec<T, N + 1> exp(const Vec<T, N + 1>& p, const Vec<T, N + 1>& a) {
    return unit_vector::exp(p, a);
  }
  /// Not defined (NaN) for opposite points.
  template <class T>
  static Vec<T, N + 1> log(const Vec<T, N + 1>& p, const Vec<T, N + 1>& q) {
    return unit_vector::log(p, q);
  }
  static double dist(const Vec<double, N + 1>& p, const Vec<double, N + 1>& q) { return angle_between(p, q); }
  template <class T>
  static T inner(const Vec<T, N + 1>&, const Vec<T, N + 1>& a, const Vec<T, N + 1>& b) {
    return dot(a, b);
  }
  /// S^1: the point turned by a right angle. Else the columns of the Householder reflection I - v v^T/(1 + |p_N|), v = p + sign(p_N) e_N, that takes p to
  /// -+e_N; all its entries are well conditioned, it jumps where p_N changes sign.
  template <class T>
  static Mat<T, N + 1, N> frame(const Vec<T, N + 1>& p) {
    Mat<T, N + 1, N> e;
    if constexpr (N == 1) {
      e(0, 0) = -p[1];
      e(1, 0) = p[0];
    } else {
      const auto south = base(p[N]) < Base<T>(0.0);
      const T sign = select(south, T(-1.0), T(1.0));
      const T r = T(1.0) / (T(1.0) + sign * p[N]);
      for (int j = 0; j < N; ++j) {
        const T s = r * p[j];
        for (int i = 0; i < N; ++i) e(i, j) = (i == j ? T(1.0) : T(0.0)) - s * p[i];
        e(N, j) = -(sign * p[j]);
      }
    }
    return e;
  }
  template <class T>
  static Vec<T, N + 1> project(const Vec<T, N + 1>& x) {
    return unit_vector::project(x);
  }
  template <class T>
  static Vec<T, N + 1> chord(const Vec<T, N + 1>& q, const Vec<T, N + 1>& p) {
    return unit_vector::chord(q, p);
  }
  static double defect(const Vec<double, N + 1>& x) { return unit_vector::defect(x); }
};

static_assert(HasProjection<Sphere<1>> && HasProjection<Sphere<2>> && HasProjection<Sphere<3>>);

}  // namespace karcher
