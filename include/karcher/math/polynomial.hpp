#pragma once
/// \file
/// Polynomials with constant coefficients at plain scalars.

#include <array>
#include <cstddef>
#include <utility>

namespace karcher {

/// sum_j c_j x^j. Two nested forms in x^2, for the even and for the odd powers, run side by side: half the latency of one in x, and the same accuracy where
/// the terms fall off.
template <std::size_t N, class T>
T polynomial(const std::array<double, N>& c, const T& x) {
  if constexpr (N <= 6) {
    T s = T(c[N - 1]);
    for (std::size_t j = N - 1; j-- > 0;) s = s * x + T(c[j]);
    return s;
  } else {
    const T y = x * x;
    constexpr std::size_t top_even = (N - 1) / 2 * 2, top_odd = (N - 2) / 2 * 2 + 1;
    T even = T(c[top_even]), odd = T(c[top_odd]);
#pragma GCC unroll 32
    for (std::size_t j = top_even; j >= 2; j -= 2) even = even * y + T(c[j - 2]);
#pragma GCC unroll 32
    for (std::size_t j = top_odd; j >= 3; j -= 2) odd = odd * y + T(c[j - 2]);
    return even + x * odd;
  }
}

}  // namespace karcher
