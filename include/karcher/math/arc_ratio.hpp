#pragma once
/// \file
/// a(c) = arccos(c) / sqrt(1 - c^2), the ratio of an angle to its sine as a function of the cosine; for c > 1 its analytic continuation
/// arccosh(c) / sqrt(c^2 - 1). Analytic on c > -1, so logarithms on spheres, rotations and hyperbolic space need no case distinction at coinciding points.
///
///   (1 - c^2) a' = c a - 1,     (1 - c^2) a^(n+1) = (2n + 1) c a^(n) + n^2 a^(n-1),
///   a^(n)(c) = (-1/2)^n (n!)^2 / (3/2)_n  2F1(n+1, n+1; n+3/2; z),   z = (1 - c)/2   (|z| < 1),
///   a(c) = a(c') / c',  c' = sqrt((1 + c)/2)   (half the angle),      a(c) = pi / sqrt(1 - c^2) - a(-c).
///
/// Abramowitz and Stegun 15.1.6 (value), 15.2.2 (derivatives).

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "karcher/math/elementary.hpp"
#include "karcher/math/polynomial.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

namespace arc_detail {

/// a^(Order) by Terms terms of its series in z.
template <int Terms, int Order, class T>
T series(const T& z) {
  static constexpr auto coefficients = [] {
    std::array<double, static_cast<std::size_t>(Terms)> c{};
    c[0] = 1;
    for (int j = 1; j <= Order; ++j) c[0] *= -0.5 * j * j / (j + 0.5);
    for (int k = 1; k < Terms; ++k)
      c[static_cast<std::size_t>(k)] = c[static_cast<std::size_t>(k - 1)] * (Order + k) * (Order + k) / ((Order + k + 0.5) * k);
    return c;
  }();
  return polynomial(coefficients, z);
}

/// a, ..., a^(Order) for z around 0: the two highest by their series, the others by the recursion downwards, whose terms have one sign for c < 1.
template <int Terms, int Order, class T>
std::array<T, static_cast<std::size_t>(Order + 1)> by_series(const T& c) {
  std::array<T, static_cast<std::size_t>(Order + 1)> a;
  const T z = T(0.5) * (T(1.0) - c), w = (T(1.0) - c) * (T(1.0) + c);
  a[Order] = series<Terms, Order>(z);
  if constexpr (Order > 0) a[Order - 1] = series<Terms, Order - 1>(z);
  for (int n = Order - 2; n >= 0; --n) {
    const auto i = static_cast<std::size_t>(n);
    a[i] = (w * a[i + 2] - T(2.0 * n + 3.0) * c * a[i + 1]) * T(1.0 / ((n + 1.0) * (n + 1.0)));
  }
  return a;
}

/// a on c > -1 away from 1.
template <class T>
T value(const T& c) {
  using karcher::sqrt;
  // Reflect to the right half, then halve the angle until z is in the range of the series.
  const auto reflected = c < T(-0.5);
  const T right = select(reflected, -c, c);
  const auto halved = (right < T(0.5)) | (right > T(1.5));
  const T half = sqrt(T(0.5) * (T(1.0) + right));
  const T argument = select(halved, half, right);
  T a = series<34, 0>(T(0.5) * (T(1.0) - min(argument, T(1.5))));
  a = select(halved, a / half, a);
  if (any(argument > T(1.5)))
    for (int l = 0; l < lanes<T>; ++l)
      if (const double x = lane(right, l); x > 3.5) set_lane(a, l, std::acosh(x) / std::sqrt((x - 1) * (x + 1)));
  if (!any(reflected)) return a;
  const T sine = sqrt(select(reflected, (T(1.0) - c) * (T(1.0) + c), T(1.0)));
  return select(reflected, T(std::numbers::pi) / sine - a, a);
}

struct ArcRatio {
  template <int Order, class T>
  std::array<T, static_cast<std::size_t>(Order + 1)> derivatives(const T& c) const {
    const T distance = abs(c - T(1.0));
    if (all(distance <= T(0.125))) return by_series<16 + 2 * Order, Order>(c);
    const auto near = distance <= T(0.5);
    if (all(near)) return by_series<30 + 3 * Order, Order>(c);
    std::array<T, static_cast<std::size_t>(Order + 1)> a;
    a[0] = value(c);
    if constexpr (Order > 0) {
      const T r = T(1.0) / select(near, T(1.0), (T(1.0) - c) * (T(1.0) + c));
      a[1] = (c * a[0] - T(1.0)) * r;
      for (int n = 1; n < Order; ++n) {
        const auto i = static_cast<std::size_t>(n);
        a[i + 1] = (T(2.0 * n + 1.0) * c * a[i] + T(1.0 * n * n) * a[i - 1]) * r;
      }
      if (any(near)) {
        const auto b = by_series<30 + 3 * Order, Order>(select(near, c, T(1.0)));
        for (std::size_t i = 1; i < a.size(); ++i) a[i] = select(near, b[i], a[i]);
      }
    }
    return a;
  }
};

}  // namespace arc_detail

/// a(c) for c > -1 at any scalar; infinite at c = -1.
template <class X>
X arc_ratio(const X& c) {
  return evaluate(arc_detail::ArcRatio{}, c);
}

/// The angle between vectors of equal length, accurate at 0 and at pi (Kahan, "How futile are mindless assessments of roundoff", 2006, section 12).
template <int N>
double angle_between(const Vec<double, N>& a, const Vec<double, N>& b) {
  return 2 * std::atan2(std::sqrt(norm2(a - b)), std::sqrt(norm2(a + b)));
}

}  // namespace karcher
