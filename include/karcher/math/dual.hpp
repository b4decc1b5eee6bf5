#pragma once
/// \file
/// Dual<U, D>: a number with its first derivatives in D directions. The scalar U may be a Jet: Dual<Jet<T, N>, D> carries the mixed third
/// derivatives that the second variation of a field's gradient needs.

#include <array>
#include <cstddef>

#include "karcher/math/jet.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class U, int D>
struct Dual {
  using Scalar = U;
  U v{};
  std::array<U, static_cast<std::size_t>(D)> d{};

  Dual() = default;
  Dual(double x) : v(x) {}
  Dual(int x) : v(static_cast<double>(x)) {}
  Dual(const U& x) requires(!std::is_same_v<U, double>) : v(x) {}

  Dual& operator+=(const Dual& b) {
    v += b.v;
    for (std::size_t i = 0; i < D; ++i) d[i] += b.d[i];
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    v -= b.v;
    for (std::size_t i = 0; i < D; ++i) d[i] -= b.d[i];
    return *this;
  }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator-(Dual a) {
    a.v = -a.v;
    for (auto& x : a.d) x = -x;
    return a;
  }
  friend Dual operator+(Dual a, double b) {
    a.v = a.v + b;
    return a;
  }
  friend Dual operator+(double b, Dual a) {
    a.v = a.v + b;
    return a;
  }
  friend Dual operator-(Dual a, double b) {
    a.v = a.v - b;
    return a;
  }
  friend Dual operator-(double b, Dual a) { return -(a - b); }
  friend Dual operator*(Dual a, double b) {
    a.v = a.v * b;
    for (auto& x : a.d) x = x * b;
    return a;
  }
  friend Dual operator*(double b, Dual a) { return a * b; }
  friend Dual operator/(Dual a, double b) { return a * (1.0 / b); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    for (std::size_t i = 0; i < D; ++i) {
      r.d[i] = a.v * b.d[i];
      add_product(r.d[i], a.d[i], b.v);
    }
    return r;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const U r = U(1.0) / b.v;
    return chain(b, r, -(r * r)) * a;
  }
  friend Dual operator/(double a, const Dual& b) { return Dual(a) / b; }
};

/// s += a b.
template <class U, int D>
void add_product(Dual<U, D>& s, const Dual<U, D>& a, const Dual<U, D>& b) {
  add_product(s.v, a.v, b.v);
  for (std::size_t i = 0; i < D; ++i) {
    add_product(s.d[i], a.v, b.d[i]);
    add_product(s.d[i], a.d[i], b.v);
  }
}

/// f(x) where f has the value f0 and the derivative f1 at x.v (chain rule).
template <class U, int D>
Dual<U, D> chain(const Dual<U, D>& x, const U& f0, const U& f1) {
  Dual<U, D> r;
  r.v = f0;
  for (std::size_t i = 0; i < D; ++i) r.d[i] = f1 * x.d[i];
  return r;
}

template <class U, int D>
struct lanes_of<Dual<U, D>> : lanes_of<U> {};

}  // namespace karcher
