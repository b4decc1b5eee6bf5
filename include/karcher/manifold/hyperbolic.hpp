#pragma once
/// \file
/// Hyperbolic<N>: hyperbolic space H^N of curvature -1 as the upper sheet of the hyperboloid in R^(N+1): <x, x> = -1, x_0 > 0, with the Minkowski product
/// <x, y> = -x_0 y_0 + x_1 y_1 + ... + x_N y_N.
///
///   exp_p(a) = cosh|a| p + sinh|a|/|a| a = c_0(-<a, a>) p + c_1(-<a, a>) a
///   log_p(q) = a(c) (q - c p),  c = -<p, q> = cosh dist >= 1          (arc_ratio.hpp, beyond 1)
///
/// No cut locus, and no closest point in the indefinite product: the projection rule is not defined. Coordinates grow like e^dist / 2, and the products
/// above lose as many digits: keep within dist 15 or so of (1, 0, ..., 0).
///
/// Ratcliffe, "Foundations of Hyperbolic Manifolds" (2006), chapter 3.

#include <algorithm>
#include <cmath>
#include <limits>

#include "karcher/manifold/traits.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

template <int N>
struct Hyperbolic {
  static_assert(N == 2 || N == 3, "Hyperbolic<N> is named for N = 2, 3");
  static constexpr std::string_view name = N == 2 ? "H2" : "H3";
  static constexpr std::string_view description =
      N == 2 ? "hyperbolic plane, hyperboloid x0^2 = 1 + x1^2 + x2^2, x0 > 0" : "hyperbolic space, hyperboloid x0^2 = 1 + x1^2 + x2^2 + x3^2, x0 > 0";
  static constexpr int ambient = N + 1;
  static constexpr int dim = N;
  static constexpr double injectivity_radius = std::numeric_limits<double>::infinity();

  /// The lowest point of the sheet.
  static Vec<double, N + 1> origin() { return {{1.0}}; }
  /// The Minkowski product.
  template <class T>
  static T product(const Vec<T, N + 1>& a, const Vec<T, N + 1>& b) {
    T s = a[1] * b[1] - a[0] * b[0];
    for (int i = 2; i <= N; ++i) s += a[i] * b[i];
    return s;
  }
  template <class T>
  static Vec<T, N + 1> exp(const Vec<T, N + 1>& p, const Vec<T, N + 1>& a) {
    const auto c = stumpff<1>(-product(a, a));
    Vec<T, N + 1> q = c[0] * p + c[1] * a;
    // The first coordinate follows from the others, without cancellation; derivatives do not see it.
    if constexpr (is_base<T>) q[0] = height(q);
    return q;
  }
  template <class T>
  static Vec<T, N + 1> log(const Vec<T, N + 1>& p, const Vec<T, N + 1>& q) {
    Vec<T, N + 1> h = q - p;  // q - c p, with a small relative error for near points
    h += product(p, h) * p;
    return arc_ratio(-product(p, q)) * h;
  }
  static double dist(const Vec<double, N + 1>& p, const Vec<double, N + 1>& q) {
    const Vec<double, N + 1> h = q - p;
    return 2 * std::asinh(0.5 * std::sqrt(std::max(0.0, product(h, h))));
  }
  template <class T>
  static T inner(const Vec<T, N + 1>&, const Vec<T, N + 1>& a, const Vec<T, N + 1>& b) {
    return product(a, b);
  }
  /// The images of e_1, ..., e_N under the boost that takes (1, 0, ..., 0) to p: e_k + p_k (e_0 + p)/(1 + p_0). Smooth in p.
  template <class T>
  static Mat<T, N + 1, N> frame(const Vec<T, N + 1>& p) {
    Mat<T, N + 1, N> e;
    const T r = T(1.0) / (T(1.0) + p[0]);
    for (int k = 1; k <= N; ++k) {
      const T s = r * p[k];
      e(0, k - 1) = p[k];
      for (int i = 1; i <= N; ++i) e(i, k - 1) = s * p[i] + (i == k ? T(1.0) : T(0.0));
    }
    return e;
  }
  /// x with the first coordinate that the others ask for; false where it differs by more than 1e-6.
  static bool make_point(const Vec<double, N + 1>& x, Vec<double, N + 1>& p) {
    const bool good = defect(x) < 1e-6;
    p = x;
    p[0] = height(x);
    return good;
  }
  /// Difference of the first coordinate to the one that the others ask for, relative to it.
  static double defect(const Vec<double, N + 1>& x) { return std::abs(x[0] / height(x) - 1); }
  /// sqrt(1 + x_1^2 + ... + x_N^2)
  template <class T>
  static T height(const Vec<T, N + 1>& x) {
    T s = T(1.0) + x[1] * x[1];
    for (int i = 2; i <= N; ++i) s += x[i] * x[i];
    return sqrt(s);
  }
};

static_assert(Manifold<Hyperbolic<2>> && Manifold<Hyperbolic<3>>);

}  // namespace karcher
