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
#include <type_traits>
#include <vector>

#include "karcher/manifold/traits.hpp"
#include "karcher/math/symmetric.hpp"

namespace karcher {

template <int N>
struct Spd {
  static_assert(N == 2 || N == 3, "Spd<N> is named for N = 2, 3");
  static constexpr std::string_view name = N == 2 ? "SPD2" : "SPD3";
  static constexpr std::string_view description = N == 2 ? "symmetric positive definite 2x2 matrices (4 entries by rows), affine-invariant metric"
                                                         : "symmetric positive definite 3x3 matrices (9 entries by rows), affine-invariant metric";
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
  static constexpr bool has_identity = true;
  static Drawing drawing() {
    return {.glyph = Glyph::ellipsoid, .coordinates = N == 2 ? std::vector<int>{0, 3, 1} : std::vector<int>{0, 4, 8, 1, 2, 5}, .components = false};
  }
  template <class T>
  static Vec<T, N * N> exp(const Vec<T, N * N>& p, const Vec<T, N * N>& a) {
    if constexpr (one_by_one<T>) return lane_by_lane(p, a, [](const auto& x, const auto& y) { return exp(x, y); });
    const Mat<T, N, N> l = cholesky(matrix(p));
    return point(lower_congruence(l, symmetric_exp(lower_congruence(lower_inverse(l), matrix(a)))));
  }
  template <class T>
  static Vec<T, N * N> log(const Vec<T, N * N>& p, const Vec<T, N * N>& q) {
    if constexpr (one_by_one<T>) return lane_by_lane(p, q, [](const auto& x, const auto& y) { return log(x, y); });
    const Mat<T, N, N> l = cholesky(matrix(p)), inverse = lower_inverse(l);
    return point(lower_congruence(l, relative_log(lower_congruence(inverse, matrix(q) - matrix(p)), [&] {
                                    return lower_congruence(symmetric_detail::plain(inverse), symmetric_detail::plain(matrix(q)));
                                  })));
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
  /// The symmetric matrix with the coordinates v in the basis S_k.
  template <class T>
  static Mat<T, N, N> symmetric_matrix(const Vec<T, dim>& v) {
    Mat<T, N, N> s;
    int k = N;
    for (int i = 0; i < N; ++i) s(i, i) = v[i];
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j, ++k) s(i, j) = s(j, i) = (0.5 * std::numbers::sqrt2) * v[k];
    return s;
  }
  template <class T>
  static Vec<T, dim> symmetric_coordinates(const Mat<T, N, N>& s) {
    Vec<T, dim> v;
    int k = N;
    for (int i = 0; i < N; ++i) v[i] = s(i, i);
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j, ++k) v[k] = std::numbers::sqrt2 * s(i, j);
    return v;
  }

 private:
  /// Scalars of more than 8 kB leave the cache, and at length the stack, when some dozens of them are alive: such packs are taken apart.
  template <class T>
  static constexpr bool one_by_one = lanes<T> > 1 && sizeof(T) > 8192;

  template <class S, class T>
  class LogAroundAtOnce {
   public:
    /// q(w) = exp_q(E w) where E = frame(q); w without plain value.
    LogAroundAtOnce(const Vec<T, N * N>& q, const Mat<T, N * N, dim>&, const Vec<S, dim>& w) : q_(matrix(q)), inverse_(lower_inverse(cholesky(q_))) {
      const Mat<S, N, N> x = symmetric_matrix(w), x2 = x * x, x3 = x * x2;
      half_ = identity<S, N>() + (-0.5) * x + 0.125 * x2 + (-1.0 / 48) * x3;
      whole_ = (-1.0) * x + 0.5 * x2 + (-1.0 / 6) * x3;
    }
    /// log_q(w)(p)
    Vec<S, dim> theta(const Vec<T, N * N>& p) const { return theta(p, cast<S>(lower_congruence(inverse_, matrix(p) - q_))); }
    /// log_q(w)(exp_p(F v)) where F = frame(p); v without plain value.
    Vec<S, dim> theta(const Vec<T, N * N>& p, const Mat<T, N * N, dim>&, const Vec<S, dim>& v) const {
      const Mat<S, N, N> x = symmetric_matrix(v), x2 = x * x;
      const Mat<S, N, N> change = x + 0.5 * x2 + (1.0 / 6) * (x * x2);
      const Mat<T, N, N> m = inverse_ * cholesky(matrix(p));  // lower triangular
      Mat<S, N, N> y = cast<S>(lower_congruence(inverse_, matrix(p) - q_)), mx;
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
          for (int k = 0; k <= i; ++k) add_scaled(mx(i, j), change(k, j), m(i, k));
      for (int i = 0; i < N; ++i)
        for (int j = 0; j <= i; ++j) {
          for (int k = 0; k <= j; ++k) add_scaled(y(i, j), mx(i, k), m(j, k));
          y(j, i) = y(i, j);
        }
      return theta(p, y);
    }

