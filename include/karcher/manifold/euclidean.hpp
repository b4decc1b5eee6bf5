#pragma once
/// \file
/// Euclidean<N>: R^N with its usual metric. exp_p(a) = p + a, log_p(q) = q - p; every point is its own projection.

#include <limits>

#include "karcher/manifold/traits.hpp"

namespace karcher {

template <int N>
struct Euclidean {
  static_assert(N >= 1 && N <= 3, "Euclidean<N> is named for N = 1, 2, 3");
  static constexpr std::string_view name = N == 1 ? "R1" : N == 2 ? "R2" : "R3";
  static constexpr std::string_view description = N == 1 ? "the real line" : N == 2 ? "the Euclidean plane" : "Euclidean space";
  static constexpr int ambient = N;
  static constexpr int dim = N;
  static constexpr double injectivity_radius = std::numeric_limits<double>::infinity();
  static constexpr bool linear = true;

  static Vec<double, N> origin() { return {}; }
  static Drawing drawing() { return {.place = true}; }
  template <class T>
  static Vec<T, N> exp(const Vec<T, N>& p, const Vec<T, N>& a) {
    return p + a;
  }
  template <class T>
  static Vec<T, N> log(const Vec<T, N>& p, const Vec<T, N>& q) {
    return q - p;
  }
  template <class T>
  static T inner(const Vec<T, N>&, const Vec<T, N>& a, const Vec<T, N>& b) {
    return karcher::dot(a, b);
  }
  template <class T>
  static Mat<T, N, N> frame(const Vec<T, N>&) {
    return identity<T, N>();
  }
  template <class T>
  static Vec<T, N> project(const Vec<T, N>& x) {
    return x;
  }
  template <class T>
  static Vec<T, N> chord(const Vec<T, N>& q, const Vec<T, N>& p) {
    return p - q;
  }
  /// Distance of an ambient vector from the manifold: none.
  static double defect(const Vec<double, N>&) { return 0; }
};

static_assert(HasProjection<Euclidean<1>> && HasProjection<Euclidean<2>> && HasProjection<Euclidean<3>>);

}  // namespace karcher
