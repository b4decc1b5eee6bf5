#pragma once
/// \file
/// Spd<N>: symmetric positive definite N x N matrices with the affine-invariant metric <A, B>_P = tr(P^-1 A P^-1 B). Ambient coordinates: all N^2 entries, row
/// by row. With P = L L^T (Cholesky):
///
///   exp_P(A) = L exp(L^-1 A L^-T) L^T,    log_P(Q) = L log(L^-1 Q L^-T) L^T,    dist(P, Q) = |log(L^-1 Q L^-T)|_F,
///   frame at P: L S_k L^T, S_k the orthonormal basis of symmetric matrices (e_i e_i^T, then (e_i e_j^T + e_j e_i^T)/sqrt 2 for i < j).
///
/// A complete manifold of non-positive curvature: no cut locus, means are unique. An open set of the symmetric matrices, hence no closest points: the
/// projection rule is not defined.
///
/// Pennec, Fillard, Ayache, "A Riemannian framework for tensor computing" (IJCV 2006); Bhatia, "Positive Definite Matrices" (2007), chapter 6.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "karcher/manifold/manifold.hpp"
#include "karcher/math/symmetric.hpp"

namespace karcher {

template <int N>
struct Spd {
  static_assert(N == 2 || N == 3, "Spd<N> is named for N = 2, 3");
  static constexpr std::string_view name = N == 2 ? "SPD2" : "SPD3";
  static constexpr int ambient = N * N;
  static constexpr int dim = N * (N + 1) / 2;
  static constexpr double injectivity_radius = std::numeric_limits<double>::infinity();

  template <class T>
  static Mat<T, N, N> matrix(const Vec<T, N * N>& p) {
    return {p.e};
  }
  template <class T>
  static Vec<T, N * N> point(const Mat<T, N, N>& p) {
    return {p.e};
  }

  /// The identity.
  static Vec<double, N * N> origin() { return point(identity<double, N>()); }
  template <class T>
  static Vec<T, N * N> exp(const Vec<T, N * N>& p, const Vec<T, N * N>& a) {
    const Mat<T, N, N> l = cholesky(matrix(p));
    return point(lower_congruence(l, symmetric_exp(lower_congruence(lower_inverse(l), matrix(a)))));
  }
  template <class T>
  static Vec<T, N * N> log(const Vec<T, N * N>& p, const Vec<T, N * N>& q) {
    const Mat<T, N, N> l = cholesky(matrix(p)), inverse = lower_inverse(l);
    const Mat<T, N, N> difference = lower_congruence(inverse, matrix(q) - matrix(p));
    // Near points by log(I + .), whose error is relative to their distance; far points by log, whose argument must not be a difference.
    Base<T> size2 = Base<T>(0.0);
    for (const T& x : difference.e) size2 += base(x) * base(x);
    const auto near = size2 < Base<T>(0.25);
    if (all(near)) return point(lower_congruence(l, symmetric_log1p(difference)));
    const Mat<T, N, N> far_log = symmetric_log(lower_congruence(inverse, matrix(q)));
    if (!any(near)) return point(lower_congruence(l, far_log));
    Mat<T, N, N> harmless = difference;
    for (T& x : harmless.e) x = select(near, x, T(0.0));
    Mat<T, N, N> logarithm = symmetric_log1p(harmless);
    for (std::size_t i = 0; i < logarithm.e.size(); ++i) logarithm.e[i] = select(near, logarithm.e[i], far_log.e[i]);
    return point(lower_congruence(l, logarithm));
  }
  template <class T>
  static T inner(const Vec<T, N * N>& p, const Vec<T, N * N>& a, const Vec<T, N * N>& b) {
    const Mat<T, N, N> inverse = lower_inverse(cholesky(matrix(p)));
    const Mat<T, N, N> x = inverse * matrix(a), y = inverse * matrix(b);
    return karcher::dot(x * transpose(inverse), y * transpose(inverse));
  }
  template <class T>
  static Mat<T, N * N, dim> frame(const Vec<T, N * N>& p) {
    const Mat<T, N, N> l = cholesky(matrix(p));
    Mat<T, N * N, dim> e;
    int k = 0;
    for (int i = 0; i < N; ++i, ++k)
      for (int r = i; r < N; ++r)
        for (int c = i; c < N; ++c) e(r * N + c, k) = l(r, i) * l(c, i);
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j, ++k)
        for (int r = i; r < N; ++r)
          for (int c = i; c < N; ++c) e(r * N + c, k) = T(0.5 * std::numbers::sqrt2) * (l(r, i) * l(c, j) + l(r, j) * l(c, i));
    return e;
  }
  /// The symmetric part of x; false where x is not symmetric to eight digits or not positive definite.
  static bool make_point(const Vec<double, N * N>& x, Vec<double, N * N>& p) {
    p = point(sym(matrix(x)));
    return defect(x) < 1e-8;
  }
  /// Largest difference of mirrored entries, relative to the largest entry; infinite where a Cholesky pivot is not positive.
  static double defect(const Vec<double, N * N>& x) {
    const Mat<double, N, N> a = matrix(x), l = cholesky(sym(a));
    double largest = 0, skewness = 0;
    for (int i = 0; i < N; ++i) {
      if (!(l(i, i) > 0) || !(l(i, i) < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::infinity();
      for (int j = 0; j < N; ++j) {
        largest = std::max(largest, std::abs(a(i, j)));
        skewness = std::max(skewness, std::abs(a(i, j) - a(j, i)));
      }
    }
    return skewness / largest;
  }
};

static_assert(Manifold<Spd<2>> && Manifold<Spd<3>>);

}  // namespace karcher
