#include "mesh/gauss.hpp"

#include <cmath>
#include <numbers>

namespace karcher {
namespace {

using Real = long double;

struct Polynomial {
  Real value, derivative;
};

/// Jacobi polynomial P_n^(alpha, 0) on [-1, 1] by its three-term recurrence (Abramowitz and Stegun 22.7.1), derivative by differentiating it.
Polynomial jacobi(int n, int alpha, Real x) {
  const Real a = alpha;
  Polynomial before{1, 0}, last{(a + 2) * x / 2 + a / 2, (a + 2) / 2};
  if (n == 0) return before;
  for (int i = 2; i <= n; ++i) {
    const Real k = i, s = 2 * k + a;
    const Real lead = 2 * k * (k + a) * (s - 2), slope = (s - 1) * s * (s - 2), shift = (s - 1) * a * a, back = 2 * (k + a - 1) * (k - 1) * s;
    const Real line = slope * x + shift;
    const Polynomial next{(line * last.value - back * before.value) / lead,
                          (slope * last.value + line * last.derivative - back * before.derivative) / lead};
    before = last;
    last = next;
  }
  return last;
}

}  // namespace

GaussRule gauss_jacobi(int n, int alpha) {
  GaussRule rule;
  std::vector<Real> roots;
  for (int k = 0; k < n; ++k) {
    // Newton's method on P / prod (x - found root), which cannot find a root twice; the start lies right of the root sought.
    Real x = -std::cos(std::numbers::pi_v<Real> * (k + Real(0.75)) / (n + Real(0.5)));
    if (!roots.empty()) x = (x + roots.back()) / 2;
    for (int iteration = 0; iteration < 100; ++iteration) {
      const Polynomial p = jacobi(n, alpha, x);
      Real deflation = 0;
      for (const Real root : roots) deflation += 1 / (x - root);
      const Real step = p.value / (p.derivative - deflation * p.value);
      x -= step;
      if (std::abs(step) < 4 * std::numeric_limits<Real>::epsilon()) break;
    }
    roots.push_back(x);
    // Weight of (1 - x)^alpha on [-1, 1]: 2^(alpha + 1) / ((1 - x^2) P'^2) for beta = 0 (Abramowitz and Stegun 25.4.33); on [0, 1] the power of 2
    // goes.
    const Real derivative = jacobi(n, alpha, x).derivative;
    rule.points.push_back(static_cast<double>((1 + x) / 2));
    rule.weights.push_back(static_cast<double>(1 / ((1 - x * x) * derivative * derivative)));
  }
  return rule;
}

}  // namespace karcher
