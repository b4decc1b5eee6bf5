#pragma once
/// \file
/// Stumpff functions c_k(tau) = sum_j (-tau)^j / (k + 2j)!: entire, so that everything about circles, spheres, rotations (tau > 0) and hyperbolas,
/// hyperbolic space (tau < 0) is smooth where the angle vanishes.
///
///   c_0 = cos sqrt(tau)  (cosh sqrt(-tau)),   c_1 = sin sqrt(tau) / sqrt(tau)  (sinh sqrt(-tau) / sqrt(-tau)),
///   c_k = 1/k! - tau c_{k+2},   c_k' = (k c_{k+2} - c_{k+1}) / 2.
///
/// Stiefel and Scheifele, "Linear and Regular Celestial Mechanics" (1971), section 11.

#include <array>
#include <cmath>
#include <cstddef>

#include "karcher/math/polynomial.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

namespace stumpff_detail {

/// 1/k!
constexpr double inverse_factorial(int k) {
  double f = 1;
  for (int i = 2; i <= k; ++i) f *= i;
  return 1 / f;
}

/// sum_{j < Terms} (-tau)^j / (k + 2j)!
template <int Terms, int K, class T>
T series(const T& tau) {
  static constexpr auto coefficients = [] {
    std::array<double, static_cast<std::size_t>(Terms)> c{};
    for (int j = 0; j < Terms; ++j) c[static_cast<std::size_t>(j)] = (j % 2 == 0 ? 1 : -1) * inverse_factorial(K + 2 * j);
    return c;
  }();
  return polynomial(coefficients, tau);
}

/// c_0 ... c_K: the two last by their series, the others by recursion downwards, in which errors do not grow.
template <int Terms, int K, class T>
std::array<T, static_cast<std::size_t>(K + 1)> by_series(const T& tau) {
  static constexpr auto inverse = [] {
    std::array<double, static_cast<std::size_t>(K + 1)> f{};
    for (int k = 0; k <= K; ++k) f[static_cast<std::size_t>(k)] = inverse_factorial(k);
    return f;
  }();
  std::array<T, static_cast<std::size_t>(K + 1)> c;
  c[K] = series<Terms, K>(tau);
  if constexpr (K > 0) c[K - 1] = series<Terms, K - 1>(tau);
  for (std::size_t k = K - 1; k-- > 0;) c[k] = T(inverse[k]) - tau * c[k + 2];
  return c;
}

/// c_0 ... c_K for |tau| > large: closed forms and recursion upwards.
template <int K>
std::array<double, static_cast<std::size_t>(K + 1)> by_recursion(double tau) {
  std::array<double, static_cast<std::size_t>(K + 1)> c;
  const double angle = std::sqrt(std::abs(tau));
  c[0] = tau > 0 ? std::cos(angle) : std::cosh(angle);
  if constexpr (K > 0) c[1] = (tau > 0 ? std::sin(angle) : std::sinh(angle)) / angle;
  for (int k = 2; k <= K; ++k) c[static_cast<std::size_t>(k)] = (inverse_factorial(k - 2) - c[static_cast<std::size_t>(k - 2)]) / tau;
  return c;
}

inline constexpr double small = 0.6;   // 10 terms leave 0.6^10 / 20!
inline constexpr double large = 10.0;  // just above pi^2; 18 terms leave 10^18 / 36!, and cancellation costs a factor of four

}  // namespace stumpff_detail

/// c_0(tau) ... c_K(tau) for any real tau (infinite where cosh sqrt(-tau) overflows), at any scalar.
template <int K, class X>
std::array<X, static_cast<std::size_t>(K + 1)> stumpff(const X& tau) {
  namespace d = stumpff_detail;
  if constexpr (is_base<X>) {
    const X size = abs(tau);
    if (all(size <= X(d::small))) return d::by_series<10, K>(tau);
    const auto near = size <= X(d::large);
    if (all(near)) return d::by_series<18, K>(tau);
    auto c = d::by_series<18, K>(select(near, tau, X(0.0)));
    for (int l = 0; l < lanes<X>; ++l) {
      if (lane(size, l) <= d::large) continue;
      const auto exact = d::by_recursion<K>(lane(tau, l));
      for (std::size_t k = 0; k < c.size(); ++k) set_lane(c[k], l, exact[k]);
    }
    return c;
  } else {
    std::array<X, static_cast<std::size_t>(K + 1)> r;
    constexpr int order = requires(X x) { x.h; }
    ? 2 : 1;
    const auto c = stumpff<K + 2 * order>(tau.v);
    using U = std::remove_cvref_t<decltype(tau.v)>;
    const auto derivative = [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      return U((c[i + 2] * (0.5 * k)) - c[i + 1] * 0.5);
    };
    for (int k = 0; k <= K; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if constexpr (order == 2) {
        r[i] = compose(tau, c[i], derivative(k), U(derivative(k + 2) * (0.5 * k) - derivative(k + 1) * 0.5));
      } else {
        r[i] = chain(tau, c[i], derivative(k));
      }
    }
    return r;
  }
}

}  // namespace karcher
