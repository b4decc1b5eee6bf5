#include "karcher/solve/dense.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "karcher/error.hpp"

// LAPACK, as Fortran compilers name it; the two lengths belong to the character arguments.
extern "C" void dsyev_(const char* job, const char* triangle, const int* n, double* a, const int* lda, double* w, double* work, const int* lwork,
                       int* info, std::size_t, std::size_t);

namespace karcher {

Spectrum symmetric_eigen(int n, std::vector<double> matrix) {
  Spectrum result;
  result.values.resize(static_cast<std::size_t>(n));
  if (n == 0) return result;
  const int room = 34 * n;
  int info = 0;
  std::vector<double> work(static_cast<std::size_t>(room));
  dsyev_("V", "U", &n, matrix.data(), &n, result.values.data(), work.data(), &room, &info, 1, 1);
  if (info != 0) throw Error("LAPACK found no eigenvalues of a small matrix.");
  result.vectors = std::move(matrix);
  return result;
}

DenseStep minimise_in_ball(const Spectrum& eigen, std::span<const double> b, double radius) {
  const std::size_t n = eigen.values.size();
  DenseStep step;
  step.y.assign(n, 0.0);
  if (n == 0) return step;
  std::vector<double> c(n, 0.0), z(n, 0.0);  // b and y in eigenvectors
  double size_b = 0;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) c[k] += eigen.vectors[k * n + i] * b[i];
    size_b += c[k] * c[k];
  }
  size_b = std::sqrt(size_b);
  const double lowest = eigen.values.front();
  const double scale = std::max({std::abs(lowest), std::abs(eigen.values.back()), size_b / radius, 1e-300});
  const double tiny = 1e-15 * scale;

  const auto fill = [&](double lambda) {
    double square = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double e = eigen.values[k] + lambda;
      z[k] = c[k] == 0 ? 0 : -c[k] / std::max(e, 1e-300);
      square += z[k] * z[k];
    }
    return std::sqrt(square);
  };

  double lambda = 0;
  if (lowest <= 0 || fill(0) > radius) {
    // |z(lambda)| falls monotonically on (-lowest, infinity): Newton on 1/|z| - 1/radius, inside a bracket.
    double low = std::max(0.0, -lowest), high = std::max(0.0, -lowest) + size_b / radius + tiny;
    lambda = low + tiny;
    if (fill(lambda) < radius) {
      // Hard case: the boundary is reached along the lowest eigenvector, in the direction that g does not forbid.
      double rest = 0;
      for (std::size_t k = 1; k < n; ++k) rest += z[k] * z[k];
      if (lowest < 0) z[0] = (z[0] < 0 ? -1.0 : 1.0) * std::sqrt(std::max(0.0, radius * radius - rest));
    } else {
      lambda = std::max(lambda, 0.5 * (low + high) * 1e-3 + low);
      for (int iteration = 0; iteration < 200; ++iteration) {
        const double size = fill(lambda);
        if (std::abs(size - radius) <= 1e-14 * radius) break;
        (size > radius ? low : high) = lambda;
        double slope = 0;
        for (std::size_t k = 0; k < n; ++k) slope += z[k] * z[k] / std::max(eigen.values[k] + lambda, 1e-300);
        double next = lambda + size * size / slope * (size - radius) / radius;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == lambda) break;
        lambda = next;
      }
      fill(lambda);
    }
  }
  step.multiplier = lambda;
  for (std::size_t k = 0; k < n; ++k) {
    step.decrease -= z[k] * (c[k] + 0.5 * eigen.values[k] * z[k]);
    for (std::size_t i = 0; i < n; ++i) step.y[i] += eigen.vectors[k * n + i] * z[k];
  }
  return step;
}

}  // namespace karcher
