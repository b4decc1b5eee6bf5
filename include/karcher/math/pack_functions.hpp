#pragma once
/// \file
/// exp and log of a Pack, all lanes at once, to about one unit in the last place (Cody and Waite, "Software Manual for the Elementary Functions", 1980).

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "karcher/math/pack.hpp"

namespace karcher::pack_functions {

inline constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;  // high part with 21 trailing zero bits
inline constexpr double shift = 0x1.8p52;                                                  // x + shift - shift rounds to the nearest whole number

/// 2^k for whole numbers -1022 <= k <= 1023, given as k + shift.
template <int W>
Pack<W> power_of_two(Pack<W> k_shifted) {
  using Truth = typename pack_detail::Native<W>::Truth;
  const Truth bits = ((Truth)k_shifted.v + 1023) << 52;
  return Pack<W>((typename Pack<W>::Native)bits);
}

template <int W>
Pack<W> exp(Pack<W> x) {
  // Comparisons with NaN are false, so NaN passes both limits and comes out.
  x = select(x > Pack<W>(1000.0), Pack<W>(1000.0), select(x < Pack<W>(-1000.0), Pack<W>(-1000.0), x));
  const Pack<W> k = x * Pack<W>(1.4426950408889634074) + Pack<W>(shift) - Pack<W>(shift);
  const Pack<W> r = (x - k * Pack<W>(ln2_high)) - k * Pack<W>(ln2_low);
  double c = 1;
  std::array<double, 14> inverse_factorial{};
  for (std::size_t i = 0; i < inverse_factorial.size(); ++i) {
    if (i > 0) c /= static_cast<double>(i);
    inverse_factorial[i] = c;
  }
  Pack<W> s = Pack<W>(inverse_factorial[13]);
  for (std::size_t i = 13; i-- > 0;) s = s * r + Pack<W>(inverse_factorial[i]);
  // Two factors, because 2^k alone may be out of range where the product is not.
  const Pack<W> half = k * Pack<W>(0.5) + Pack<W>(shift) - Pack<W>(shift);
  return s * power_of_two(half + Pack<W>(shift)) * power_of_two((k - half) + Pack<W>(shift));
}

template <int W>
Pack<W> log(Pack<W> x) {
  using Truth = typename pack_detail::Native<W>::Truth;
  const Mask<W> normal = (x >= Pack<W>(std::numeric_limits<double>::min())) & (x <= Pack<W>(std::numeric_limits<double>::max()));
  if (!all(normal)) {
    Pack<W> r;
    for (int l = 0; l < W; ++l) r.set(l, std::log(x[l]));
    return r;
  }
  // x = m 2^e with m in [sqrt(1/2), sqrt(2))
  constexpr std::int64_t sqrt_half = 0x3fe6a09e667f3bcd;
  const Truth moved = (Truth)x.v - sqrt_half;
  const Truth exponent = moved >> 52;
  const Pack<W> m((typename Pack<W>::Native)((Truth)x.v - (exponent << 52)));
  const Pack<W> e = Pack<W>((typename Pack<W>::Native)(exponent + 0x4338000000000000)) - Pack<W>(shift);
  const Pack<W> f = m - Pack<W>(1.0);
  const Pack<W> s = f / (Pack<W>(2.0) + f), z = s * s;
  Pack<W> t = Pack<W>(2.0 / 23);
  for (int k = 10; k > 0; --k) t = t * z + Pack<W>(2.0 / (2 * k + 1));
  // log m = 2 atanh s = f - s (f - z t), where f is exact
  return e * Pack<W>(ln2_high) + (f - (s * (f - z * t) - e * Pack<W>(ln2_low)));
}

}  // namespace karcher::pack_functions
