#pragma once
/// \file
/// Random numbers that are the same with every compiler and library (the distributions of <random> are not).

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "karcher/math/tensor.hpp"

namespace karcher {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double a, double b) { return a + (b - a) * uniform(); }
  /// Logarithm uniform in [a, b], 0 < a < b.
  double log_uniform(double a, double b) { return a * std::exp(uniform() * std::log(b / a)); }
  /// Box and Muller.
  double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
  template <int N>
  Vec<double, N> normal_vector() {
    Vec<double, N> v;
    for (int i = 0; i < N; ++i) v[i] = normal();
    return v;
  }
  /// Uniform on the unit sphere.
  template <int N>
  Vec<double, N> direction() {
    for (;;) {
      const Vec<double, N> v = normal_vector<N>();
      if (const double r = std::sqrt(norm2(v)); r > 1e-6) return (1 / r) * v;
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace karcher
