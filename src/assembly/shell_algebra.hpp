#pragma once
/// \file
/// Small operations of the shell kernel that tensor.hpp has no use for: symmetric 3 x 3 matrices, products with skew matrices, loads and stores.

#include "karcher/manifold/quaternion.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher::shell {

/// Quadrature points that are worked on before the blocks with deformation nodes are summed.
inline constexpr int max_chunk = 8;

inline bool lane_of(bool m, int) { return m; }
template <int W>
bool lane_of(const Mask<W>& m, int l) {
  return m[l];
}

template <class T>
T load(const double* p) {
  if constexpr (lanes<T> == 1) {
    return *p;
  } else {
    return T::load(p);
  }
}
template <class T>
void store(const T& x, double* p) {
  if constexpr (lanes<T> == 1) {
    *p = lane(x, 0);
  } else {
    x.store(p);
  }
}
/// x, as a value in a register. Without this GCC reads a loaded number again in every multiplication that uses it, and the load ports become the
/// limit.
template <class T>
T in_register(T x) {
#if defined(__AVX512F__)
  if constexpr (lanes<T> == 8) asm("" : "+v"(x.v));
#endif
  return x;
}

template <class T>
Mat3<T> matrix(const T* a) {
  return {{a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]}};
}
template <class T>
void write(const Mat3<T>& m, T* a) {
  for (int k = 0; k < 9; ++k) a[k] = m.e[static_cast<std::size_t>(k)];
}

template <class T>
struct Sym3 {
  T xx, xy, xz, yy, yz, zz;
};

template <class T>
Sym3<T> symmetric_part(const Mat3<T>& a) {
  return {a(0, 0), T(0.5) * (a(0, 1) + a(1, 0)), T(0.5) * (a(0, 2) + a(2, 0)), a(1, 1), T(0.5) * (a(1, 2) + a(2, 1)), a(2, 2)};
}
template <class T>
Mat3<T> full(const Sym3<T>& s) {
  return {{s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz}};
}
/// tr(A) I - sym A.
template <class T>
Sym3<T> trace_minus(const Mat3<T>& a) {
  return {a(1, 1) + a(2, 2), T(-0.5) * (a(0, 1) + a(1, 0)), T(-0.5) * (a(0, 2) + a(2, 0)),
          a(0, 0) + a(2, 2), T(-0.5) * (a(1, 2) + a(2, 1)), a(0, 0) + a(1, 1)};
}
template <class T>
Sym3<T> cofactor(const Sym3<T>& s) {
  return {s.yy * s.zz - s.yz * s.yz, s.yz * s.xz - s.xy * s.zz, s.xy * s.yz - s.yy * s.xz,
          s.xx * s.zz - s.xz * s.xz, s.xy * s.xz - s.xx * s.yz, s.xx * s.yy - s.xy * s.xy};
}
template <class T>
Sym3<T> scaled(const T& f, const Sym3<T>& s) {
  return {f * s.xx, f * s.xy, f * s.xz, f * s.yy, f * s.yz, f * s.zz};
}
template <class T>
Vec3<T> times(const Sym3<T>& s, const Vec3<T>& v) {
  return {{s.xx * v[0] + s.xy * v[1] + s.xz * v[2], s.xy * v[0] + s.yy * v[1] + s.yz * v[2], s.xz * v[0] + s.yz * v[1] + s.zz * v[2]}};
}

/// M [k]: every row crossed with k.
template <class T>
Mat3<T> times_hat(const Mat3<T>& m, const Vec3<T>& k) {
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
Mat3<T> hat_times(const Vec3<T>& k, const Mat3<T>& m) {
  Mat3<T> r;
  for (int j = 0; j < 3; ++j) {
    r(0, j) = k[1] * m(2, j) - k[2] * m(1, j);
    r(1, j) = k[2] * m(0, j) - k[0] * m(2, j);
    r(2, j) = k[0] * m(1, j) - k[1] * m(0, j);
  }
  return r;
}

// Sums that are accumulated term by term, so that every product is one fused multiply-add.

/// r += s m
template <class T>
void add_scaled(Mat3<T>& r, const T& s, const Mat3<T>& m) {
  for (std::size_t k = 0; k < 9; ++k) r.e[k] += s * m.e[k];
}
template <class T>
void subtract_scaled(Mat3<T>& r, const T& s, const Mat3<T>& m) {
  for (std::size_t k = 0; k < 9; ++k) r.e[k] -= s * m.e[k];
}
/// r += a b
template <class T>
void add_product(Mat3<T>& r, const Mat3<T>& a, const Mat3<T>& b) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) += a(i, k) * b(k, j);
}
template <class T>
void subtract_product(Mat3<T>& r, const Mat3<T>& a, const Mat3<T>& b) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) -= a(i, k) * b(k, j);
}
/// r += a b^T
template <class T>
void add_outer(Mat3<T>& r, const Vec3<T>& a, const Vec3<T>& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) += a[i] * b[j];
}
/// r += m [k]
template <class T>
void add_times_hat(Mat3<T>& r, const Mat3<T>& m, const Vec3<T>& k) {
  for (int i = 0; i < 3; ++i) {
    r(i, 0) += m(i, 1) * k[2];
    r(i, 1) += m(i, 2) * k[0];
    r(i, 2) += m(i, 0) * k[1];
    r(i, 0) -= m(i, 2) * k[1];
    r(i, 1) -= m(i, 0) * k[2];
    r(i, 2) -= m(i, 1) * k[0];
  }
}
template <class T>
void subtract_times_hat(Mat3<T>& r, const Mat3<T>& m, const Vec3<T>& k) {
  for (int i = 0; i < 3; ++i) {
    r(i, 0) -= m(i, 1) * k[2];
    r(i, 1) -= m(i, 2) * k[0];
    r(i, 2) -= m(i, 0) * k[1];
    r(i, 0) += m(i, 2) * k[1];
    r(i, 1) += m(i, 0) * k[2];
    r(i, 2) += m(i, 1) * k[0];
  }
}
/// r += [k] m
template <class T>
void add_hat_times(Mat3<T>& r, const Vec3<T>& k, const Mat3<T>& m) {
  for (int j = 0; j < 3; ++j) {
    r(0, j) += k[1] * m(2, j);
    r(1, j) += k[2] * m(0, j);
    r(2, j) += k[0] * m(1, j);
    r(0, j) -= k[2] * m(1, j);
    r(1, j) -= k[0] * m(2, j);
    r(2, j) -= k[1] * m(0, j);
  }
}
/// r += [k]
template <class T>
void add_hat(Mat3<T>& r, const Vec3<T>& k) {
  r(0, 1) -= k[2];
  r(0, 2) += k[1];
  r(1, 0) += k[2];
  r(1, 2) -= k[0];
  r(2, 0) -= k[1];
  r(2, 1) += k[0];
}

}  // namespace karcher::shell
