#pragma once
/// \file
/// Pack<W>: W doubles that are computed with at once, on GCC/Clang vector extensions. Lane l of every operation equals the
/// scalar operation up to the contraction of multiply-adds, so results agree with `double` to rounding.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace karcher {

/// Lanes of the widest vector of the target: 8 with AVX-512, 4 with AVX, 1 otherwise.
#if defined(__AVX512F__)
inline constexpr int native_width = 8;
#elif defined(__AVX__)
inline constexpr int native_width = 4;
#else
inline constexpr int native_width = 1;
#endif

namespace pack_detail {
// GCC 12 forgets a vector_size that depends on a template parameter, so each width is spelled out.
template <int W>
struct Native;
template <>
struct Native<2> {
  typedef double Real __attribute__((vector_size(16)));
  typedef std::int64_t Truth __attribute__((vector_size(16)));
};
template <>
struct Native<4> {
  typedef double Real __attribute__((vector_size(32)));
  typedef std::int64_t Truth __attribute__((vector_size(32)));
};
template <>
struct Native<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef std::int64_t Truth __attribute__((vector_size(64)));
};
}  // namespace pack_detail

/// A truth value per lane (all bits set or none). Not convertible to bool: say `any(m)`, `all(m)` or `select(m, a, b)`.
template <int W>
struct Mask {
  using Native = typename pack_detail::Native<W>::Truth;
  Native v;
  bool operator[](int l) const { return v[l] != 0; }
};

template <int W>
struct Pack {
  using Native = typename pack_detail::Native<W>::Real;
  Native v;

  Pack() = default;
  Pack(Native x) : v(x) {}
  Pack(double x) : v(x - Native{}) {}  // x - 0 is x for every x (x + 0 is not, for -0), so this is one broadcast
  Pack(int x) : Pack(static_cast<double>(x)) {}

  double operator[](int l) const { return v[l]; }
  void set(int l, double x) { v[l] = x; }

  /// W consecutive doubles, no alignment needed.
  static Pack load(const double* p) {
    Pack r;
    std::memcpy(&r.v, p, sizeof(Native));
    return r;
  }
  void store(double* p) const { std::memcpy(p, &v, sizeof(Native)); }

  Pack& operator+=(Pack b) {
    v += b.v;
    return *this;
  }
  Pack& operator-=(Pack b) {
    v -= b.v;
    return *this;
  }
  Pack& operator*=(Pack b) {
    v *= b.v;
    return *this;
  }
  Pack& operator/=(Pack b) {
    v /= b.v;
    return *this;
  }
  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  friend Mask<W> operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend Mask<W> operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Mask<W> operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  friend Mask<W> operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
};

template <int W>
Mask<W> operator&(Mask<W> a, Mask<W> b) {
  return {a.v & b.v};
}
template <int W>
Mask<W> operator|(Mask<W> a, Mask<W> b) {
  return {a.v | b.v};
}
template <int W>
Mask<W> operator!(Mask<W> a) {
  return {~a.v};
}
template <int W>
bool any(Mask<W> a) {
  std::int64_t r = 0;
  for (int l = 0; l < W; ++l) r |= a.v[l];
  return r != 0;
}
template <int W>
bool all(Mask<W> a) {
  std::int64_t r = -1;
  for (int l = 0; l < W; ++l) r &= a.v[l];
  return r != 0;
}
template <int W>
Pack<W> select(Mask<W> m, Pack<W> a, Pack<W> b) {
  return m.v ? a.v : b.v;
}
template <int W>
Pack<W> sqrt(Pack<W> a) {
  Pack<W> r;
  for (int l = 0; l < W; ++l) r.v[l] = std::sqrt(a.v[l]);
  return r;
}
template <int W>
Pack<W> abs(Pack<W> a) {
  return select(a < Pack<W>(0.0), -a, a);
}
template <int W>
Pack<W> max(Pack<W> a, Pack<W> b) {
  return select(a < b, b, a);
}
template <int W>
Pack<W> min(Pack<W> a, Pack<W> b) {
  return select(b < a, b, a);
}
template <int W>
double max_lane(Pack<W> a) {
  double m = a.v[0];
  for (int l = 1; l < W; ++l) m = a.v[l] > m ? a.v[l] : m;
  return m;
}

// The same vocabulary for double, so that kernels read alike for one lane and for many.
inline bool any(bool a) { return a; }
inline bool all(bool a) { return a; }
inline double select(bool m, double a, double b) { return m ? a : b; }
inline double max_lane(double a) { return a; }
using std::abs;
using std::sqrt;
inline double max(double a, double b) { return a < b ? b : a; }
inline double min(double a, double b) { return b < a ? b : a; }

/// Number of lanes of a scalar: 1 for double, W for Pack<W>.
template <class T>
struct lanes_of : std::integral_constant<int, 1> {};
template <int W>
struct lanes_of<Pack<W>> : std::integral_constant<int, W> {};
template <class T>
inline constexpr int lanes = lanes_of<T>::value;

inline double lane(double a, int) { return a; }
template <int W>
double lane(const Pack<W>& a, int l) {
  return a[l];
}
inline void set_lane(double& a, int, double x) { a = x; }
template <int W>
void set_lane(Pack<W>& a, int l, double x) {
  a.set(l, x);
}

/// The scalar that the kernels use: a pack of the native width, or double where that is one.
using NativeScalar = std::conditional_t<native_width == 1, double, Pack<native_width>>;

}  // namespace karcher
