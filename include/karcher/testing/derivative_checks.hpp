#pragma once
/// \file
/// Are the derivatives those of the function? Taylor's theorem measured: along a line, the remainder of the expansion to first (second) order must shrink like
/// the second (third) power of the step. A wrong gradient gives the slope 1, a wrong Hessian 2, and no tolerance hides it.
///
///     const TaylorSlopes s = taylor_slopes([&](double t) { return energy(retract(u, t * v)); }, energy(u), dot(g, v), dot(v, H * v));
///     EXPECT_TRUE(s.hessian_holds()) << s.sentence();

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace karcher {

struct TaylorSlopes {
  double value = 0;     ///< order of f(t) - f(0): 1, more where the first derivative vanishes
  double gradient = 0;  ///< order of f(t) - f(0) - t f'(0): at least 2
  double hessian = 0;   ///< order of f(t) - f(0) - t f'(0) - t^2/2 f''(0): at least 3
  std::vector<double> steps, gradient_remainders, hessian_remainders;

  bool gradient_holds(double slack = 0.15) const { return gradient > 2 - slack; }
  bool hessian_holds(double slack = 0.15) const { return gradient_holds(slack) && hessian > 3 - slack; }
  std::string sentence() const {
    return "Taylor remainders shrink with the orders " + std::to_string(gradient) + " (gradient, 2 expected) and " + std::to_string(hessian) +
           " (Hessian, 3 expected)";
  }
};

namespace derivative_detail {

/// Order in which the remainders vanish, from the smallest steps that still stand above rounding (floor); infinite where all are rounding.
inline double order(const std::vector<double>& steps, const std::vector<double>& remainders, double floor) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (!(remainders[i] == remainders[i])) return std::numeric_limits<double>::quiet_NaN();
    if (remainders[i + 1] < floor) break;
    slopes.push_back(std::log(remainders[i] / remainders[i + 1]) / std::log(steps[i] / steps[i + 1]));
  }
  if (slopes.empty()) return std::numeric_limits<double>::infinity();
  // The median of the five last: up to two of them may sit where a remainder changes its sign.
  const std::size_t last = std::min<std::size_t>(5, slopes.size());
  std::sort(slopes.end() - static_cast<std::ptrdiff_t>(last), slopes.end());
  return slopes[slopes.size() - 1 - (last - 1) / 2];
}

}  // namespace derivative_detail

/// \param f        the function along a line, f(0) = value
/// \param first    f'(0)
/// \param second   f''(0); without meaning for the `gradient` slope
/// \param largest  first step; halved 17 times
/// \param rounding rounding error of f; remainders below say nothing. 0: a hundred units in the last place of f
template <class F>
TaylorSlopes taylor_slopes(const F& f, double value, double first, double second, double largest = 0.1, double rounding = 0) {
  TaylorSlopes s;
  std::vector<double> differences;
  double size = std::abs(value);
  double t = largest;
  for (int k = 0; k < 18; ++k, t /= 2) {
    const double d = f(t) - value;
    size = std::max(size, std::abs(d));
    s.steps.push_back(t);
    differences.push_back(std::abs(d));
    s.gradient_remainders.push_back(std::abs(d - t * first));
    s.hessian_remainders.push_back(std::abs(d - t * first - 0.5 * t * t * second));
  }
  const double floor = rounding > 0 ? rounding : 100 * std::numeric_limits<double>::epsilon() * std::max(size, largest * std::abs(first));
  s.value = derivative_detail::order(s.steps, differences, floor);
  s.gradient = derivative_detail::order(s.steps, s.gradient_remainders, floor);
  s.hessian = derivative_detail::order(s.steps, s.hessian_remainders, floor);
  return s;
}

}  // namespace karcher
