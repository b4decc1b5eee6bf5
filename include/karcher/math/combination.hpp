#pragma once
/// \file
/// Combination<T, N>: a linear combination of a few of N variables, with a constant: v + sum_k slope[k] (x_index[k] - value of it there). Densities of strains are sums of
/// squares and products of such, each of which concerns few of the second derivatives of a Jet<T, N>.

#include <array>
#include <cstddef>

#include "karcher/math/jet.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

/// T: double or a pack. An index stands once; an unlisted variable has the slope 0.
template <class T, int N>
struct Combination {
  T v = T(0.0);
  int count = 0;
  std::array<int, static_cast<std::size_t>(N)> index;
  std::array<T, static_cast<std::size_t>(N)> slope;

  Combination() {}
  explicit Combination(double x) : v(x) {}
  // Only what is used is copied.
  Combination(const Combination& other) { *this = other; }
  Combination& operator=(const Combination& other) {
    v = other.v;
    count = other.count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      index[k] = other.index[k];
      slope[k] = other.slope[k];
    }
    return *this;
  }
  /// The variable i.
  static Combination variable(const T& x, int i) {
    Combination c;
    c.v = x;
    c.add(i, T(1.0));
    return c;
  }
  void add(int i, const T& s) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      if (index[k] == i) {
        slope[k] += s;
        return;
      }
    index[static_cast<std::size_t>(count)] = i;
    slope[static_cast<std::size_t>(count++)] = s;
  }
  Combination& operator+=(const Combination& other) {
    v += other.v;
    for (std::size_t k = 0; k < static_cast<std::size_t>(other.count); ++k) add(other.index[k], other.slope[k]);
    return *this;
  }
  Combination& operator-=(const Combination& other) { return *this += -other; }
  Combination operator-() const { return scaled(*this, T(-1.0)); }
  friend Combination operator+(Combination a, const Combination& b) { return a += b; }
  friend Combination operator-(Combination a, const Combination& b) { return a -= b; }
  friend Combination operator-(Combination a, double b) {
    a.v -= T(b);
    return a;
  }
  friend Combination scaled(Combination a, const T& s) {
    a.v *= s;
    for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) a.slope[k] *= s;
    return a;
  }
};

template <class T, int N>
struct base_of<Combination<T, N>> : base_of<T> {};
template <class T, int N>
const T& base(const Combination<T, N>& x) {
  return x.v;
}
template <class T, int N>
Combination<T, N> select(const MaskOf<T>& m, Combination<T, N> a, const Combination<T, N>& b) {
  a.v = select(m, a.v, b.v);
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) a.slope[k] = select(m, a.slope[k], T(0.0));
  for (std::size_t k = 0; k < static_cast<std::size_t>(b.count); ++k) a.add(b.index[k], select(m, T(0.0), b.slope[k]));
  return a;
}

template <class T, int N>
T& entry(Jet<T, N>& s, int i, int j) {
  return s.h[i <= j ? Jet<T, N>::index(i, j) : Jet<T, N>::index(j, i)];
}

/// s += w x
template <class T, int N>
void add_scaled(Dual<T, N>& s, const Combination<T, N>& x, const T& w) {
  s.v += w * x.v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) s.d[static_cast<std::size_t>(x.index[k])] += w * x.slope[k];
}
template <class T, int N>
void add_scaled(Jet<T, N>& s, const Combination<T, N>& x, const T& w) {
  s.v += w * x.v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) s.g[static_cast<std::size_t>(x.index[k])] += w * x.slope[k];
}

/// s += w x^2
template <class T, int N>
void add_square(Dual<T, N>& s, const Combination<T, N>& x, const T& w) {
  const T twice = T(2.0) * w * x.v;
  s.v += w * x.v * x.v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) s.d[static_cast<std::size_t>(x.index[k])] += twice * x.slope[k];
}
template <class T, int N>
void add_square(Jet<T, N>& s, const Combination<T, N>& x, const T& w) {
  const T twice = T(2.0) * w * x.v;
  s.v += w * x.v * x.v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) {
    s.g[static_cast<std::size_t>(x.index[k])] += twice * x.slope[k];
    const T row = T(2.0) * w * x.slope[k];
    for (std::size_t l = k; l < static_cast<std::size_t>(x.count); ++l) entry(s, x.index[k], x.index[l]) += row * x.slope[l];
  }
}

/// s += a b
template <class T, int N>
void add_product(Dual<T, N>& s, const Combination<T, N>& a, const Combination<T, N>& b) {
  s.v += a.v * b.v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) s.d[static_cast<std::size_t>(a.index[k])] += b.v * a.slope[k];
  for (std::size_t l = 0; l < static_cast<std::size_t>(b.count); ++l) s.d[static_cast<std::size_t>(b.index[l])] += a.v * b.slope[l];
}
template <class T, int N>
void add_product(Jet<T, N>& s, const Combination<T, N>& a, const Combination<T, N>& b) {
  s.v += a.v * b.v;
  for (std::size_t l = 0; l < static_cast<std::size_t>(b.count); ++l) s.g[static_cast<std::size_t>(b.index[l])] += a.v * b.slope[l];
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) {
    s.g[static_cast<std::size_t>(a.index[k])] += b.v * a.slope[k];
    for (std::size_t l = 0; l < static_cast<std::size_t>(b.count); ++l)
      entry(s, a.index[k], b.index[l]) += a.index[k] == b.index[l] ? T(2.0) * a.slope[k] * b.slope[l] : a.slope[k] * b.slope[l];
  }
}
/// s += a b for b with second derivatives
template <class T, int N>
void add_product(Dual<T, N>& s, const Combination<T, N>& a, const Dual<T, N>& b) {
  s.v += a.v * b.v;
  for (std::size_t i = 0; i < b.d.size(); ++i) s.d[i] += a.v * b.d[i];
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) s.d[static_cast<std::size_t>(a.index[k])] += b.v * a.slope[k];
}
template <class T, int N>
void add_product(Jet<T, N>& s, const Combination<T, N>& a, const Jet<T, N>& b) {
  s.v += a.v * b.v;
  for (std::size_t i = 0; i < b.g.size(); ++i) s.g[i] += a.v * b.g[i];
  for (std::size_t i = 0; i < b.h.size(); ++i) s.h[i] += a.v * b.h[i];
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) {
    s.g[static_cast<std::size_t>(a.index[k])] += b.v * a.slope[k];
    for (int i = 0; i < N; ++i) entry(s, a.index[k], i) += (i == a.index[k] ? T(2.0) : T(1.0)) * a.slope[k] * b.g[static_cast<std::size_t>(i)];
  }
}

}  // namespace karcher
