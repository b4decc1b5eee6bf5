#pragma once
/// \file
/// Quantity: something that follows from a point of a manifold, for probes and files.

#include <algorithm>
#include <string>

#include "karcher/math/tensor.hpp"

namespace karcher {

struct Quantity {
  std::string name;  ///< in problem files and in results
  int components = 1;
  void (*value)(const double* p, double* out) = nullptr;  ///< of ambient coordinates
};

/// The quantity f(p), a Vec, of points with N ambient coordinates; f is a lambda that captures nothing.
template <int N, class F>
Quantity quantity(std::string name, F) {
  return {std::move(name), static_cast<int>(decltype(F{}(Vec<double, N>{}))::size()), [](const double* p, double* out) {
            Vec<double, N> point;
            std::copy_n(p, N, point.e.begin());
            std::ranges::copy(F{}(point).e, out);
          }};
}

}  // namespace karcher
