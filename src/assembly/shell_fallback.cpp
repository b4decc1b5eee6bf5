#include "assembly/shell_fallback.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "assembly/shell_series.hpp"
#include "karcher/manifold/polar.hpp"

namespace karcher::shell {
namespace {

const Quaternion<double> unity{{1, 0, 0, 0}};

Vec3<double> logarithm(const Quaternion<double>& at, const Quaternion<double>& q) {
  const Quaternion<double> p = quaternion_product(conjugate(at), q);
  const double f = (p[0] < 0 ? -1 : 1) * angle_over_sine(std::fabs(p[0]));
  return {{f * p[1], f * p[2], f * p[3]}};
}

}  // namespace

bool closest_rotation(const Quaternion<double>* q, const double* l, int n, Quaternion<double>& found) {
  Mat3<double> a;
  for (int i = 0; i < n; ++i) a += l[i] * rotation_matrix(q[i]);
  found = unity;
  if (!std::isfinite(norm2(a))) return false;
  const PolarFactor<double> f = polar_factor(a);
  if (f.defined) found = f.q;
  return f.defined;
}

bool riemannian_mean(const Quaternion<double>* q, const double* l, int n, Quaternion<double>& found) {
  Quaternion<double> at;
  closest_rotation(q, l, n, at);
  found = unity;
  bool settled = false;
  for (int iteration = 0; iteration < 100; ++iteration) {
    Vec3<double> sum;
    Mat3<double> g;
    for (int i = 0; i < n; ++i) {
      const Vec3<double> t = logarithm(at, q[i]);
      const double tau = norm2(t), beta = beta_of(tau);
      sum += l[i] * t;
      g += (l[i] * beta) * outer(t, t);
      for (int k = 0; k < 3; ++k) g(k, k) += l[i] * (1 - beta * tau);
    }
    const double minor = g(0, 0) * g(1, 1) - g(0, 1) * g(1, 0);
    const bool positive = g(0, 0) > 0 && minor > 1e-12 && determinant(g) > 1e-6 * minor;
    if (settled) {
      if (positive) found = at;
      return positive;
    }
    Vec3<double> w = sum;
    if (positive) w = inverse(g) * sum;
    const double length = std::sqrt(norm2(w));
    if (!std::isfinite(length)) return false;
    settled = positive && length < 1e-8;
    if (!positive || length > 1) w = (1 / std::max(1.0, length)) * w;
    at = quaternion_product(at, quaternion_of_rotation_vector(w));
  }
  return false;
}

bool unique_mean(const Quaternion<double>* q, int n) {
  std::array<double, 16> l{};
  l.fill(1.0 / n);
  Quaternion<double> mean;
  if (!riemannian_mean(q, l.data(), n, mean)) return false;
  return std::all_of(q, q + n, [&](const Quaternion<double>& x) { return norm2(logarithm(mean, x)) < 0.25 * pi2 * (1 - 1e-10); });
}

}  // namespace karcher::shell
