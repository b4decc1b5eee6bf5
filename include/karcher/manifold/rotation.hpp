#pragma once
/// \file
/// Rotation: SO(3) as unit quaternions (w, x, y, z); p and -p are the same point.
///
/// The frame at p is p (0, e_k)/2, so that tangent coordinates v are body rotation vectors: retract(p, v) stands for R exp([v]) and |v| is the angle. Metric
/// <a, b>_p = 4 a . b, distance = rotation angle = 2 arccos|<p, q>|, injectivity radius pi.
///
///   exp_p(a) = c_0(|a|^2) p + c_1(|a|^2) a,   log_p(q) = a(|c|) (+-q - |c| p),  c = <p, q>, the sign that of c.
///
/// The projection rule averages rotation *matrices*: minimise sum l_i |R_i - Q|_F^2. Its two-point function is chord(q, p): the tangent vector with body
/// coordinates Ax(Q^T R) = 4 c s where conj(q) p = (c, s). polar.hpp has the projection of a matrix. project(x) for an ambient quaternion is x/|x|.
///
/// Moakher, "Means and averaging in the group of rotations" (SIAM J. Matrix Anal. 2002).

#include <numbers>

#include "karcher/error.hpp"
#include "karcher/manifold/polar.hpp"
#include "karcher/manifold/quaternion.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher {

struct Rotation {
  static constexpr std::string_view name = "SO3";
  static constexpr int ambient = 4;
  static constexpr int dim = 3;
  static constexpr double injectivity_radius = std::numbers::pi;
  static constexpr int unit_scale = 2;

  /// The identity.
  static Vec<double, 4> origin() { return {{1.0}}; }
  template <class T>
  static Vec<T, 4> exp(const Vec<T, 4>& p, const Vec<T, 4>& a) {
    return unit_vector::exp(p, a);
  }
  /// For rotations that differ by the angle pi, one of the two shortest ways.
  template <class T>
  static Vec<T, 4> log(const Vec<T, 4>& p, const Vec<T, 4>& q) {
    return unit_vector::projective_log(p, q);
  }
  static double dist(const Vec<double, 4>& p, const Vec<double, 4>& q) { return 2 * angle_between(p, dot(p, q) < 0 ? -q : q); }
  template <class T>
  static T inner(const Vec<T, 4>&, const Vec<T, 4>& a, const Vec<T, 4>& b) {
    return T(4.0) * dot(a, b);
  }
  template <class T>
  static Mat<T, 4, 3> frame(const Vec<T, 4>& p) {
    return 0.5 * left_invariant_frame(p);
  }
  template <class T>
  static Vec<T, 4> project(const Vec<T, 4>& x) {
    return unit_vector::project(x);
  }
  /// Gradient in q of -1/2 |R(p) - R(q)|_F^2: q (0, 4 c s)/2 = 2 c (p - c q).
  template <class T>
  static Vec<T, 4> chord(const Vec<T, 4>& q, const Vec<T, 4>& p) {
    const T c = dot(p, q);
    return (T(2.0) * c) * (p - c * q);
  }
  static double defect(const Vec<double, 4>& x) { return unit_vector::defect(x); }

  /// The rotation matrix.
  template <class T>
  static Mat3<T> to_matrix(const Vec<T, 4>& p) {
    return rotation_matrix(p);
  }
  /// The rotation closest to a matrix (polar.hpp).
  /// \throws InputError where there is none or more than one, e.g. at a reflection.
  static Vec<double, 4> from_matrix(const Mat3<double>& a) {
    const PolarFactor<double> f = polar_factor(a);
    if (!f.defined) throw InputError("The matrix has no unique closest rotation.");
    return f.q;
  }
  /// The k-th director: column k of the rotation matrix.
  template <class T>
  static Vec3<T> director(const Vec<T, 4>& p, int k) {
    return column(rotation_matrix(p), k);
  }
  template <class T>
  static Vec<T, 4> from_rotation_vector(const Vec3<T>& v) {
    return quaternion_of_rotation_vector(v);
  }
  /// The shortest rotation vector of p.
  template <class T>
  static Vec3<T> to_rotation_vector(const Vec<T, 4>& p) {
    return rotation_vector(p);
  }
  /// The rotation p q (first q, then p).
  template <class T>
  static Vec<T, 4> product(const Vec<T, 4>& p, const Vec<T, 4>& q) {
    return quaternion_product(p, q);
  }
};

static_assert(HasProjection<Rotation>);

}  // namespace karcher
