#pragma once
/// \file
/// Quaternions (w, x, y, z) = w + x i + y j + z k, and the rotations that unit quaternions stand for: v -> q v conj(q).

#include "karcher/math/functions.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class T>
using Quaternion = Vec<T, 4>;

template <class T>
Quaternion<T> quaternion_product(const Quaternion<T>& a, const Quaternion<T>& b) {
  return {{a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
           a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]}};
}
template <class T>
Quaternion<T> conjugate(const Quaternion<T>& q) {
  return {{q[0], -q[1], -q[2], -q[3]}};
}
/// q (0, v): the tangent vector at q with body rate 2 v (SO(3)) or coordinates v in the left-invariant frame of the unit sphere.
template <class T>
Quaternion<T> times_imaginary(const Quaternion<T>& q, const Vec3<T>& v) {
  return {{-(q[1] * v[0]) - q[2] * v[1] - q[3] * v[2], q[0] * v[0] + q[2] * v[2] - q[3] * v[1], q[0] * v[1] - q[1] * v[2] + q[3] * v[0],
           q[0] * v[2] + q[1] * v[1] - q[2] * v[0]}};
}
/// q i, q j, q k as columns: an orthonormal, left-invariant frame of the unit sphere of R^4.
template <class T>
Mat<T, 4, 3> left_invariant_frame(const Quaternion<T>& q) {
  Mat<T, 4, 3> e;
  e(0, 0) = -q[1], e(0, 1) = -q[2], e(0, 2) = -q[3];
  e(1, 0) = q[0], e(1, 1) = -q[3], e(1, 2) = q[2];
  e(2, 0) = q[3], e(2, 1) = q[0], e(2, 2) = -q[1];
  e(3, 0) = -q[2], e(3, 1) = q[1], e(3, 2) = q[0];
  return e;
}
/// The rotation matrix of a unit quaternion; its columns are the directors.
template <class T>
Mat3<T> rotation_matrix(const Quaternion<T>& q) {
  const T x2 = T(2.0) * q[1], y2 = T(2.0) * q[2], z2 = T(2.0) * q[3];
  const T wx = x2 * q[0], wy = y2 * q[0], wz = z2 * q[0];
  const T xx = x2 * q[1], xy = y2 * q[1], xz = z2 * q[1], yy = y2 * q[2], yz = z2 * q[2], zz = z2 * q[3];
  const T one = T(1.0);
  Mat3<T> r;
  r(0, 0) = one - yy - zz, r(0, 1) = xy - wz, r(0, 2) = xz + wy;
  r(1, 0) = xy + wz, r(1, 1) = one - xx - zz, r(1, 2) = yz - wx;
  r(2, 0) = xz - wy, r(2, 1) = yz + wx, r(2, 2) = one - xx - yy;
  return r;
}
/// exp([v]) as a unit quaternion: (cos |v|/2, sin(|v|/2)/|v| v).
template <class T>
Quaternion<T> quaternion_of_rotation_vector(const Vec3<T>& v) {
  const auto c = stumpff<1>(T(0.25) * norm2(v));
  const T s = T(0.5) * c[1];
  return {{c[0], s * v[0], s * v[1], s * v[2]}};
}
/// The shortest v with exp([v]) = +-q. At |v| = pi one of the two.
template <class T>
Vec3<T> rotation_vector(const Quaternion<T>& q) {
  const auto other = base(q[0]) < Base<T>(0.0);
  const T f = T(2.0) * arc_ratio(abs(q[0]));
  const T signed_f = select(other, -f, f);
  return {{signed_f * q[1], signed_f * q[2], signed_f * q[3]}};
}

}  // namespace karcher