   private:
    // y = L^-1 p L^-T - I
    Vec<S, dim> theta(const Vec<T, N * N>& p, const Mat<S, N, N>& y) const {
      const Mat<S, N, N> z = half_ * y;
      Mat<S, N, N> d = whole_;
      for (int i = 0; i < N; ++i)
        for (int j = i; j < N; ++j) {
          for (int k = 0; k < N; ++k) add_product(d(i, j), z(i, k), half_(k, j));
          d(j, i) = d(i, j);
        }
      return symmetric_coordinates(relative_log(d, [&] { return lower_congruence(inverse_, matrix(p)); }));
    }

    Mat<T, N, N> q_, inverse_;
    Mat<S, N, N> half_, whole_;  // exp(-W/2), exp(-W) - I
  };

  template <class S, class T>
  class LogAroundByLanes {
   public:
    LogAroundByLanes(const Vec<T, N * N>& q, const Mat<T, N * N, dim>& e, const Vec<S, dim>& w) {
      lanes_.reserve(static_cast<std::size_t>(lanes<T>));
      for (int l = 0; l < lanes<T>; ++l) lanes_.emplace_back(lane(q, l), lane(e, l), lane(w, l));
    }
    Vec<S, dim> theta(const Vec<T, N * N>& p) const {
      Vec<S, dim> r;
      for (int l = 0; l < lanes<T>; ++l) set_lane(r, l, lanes_[static_cast<std::size_t>(l)].theta(lane(p, l)));
      return r;
    }
    Vec<S, dim> theta(const Vec<T, N * N>& p, const Mat<T, N * N, dim>& e, const Vec<S, dim>& v) const {
      Vec<S, dim> r;
      for (int l = 0; l < lanes<T>; ++l) set_lane(r, l, lanes_[static_cast<std::size_t>(l)].theta(lane(p, l), lane(e, l), lane(v, l)));
      return r;
    }

   private:
    std::vector<LogAroundAtOnce<OneLane<S>, double>> lanes_;
  };

 public:
  /// log_q(p) with q = q(w) and p = p(v) moving, in coordinates of a frame that moves with q: what a Riemannian mean differentiates, at a third of the cost of
  /// exp, exp and log. With q(w) = B B^T, B = L exp(W/2), the coordinates in the frame B S_k B^T are those of log(B^-1 p B^-T); around w = 0 and v = 0,
  /// exp(-W/2) and exp(V) are their Taylor polynomials of the order that the scalar S carries.
  template <class S, class T>
  using LogAround = std::conditional_t<one_by_one<S>, LogAroundByLanes<S, T>, LogAroundAtOnce<S, T>>;

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

 private:
  template <class T, class F>
  static Vec<T, N * N> lane_by_lane(const Vec<T, N * N>& a, const Vec<T, N * N>& b, F f) {
    Vec<T, N * N> r;
    for (int l = 0; l < lanes<T>; ++l) set_lane(r, l, f(lane(a, l), lane(b, l)));
    return r;
  }
  /// log(I + D). Near I from D, with an error relative to D; far from I (in any lane) from plain(), the plain value of I + D computed without a difference.
  template <class T, class Plain>
  static Mat<T, N, N> relative_log(const Mat<T, N, N>& d, Plain plain) {
    Base<T> size2 = Base<T>(0.0);
    for (const T& x : d.e) size2 += base(x) * base(x);
    if (all(size2 < Base<T>(0.25))) return symmetric_log1p(d);
    if constexpr (is_base<T>) {
      return symmetric_log(plain());
    } else {
      Mat<T, N, N> far = d;
      const Mat<Base<T>, N, N> value = plain();
      for (std::size_t i = 0; i < far.e.size(); ++i) set_value(far.e[i], value.e[i]);
      return symmetric_log(far);
    }
  }
};

static_assert(Manifold<Spd<2>> && Manifold<Spd<3>>);

}  // namespace karcher
