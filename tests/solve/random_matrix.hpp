#pragma once
// Symmetric matrices with chosen eigenvalues.

#include <cmath>
#include <random>
#include <vector>

namespace karcher::testing {

inline std::vector<double> random_vector(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v) x = normal(generator);
  return v;
}

/// Q diag(eigenvalues) Q^T with Q a product of random reflections; row-major. columns: Q, column k at k * n.
inline std::vector<double> matrix_with(const std::vector<double>& eigenvalues, unsigned seed, std::vector<double>* columns = nullptr) {
  const std::size_t n = eigenvalues.size();
  std::vector<double> q(n * n, 0.0);
  for (std::size_t k = 0; k < n; ++k) q[k * n + k] = 1;
  for (unsigned r = 0; r < 6; ++r) {
    const std::vector<double> v = random_vector(static_cast<int>(n), seed * 100 + r);
    double square = 0;
    for (double x : v) square += x * x;
    for (std::size_t k = 0; k < n; ++k) {
      double product = 0;
      for (std::size_t i = 0; i < n; ++i) product += v[i] * q[k * n + i];
      for (std::size_t i = 0; i < n; ++i) q[k * n + i] -= 2 * product / square * v[i];
    }
  }
  std::vector<double> a(n * n, 0.0);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) a[i * n + j] += eigenvalues[k] * q[k * n + i] * q[k * n + j];
  if (columns) *columns = q;
  return a;
}

}  // namespace karcher::testing
