#pragma once
/// \file
/// Jet<T, N>: a number with its exact first and second derivatives in N variables (forward mode). The scalar T is double or a Pack.

#include <array>
#include <cmath>
#include <cstddef>

#include "karcher/math/pack.hpp"

namespace karcher {

template <class T, int N>
struct Jet {
  using Scalar = T;
  static constexpr int variables = N;
  static constexpr int pairs = N * (N + 1) / 2;

  T v{};                                               ///< value
  std::array<T, static_cast<std::size_t>(N)> g{};      ///< first derivatives
  std::array<T, static_cast<std::size_t>(pairs)> h{};  ///< second derivatives, upper triangle by rows: see index()

  Jet() = default;
  Jet(double x) : v(x) {}
  Jet(int x) : v(static_cast<double>(x)) {}
  Jet(const T& x) requires(!std::is_same_v<T, double>) : v(x) {}

  /// The i-th variable at the value x.
  static Jet variable(const T& x, int i) {
    Jet r;
    r.v = x;
    r.g[static_cast<std::size_t>(i)] = T(1.0);
    return r;
  }
  /// Position of the pair i <= j in h.
  static constexpr std::size_t index(int i, int j) { return static_cast<std::size_t>(i * N - i * (i - 1) / 2 + (j - i)); }
  const T& hessian(int i, int j) const { return i <= j ? h[index(i, j)] : h[index(j, i)]; }
  const T& gradient(int i) const { return g[static_cast<std::size_t>(i)]; }

  Jet& operator+=(const Jet& b) {
    v += b.v;
    for (std::size_t i = 0; i < g.size(); ++i) g[i] += b.g[i];
    for (std::size_t i = 0; i < h.size(); ++i) h[i] += b.h[i];
    return *this;
  }
  Jet& operator-=(const Jet& b) {
    v -= b.v;
    for (std::size_t i = 0; i < g.size(); ++i) g[i] -= b.g[i];
    for (std::size_t i = 0; i < h.size(); ++i) h[i] -= b.h[i];
    return *this;
  }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend Jet operator-(Jet a) { return a.scale(T(-1.0)); }
  friend Jet operator+(Jet a, double b) {
    a.v += T(b);
    return a;
  }
  friend Jet operator+(double b, Jet a) {
    a.v += T(b);
    return a;
  }
  friend Jet operator-(Jet a, double b) {
    a.v -= T(b);
    return a;
  }
  friend Jet operator-(double b, Jet a) {
    a.scale(T(-1.0));
    a.v += T(b);
    return a;
  }
  friend Jet operator*(Jet a, double b) { return a.scale(T(b)); }
  friend Jet operator*(double b, Jet a) { return a.scale(T(b)); }
  friend Jet operator/(Jet a, double b) { return a.scale(T(1.0 / b)); }
  friend Jet operator*(Jet a, const T& b) requires(!std::is_same_v<T, double>) { return a.scale(b); }
  friend Jet operator*(const T& b, Jet a) requires(!std::is_same_v<T, double>) { return a.scale(b); }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet r;
    r.v = a.v * b.v;
    std::size_t k = 0;
    for (std::size_t i = 0; i < N; ++i) {
      r.g[i] = a.v * b.g[i] + b.v * a.g[i];
      for (std::size_t j = i; j < N; ++j, ++k) r.h[k] = a.v * b.h[k] + b.v * a.h[k] + (a.g[i] * b.g[j] + a.g[j] * b.g[i]);
    }
    return r;
  }
  friend Jet operator/(const Jet& a, const Jet& b) { return a * reciprocal(b); }
  friend Jet operator/(double a, const Jet& b) { return reciprocal(b).scale(T(a)); }
  friend Jet reciprocal(const Jet& b) {
    const T r = T(1.0) / b.v;
    return compose(b, r, -(r * r), T(2.0) * r * r * r);
  }

  /// Multiplies value and derivatives by a constant.
  Jet& scale(const T& s) {
    v *= s;
    for (auto& x : g) x *= s;
    for (auto& x : h) x *= s;
    return *this;
  }
};

/// s += a b.
template <class T, int N>
void add_product(Jet<T, N>& s, const Jet<T, N>& a, const Jet<T, N>& b) {
  s.v += a.v * b.v;
  std::size_t k = 0;
  for (std::size_t i = 0; i < N; ++i) {
    s.g[i] += a.v * b.g[i] + b.v * a.g[i];
    for (std::size_t j = i; j < N; ++j, ++k) s.h[k] += a.v * b.h[k] + b.v * a.h[k] + (a.g[i] * b.g[j] + a.g[j] * b.g[i]);
  }
}

/// s += w x^2.
template <class T, int N>
void add_square(Jet<T, N>& s, const Jet<T, N>& x, const T& w) {
  const T wx = w * x.v, slope = wx + wx, curvature = w + w;
  s.v += wx * x.v;
  std::size_t k = 0;
  for (std::size_t i = 0; i < N; ++i) {
    s.g[i] += slope * x.g[i];
    const T row = curvature * x.g[i];
    for (std::size_t j = i; j < N; ++j, ++k) s.h[k] += slope * x.h[k] + row * x.g[j];
  }
}

/// f(x) where f has the value f0 and the derivatives f1, f2 at x.v (chain rule).
template <class T, int N>
Jet<T, N> compose(const Jet<T, N>& x, const T& f0, const T& f1, const T& f2) {
  Jet<T, N> r;
  r.v = f0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < N; ++i) {
    r.g[i] = f1 * x.g[i];
    const T c = f2 * x.g[i];
    for (std::size_t j = i; j < N; ++j, ++k) r.h[k] = f1 * x.h[k] + c * x.g[j];
  }
  return r;
}

template <class T, int N>
struct lanes_of<Jet<T, N>> : lanes_of<T> {};

}  // namespace karcher
