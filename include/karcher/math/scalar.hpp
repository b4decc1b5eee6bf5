#pragma once
/// \file
/// What every scalar has in common: the plain value inside (double or Pack), a choice by the plain value, order.
///
/// Scalars are double, Pack<W>, Jet<T, N> and Dual<U, D>, nested as their headers say. Comparisons look at the plain value only, so a Jet takes the
/// branch that its value takes; the answer is a bool or a Mask.

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "karcher/math/dual.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

/// The double or Pack at the bottom of a scalar.
template <class T>
struct base_of {
  using type = T;
};
template <class T, int N>
struct base_of<Jet<T, N>> : base_of<T> {};
template <class U, int D>
struct base_of<Dual<U, D>> : base_of<U> {};
template <class T>
using Base = typename base_of<T>::type;

/// True for scalars without derivatives.
template <class T>
inline constexpr bool is_base = std::is_same_v<T, Base<T>>;

inline const double& base(const double& x) { return x; }
template <int W>
const Pack<W>& base(const Pack<W>& x) {
  return x;
}
template <class T, int N>
const T& base(const Jet<T, N>& x) {
  return x.v;
}
template <class U, int D>
const Base<U>& base(const Dual<U, D>& x) {
  return base(x.v);
}

/// A plain value as a scalar X without derivatives.
template <class X>
X constant(const Base<X>& x) {
  if constexpr (is_base<X>) {
    return x;
  } else {
    X r;
    r.v = constant<std::remove_cvref_t<decltype(r.v)>>(x);
    return r;
  }
}

/// Truth value of comparisons of T: bool or Mask.
template <class T>
using MaskOf = decltype(std::declval<const Base<T>&>() < std::declval<const Base<T>&>());

/// m ? a : b, lane by lane, derivatives with the value.
template <class T, int N>
Jet<T, N> select(const MaskOf<T>& m, const Jet<T, N>& a, const Jet<T, N>& b) {
  Jet<T, N> r;
  r.v = select(m, a.v, b.v);
  for (std::size_t i = 0; i < r.g.size(); ++i) r.g[i] = select(m, a.g[i], b.g[i]);
  for (std::size_t i = 0; i < r.h.size(); ++i) r.h[i] = select(m, a.h[i], b.h[i]);
  return r;
}
template <class U, int D>
Dual<U, D> select(const MaskOf<U>& m, const Dual<U, D>& a, const Dual<U, D>& b) {
  Dual<U, D> r;
  r.v = select(m, a.v, b.v);
  for (std::size_t i = 0; i < r.d.size(); ++i) r.d[i] = select(m, a.d[i], b.d[i]);
  return r;
}

namespace scalar_detail {
template <class T>
inline constexpr bool differentiated = false;
template <class T, int N>
inline constexpr bool differentiated<Jet<T, N>> = true;
template <class U, int D>
inline constexpr bool differentiated<Dual<U, D>> = true;
}  // namespace scalar_detail

/// Jet or Dual.
template <class T>
concept Differentiated = scalar_detail::differentiated<T>;

/// x times a plain number, which costs less than a product of scalars.
template <class T>
requires is_base<T> T scaled(const T& x, const T& s) { return x * s; }
template <class T, int N>
Jet<T, N> scaled(Jet<T, N> x, const T& s) {
  return x.scale(s);
}
template <class U, int D>
Dual<U, D> scaled(Dual<U, D> x, const Base<U>& s) {
  x.v = scaled(x.v, s);
  for (auto& d : x.d) d = scaled(d, s);
  return x;
}

/// r += s x for a plain number s.
template <class T>
requires is_base<T>
void add_scaled(T& r, const T& x, const T& s) { r += x * s; }
template <class T, int N>
void add_scaled(Jet<T, N>& r, const Jet<T, N>& x, const T& s) {
  r.v += x.v * s;
  for (std::size_t i = 0; i < x.g.size(); ++i) r.g[i] += x.g[i] * s;
  for (std::size_t i = 0; i < x.h.size(); ++i) r.h[i] += x.h[i] * s;
}
template <class U, int D>
void add_scaled(Dual<U, D>& r, const Dual<U, D>& x, const Base<U>& s) {
  add_scaled(r.v, x.v, s);
  for (std::size_t i = 0; i < D; ++i) add_scaled(r.d[i], x.d[i], s);
}
/// x with plain value v and the derivatives of x.
template <class T, int N>
void set_value(Jet<T, N>& x, const T& v) {
  x.v = v;
}
template <class U, int D>
void set_value(Dual<U, D>& x, const Base<U>& v) {
  if constexpr (is_base<U>) {
    x.v = v;
  } else {
    set_value(x.v, v);
  }
}

