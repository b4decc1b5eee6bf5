#pragma once
/// \file
/// Small operations of the shell kernel that tensor.hpp has no use for: symmetric 3 x 3 matrices, products with skew matrices, quaternions.

#include "karcher/math/pack.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher::shell {

/// A part of a hot function: never a call.
#define KARCHER_SHELL_INLINE [[gnu::always_inline]] inline

/// Quadrature points that are worked on before the blocks with deformation nodes are summed.
inline constexpr int max_chunk = 8;

template <class T>
using MaskOf = decltype(T{} < T{});
KARCHER_SHELL_INLINE bool lane_of(bool m, int) { return m; }
template <int W>
KARCHER_SHELL_INLINE bool lane_of(const Mask<W>& m, int l) {
  return m[l];
}

template <class T>
KARCHER_SHELL_INLINE T load(const double* p) {
  if constexpr (lanes<T> == 1) {
    return *p;
  } else {
    return T::load(p);
  }
}
template <class T>
KARCHER_SHELL_INLINE void store(const T& x, double* p) {
  if constexpr (lanes<T> == 1) {
    *p = x;
  } else {
    x.store(p);
  }
}
template <class T>
KARCHER_SHELL_INLINE Mat3<T> matrix(const T* a) {
  return {{a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]}};
}
template <class T>
KARCHER_SHELL_INLINE void store(const Mat3<T>& m, T* a) {
  for (int k = 0; k < 9; ++k) a[k] = m.e[static_cast<std::size_t>(k)];
}

template <class T>
struct Sym3 {
  T xx, xy, xz, yy, yz, zz;
};

template <class T>
KARCHER_SHELL_INLINE Sym3<T> symmetric_part(const Mat3<T>& a) {
  return {a(0, 0), T(0.5) * (a(0, 1) + a(1, 0)), T(0.5) * (a(0, 2) + a(2, 0)), a(1, 1), T(0.5) * (a(1, 2) + a(2, 1)), a(2, 2)};
}
template <class T>
KARCHER_SHELL_INLINE Mat3<T> full(const Sym3<T>& s) {
  return {{s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz}};
}
/// tr(A) I - sym A.
template <class T>
KARCHER_SHELL_INLINE Sym3<T> trace_minus(const Mat3<T>& a) {
  return {a(1, 1) + a(2, 2), T(-0.5) * (a(0, 1) + a(1, 0)), T(-0.5) * (a(0, 2) + a(2, 0)),
          a(0, 0) + a(2, 2), T(-0.5) * (a(1, 2) + a(2, 1)), a(0, 0) + a(1, 1)};
}
template <class T>
KARCHER_SHELL_INLINE Sym3<T> cofactor(const Sym3<T>& s) {
  return {s.yy * s.zz - s.yz * s.yz, s.yz * s.xz - s.xy * s.zz, s.xy * s.yz - s.yy * s.xz,
          s.xx * s.zz - s.xz * s.xz, s.xy * s.xz - s.xx * s.yz, s.xx * s.yy - s.xy * s.xy};
}
template <class T>
KARCHER_SHELL_INLINE Sym3<T> scaled(const T& f, const Sym3<T>& s) {
  return {f * s.xx, f * s.xy, f * s.xz, f * s.yy, f * s.yz, f * s.zz};
}
template <class T>
KARCHER_SHELL_INLINE Vec3<T> times(const Sym3<T>& s, const Vec3<T>& v) {
  return {{s.xx * v[0] + s.xy * v[1] + s.xz * v[2], s.xy * v[0] + s.yy * v[1] + s.yz * v[2], s.xz * v[0] + s.yz * v[1] + s.zz * v[2]}};
}

/// M [k]: every row crossed with k.
template <class T>
KARCHER_SHELL_INLINE Mat3<T> times_hat(const Mat3<T>& m, const Vec3<T>& k) {
  Mat3<T> r;
  for (int i = 0; i < 3; ++i) {
    r(i, 0) = m(i, 1) * k[2] - m(i, 2) * k[1];
    r(i, 1) = m(i, 2) * k[0] - m(i, 0) * k[2];
    r(i, 2) = m(i, 0) * k[1] - m(i, 1) * k[0];
  }
  return r;
}

/// [k] M: k crossed with every column.
template <class T>
KARCHER_SHELL_INLINE Mat3<T> hat_times(const Vec3<T>& k, const Mat3<T>& m) {
  Mat3<T> r;
  for (int j = 0; j < 3; ++j) {
    r(0, j) = k[1] * m(2, j) - k[2] * m(1, j);
    r(1, j) = k[2] * m(0, j) - k[0] * m(2, j);
    r(2, j) = k[0] * m(1, j) - k[1] * m(0, j);
  }
  return r;
}

/// Rotation matrix of a unit quaternion (w, x, y, z).
template <class T>
KARCHER_SHELL_INLINE Mat3<T> rotation_matrix(const Vec<T, 4>& q) {
  const T x2 = q[1] + q[1], y2 = q[2] + q[2], z2 = q[3] + q[3];
  const T xx = q[1] * x2, yy = q[2] * y2, zz = q[3] * z2, xy = q[1] * y2, xz = q[1] * z2, yz = q[2] * z2, wx = q[0] * x2, wy = q[0] * y2,
          wz = q[0] * z2;
  const T one(1.0);
  return {{one - (yy + zz), xy - wz, xz + wy, xy + wz, one - (xx + zz), yz - wx, xz - wy, yz + wx, one - (xx + yy)}};
}
/// Quaternion product (w first).
template <class T>
KARCHER_SHELL_INLINE Vec<T, 4> quaternion_product(const Vec<T, 4>& a, const Vec<T, 4>& b) {
  return {{a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
           a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]}};
}
/// conj(a) b.
template <class T>
KARCHER_SHELL_INLINE Vec<T, 4> relative_quaternion(const Vec<T, 4>& a, const Vec<T, 4>& b) {
  return {{a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
           a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1], a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]}};
}

}  // namespace karcher::shell
