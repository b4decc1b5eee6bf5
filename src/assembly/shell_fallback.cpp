#include "assembly/shell_fallback.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "assembly/shell_series.hpp"

namespace karcher::shell {
namespace {

Vec3<double> logarithm(const Vec<double, 4>& at, const double* q) {
  const Vec<double, 4> p = relative_quaternion(at, Vec<double, 4>{{q[0], q[1], q[2], q[3]}});
  const double f = (p[0] < 0 ? -1 : 1) * angle_over_sine(std::fabs(p[0]));
  return {{f * p[1], f * p[2], f * p[3]}};
}

}  // namespace

bool closest_rotation(const double (*q)[4], const double* l, int n, double* found) {
  double a[4][4] = {}, v[4][4] = {};
  for (int i = 0; i < n; ++i)
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) a[r][c] += l[i] * q[i][r] * q[i][c];
  for (int r = 0; r < 4; ++r) v[r][r] = 1;
  // Cyclic Jacobi: Golub, Van Loan, "Matrix Computations", 8.5.
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0, norm = 0;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) (r == c ? norm : off) += a[r][c] * a[r][c];
    if (off <= 1e-32 * norm) break;
    for (int r = 0; r < 3; ++r)
      for (int c = r + 1; c < 4; ++c) {
        if (a[r][c] == 0) continue;
        const double tau = (a[c][c] - a[r][r]) / (2 * a[r][c]);
        const double t = std::copysign(1 / (std::fabs(tau) + std::hypot(1.0, tau)), tau), cs = 1 / std::hypot(1.0, t), sn = t * cs;
        for (int k = 0; k < 4; ++k) {
          const double x = a[k][r], y = a[k][c];
          a[k][r] = cs * x - sn * y;
          a[k][c] = sn * x + cs * y;
        }
        for (int k = 0; k < 4; ++k) {
          const double x = a[r][k], y = a[c][k];
          a[r][k] = cs * x - sn * y;
          a[c][k] = sn * x + cs * y;
        }
        for (int k = 0; k < 4; ++k) {
          const double x = v[k][r], y = v[k][c];
          v[k][r] = cs * x - sn * y;
          v[k][c] = sn * x + cs * y;
        }
      }
  }
  int first = 0, second = 1;
  if (a[second][second] > a[first][first]) std::swap(first, second);
  for (int k = 2; k < 4; ++k) {
    if (a[k][k] > a[first][first]) {
      second = first;
      first = k;
    } else if (a[k][k] > a[second][second]) {
      second = k;
    }
  }
  const bool defined = a[first][first] - a[second][second] > 1e-8;
  for (int k = 0; k < 4; ++k) found[k] = defined ? v[k][first] : (k == 0 ? 1.0 : 0.0);
  return defined;
}

bool riemannian_mean(const double (*q)[4], const double* l, int n, double* found) {
  std::copy_n(std::array<double, 4>{1, 0, 0, 0}.begin(), 4, found);
  Vec<double, 4> at{{1, 0, 0, 0}};
  double start[4];
  if (closest_rotation(q, l, n, start)) at = {{start[0], start[1], start[2], start[3]}};
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
    const double det = determinant(g), minor = g(0, 0) * g(1, 1) - g(0, 1) * g(1, 0);
    const bool positive = g(0, 0) > 1e-9 && minor > 1e-9 && det > 1e-9;
    if (settled) {
      for (int k = 0; k < 4; ++k) found[k] = at[k];
      if (!positive) std::copy_n(std::array<double, 4>{1, 0, 0, 0}.begin(), 4, found);
      return positive;
    }
    Vec3<double> w = sum;
    if (positive) w = inverse(g) * sum;
    const double length = std::sqrt(norm2(w));
    if (!std::isfinite(length)) return false;
    settled = positive && length < 1e-8;
    if (!positive || length > 1) w = (1 / std::max(1.0, length)) * w;
    const double scale = 1 / std::sqrt(1 + 0.25 * norm2(w));
    at = quaternion_product(at, Vec<double, 4>{{scale, 0.5 * scale * w[0], 0.5 * scale * w[1], 0.5 * scale * w[2]}});
  }
  return false;
}

bool unique_mean(const double (*q)[4], int n) {
  std::array<double, 16> l{};
  l.fill(1.0 / n);
  double mean[4];
  if (!riemannian_mean(q, l.data(), n, mean)) return false;
  for (int i = 0; i < n; ++i) {
    const Vec3<double> t = logarithm(Vec<double, 4>{{mean[0], mean[1], mean[2], mean[3]}}, q[i]);
    if (!(norm2(t) < 0.25 * pi2 * (1 - 1e-10))) return false;
  }
  return true;
}

}  // namespace karcher::shell