/// One lane of a scalar: double for a Pack, Jet<double, N> for a Jet<Pack<W>, N>, ...
template <class T>
struct one_lane {
  using type = double;
};
template <class T, int N>
struct one_lane<Jet<T, N>> {
  using type = Jet<typename one_lane<T>::type, N>;
};
template <class U, int D>
struct one_lane<Dual<U, D>> {
  using type = Dual<typename one_lane<U>::type, D>;
};
template <class T>
using OneLane = typename one_lane<T>::type;

namespace scalar_detail {
// Jets and duals are arrays of plain scalars without gaps, so lane l of a pack of them is every W-th double.
template <class T>
void copy_lane(const T& from, int l, OneLane<T>& to) {
  constexpr std::size_t entries = sizeof(OneLane<T>) / sizeof(double), width = static_cast<std::size_t>(lanes<T>);
  static_assert(sizeof(T) == entries * width * sizeof(double));
  const char* source = reinterpret_cast<const char*>(&from) + static_cast<std::size_t>(l) * sizeof(double);
  char* target = reinterpret_cast<char*>(&to);
  for (std::size_t i = 0; i < entries; ++i) std::memcpy(target + i * sizeof(double), source + i * width * sizeof(double), sizeof(double));
}
template <class T>
void copy_to_lane(const OneLane<T>& from, int l, T& to) {
  constexpr std::size_t entries = sizeof(OneLane<T>) / sizeof(double), width = static_cast<std::size_t>(lanes<T>);
  const char* source = reinterpret_cast<const char*>(&from);
  char* target = reinterpret_cast<char*>(&to) + static_cast<std::size_t>(l) * sizeof(double);
  for (std::size_t i = 0; i < entries; ++i) std::memcpy(target + i * width * sizeof(double), source + i * sizeof(double), sizeof(double));
}
}  // namespace scalar_detail

template <class T, int N>
OneLane<Jet<T, N>> lane(const Jet<T, N>& x, int l) {
  OneLane<Jet<T, N>> r;
  scalar_detail::copy_lane(x, l, r);
  return r;
}
template <class U, int D>
OneLane<Dual<U, D>> lane(const Dual<U, D>& x, int l) {
  OneLane<Dual<U, D>> r;
  scalar_detail::copy_lane(x, l, r);
  return r;
}
template <class T, int N>
void set_lane(Jet<T, N>& x, int l, const OneLane<Jet<T, N>>& y) {
  scalar_detail::copy_to_lane(y, l, x);
}
template <class U, int D>
void set_lane(Dual<U, D>& x, int l, const OneLane<Dual<U, D>>& y) {
  scalar_detail::copy_to_lane(y, l, x);
}
/// One lane of a vector or matrix of scalars.
template <class T, int N>
Vec<OneLane<T>, N> lane(const Vec<T, N>& x, int l) {
  Vec<OneLane<T>, N> r;
  for (int i = 0; i < N; ++i) r[i] = lane(x[i], l);
  return r;
}
template <class T, int M, int N>
Mat<OneLane<T>, M, N> lane(const Mat<T, M, N>& x, int l) {
  Mat<OneLane<T>, M, N> r;
  for (std::size_t i = 0; i < x.e.size(); ++i) r.e[i] = lane(x.e[i], l);
  return r;
}
template <class T, int N>
void set_lane(Vec<T, N>& x, int l, const Vec<OneLane<T>, N>& y) {
  for (int i = 0; i < N; ++i) set_lane(x[i], l, y[i]);
}

template <Differentiated T>
auto operator<(const T& a, const T& b) {
  return base(a) < base(b);
}
template <Differentiated T>
auto operator>(const T& a, const T& b) {
  return base(a) > base(b);
}
template <Differentiated T>
auto operator<=(const T& a, const T& b) {
  return base(a) <= base(b);
}
template <Differentiated T>
auto operator>=(const T& a, const T& b) {
  return base(a) >= base(b);
}
template <Differentiated T>
auto operator<(const T& a, double b) {
  return base(a) < Base<T>(b);
}
template <Differentiated T>
auto operator>(const T& a, double b) {
  return base(a) > Base<T>(b);
}
template <Differentiated T>
auto operator<=(const T& a, double b) {
  return base(a) <= Base<T>(b);
}
template <Differentiated T>
auto operator>=(const T& a, double b) {
  return base(a) >= Base<T>(b);
}

template <Differentiated T>
T abs(const T& a) {
  return select(base(a) < Base<T>(0.0), -a, a);
}
template <Differentiated T>
T max(const T& a, const T& b) {
  return select(base(a) < base(b), b, a);
}
template <Differentiated T>
T min(const T& a, const T& b) {
  return select(base(b) < base(a), b, a);
}

}  // namespace karcher
