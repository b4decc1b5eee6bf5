#pragma once
/// \file
/// Logarithm of rotations for the shell kernel, as polynomials: the same few multiplications in every lane, no branch, no cancellation.
///
/// Both functions are entire near the interval of interest, so that interpolation at Chebyshev nodes converges geometrically; the coefficients were
/// computed with
/// 60 digits. The errors stated are those of the polynomials in double precision.

#include <array>

#include "assembly/shell_algebra.hpp"

namespace karcher::shell {

template <class T, std::size_t N>
T horner(const std::array<double, N>& a, const T& x) {
  T y(a[N - 1]);
  for (std::size_t k = N - 1; k > 0; --k) y = y * x + T(a[k - 1]);
  return y;
}

/// theta / sin(theta/2) = 2 sum_k 2^k k!^2 / (2k+1)! u^k as a function of u = 1 - cos(theta/2) in [0, 1], relative error 2e-16: the rotation vector
/// of the unit
/// quaternion (c, s), c >= 0, is s times this.
template <class T>
T angle_over_sine(const T& c) {
  static constexpr std::array<double, 21> a = {2.0,
                                               0.6666666666666189,
                                               0.2666666666736505,
                                               0.11428571388085568,
                                               0.050793663193303897,
                                               0.023087791209553992,
                                               0.01065889656610338,
                                               0.004947521422339475,
                                               0.002502167739741652,
                                               0.0003284209582695303,
                                               0.003402226781397109,
                                               -0.007952854446449574,
                                               0.018390659369666898,
                                               -0.03172341088255942,
                                               0.04306800687173906,
                                               -0.04490851290021751,
                                               0.03547663193832672,
                                               -0.02051854928124302,
                                               0.008229881033701113,
                                               -0.002051279321627658,
                                               0.00024234611662233074};
  return horner(a, T(1.0) - c);
}

/// beta(tau) = (1 - x cot x) / tau with x = theta/2, tau = theta^2 <= pi^2, which is the coefficient of [theta]^2 in the inverse Jacobians of the
/// exponential map:
/// a polynomial in tau / pi^2. Relative errors 1e-16 of beta, 1e-16 of its first and 1e-13 of its second derivative.
inline constexpr double pi2 = 9.869604401089358;
inline constexpr std::array<double, 17> beta_coefficients = {
    0.08333333333333333,   0.013707783890401885,    0.0032212001003309692,  0.0007947992671677545,  0.00019808975634538672, 4.9485407080237545e-05,
    1.236908047599942e-05, 3.0920454468611683e-06,  7.733326674972992e-07,  1.9236152992784547e-07, 5.02165098869927e-08,   9.074951172268584e-09,
    6.504254001622579e-09, -2.1533203222780574e-09, 1.8612786898539385e-09, -5.607199399762986e-10, 1.2460443110899903e-10};

template <class T>
T beta_of(const T& tau) {
  return horner(beta_coefficients, tau * T(1 / pi2));
}
/// The value and the first two derivatives in tau.
template <class T>
std::array<T, 3> beta_jet(const T& tau) {
  const T x = tau * T(1 / pi2);
  T f(beta_coefficients.back()), d(0.0), dd(0.0);
  for (std::size_t k = beta_coefficients.size() - 1; k > 0; --k) {
    dd = dd * x + d;
    d = d * x + f;
    f = f * x + T(beta_coefficients[k - 1]);
  }
  return {f, d * T(1 / pi2), dd * T(2 / (pi2 * pi2))};
}

}  // namespace karcher::shell
