#pragma once
/// \file
/// Formulas whose derivatives are tested, and places to take them at.

#include <algorithm>
#include <array>
#include <cmath>

#include "karcher/expression/symbols.hpp"

namespace karcher::testing {

constexpr int width = lanes<NativeScalar>;
using PackJet = Jet<NativeScalar, 3>;

inline Program compile(const std::string& text) {
  Symbols symbols({"x", "y", "z"});
  symbols.define("a", 1.3);
  symbols.define("r2", symbols.compile("x^2 + y^2"));
  return symbols.link(symbols.compile(text));
}

using Point = std::array<double, 3>;
inline Point point(int lane) { return {0.3 + 0.05 * lane, -0.7 + 0.03 * lane, 1.9 - 0.1 * lane}; }

/// The variables with a point in every lane.
template <class S, class At>
std::array<S, 3> in_lanes(const At& at) {
  std::array<S, 3> s;
  for (std::size_t i = 0; i < 3; ++i) {
    NativeScalar x;
    for (int l = 0; l < width; ++l) set_lane(x, l, at(l)[i]);
    s[i] = constant<S>(x);
    if constexpr (requires { s[i].d; }) s[i].d[i] = NativeScalar(1.0);
    if constexpr (requires { s[i].g; }) s[i].g[i] = NativeScalar(1.0);
  }
  return s;
}

inline const char* const smooth[] = {"2*x/(r2 + 1)",
                                     "(r2 - 1)/(r2 + 1)",
                                     "sin(a*x)*cos(y) + tan(z/3)",
                                     "exp(-r2)*log(z + 2) + ln(z) + log2(z)*log10(z)",
                                     "atan2(y, x) + atan(z)",
                                     "asin(x/2) + acos(y/2)",
                                     "sinh(x)*cosh(y) - tanh(z)",
                                     "asinh(x) + acosh(z + 1) + atanh(y/2)",
                                     "sqrt(r2 + z)^3",
                                     "pow(z, 1.5) + z^x + (x + y)^2 + (z - y)^-1.5",
                                     "x^3*y^4 - (x*y)^3 + (x - z)^4",
                                     "2^-x + z^2^x + _e^(x*y)",
                                     "abs(y)*sign(y)*x + rint(z) + ceil(y)",
                                     "min(x, y, z)*y + max(x, y*y)*z",
                                     "sum(x, y*x, z) + avg(x*x, y)",
                                     "mod(z, 1)*x + floor(x)",
                                     "x < 0.42 ? x^2*y : 1/(z + x)",
                                     "(x > 0.37 && y > 0) || z > 1.75 ? -x*y : x*z",
                                     "(x <= y) + (x >= y)*z - (x != y)*(x == x)",
                                     "3 - x*y + (1 - y)/(2 - x*y) - 1/z - (z - x*y)*4/5",
                                     "x",
                                     "pi"};

/// Lane 0 is singular, the others are not.
inline Point singular(int lane) { return lane == 0 ? Point{0, 0, 0} : point(lane); }

inline bool is_finite(const PackJet& j, int l) {
  const auto finite = [l](const NativeScalar& x) { return std::isfinite(lane(x, l)); };
  return finite(j.v) && std::all_of(j.g.begin(), j.g.end(), finite) && std::all_of(j.h.begin(), j.h.end(), finite);
}

/// 7x in lane 0, x/r elsewhere.
inline const char* const with_singular_branches[] = {"r2 > 0 ? x/sqrt(r2) : 7*x", "r2 == 0 ? 7*x : sqrt(r2)*x/r2",
                                                     "x > 0 ? (z > 1e9 ? 1/(x - x) : x/sqrt(r2)) : 7*x"};

}  // namespace karcher::testing
