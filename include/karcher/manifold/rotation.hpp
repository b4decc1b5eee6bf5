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
  static constexpr std::string_view description =
      "rotations of space; points are unit quaternions (w, x, y, z), q and -q the same; distance = angle of rotation";
  static constexpr int ambient = 4;
  static constexpr int dim = 3;
  static constexpr double injectivity_radius = std::numbers::pi;
  static constexpr int unit_scale = 2;
  static constexpr bool body_axes = true;

  /// The identity.
  static Vec<double, 4> origin() { return {{1.0}}; }
  static constexpr bool has_identity = true;
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

  /// The matrix divided by sqrt 2, so that small distances are angles.
  template <class T>
  static Vec<T, 9> error_coordinates(const Vec<T, 4>& p) {
    return scaled(rotation_matrix(p));
  }
  /// A rotation vector, or a matrix by rows, of which the closest rotation is meant.
  struct Entries {
    static constexpr std::array counts{3, 9};
    static constexpr std::string_view wanted = "a rotation vector (3 entries), a matrix by rows (9), a quaternion (4) or \"identity\"";
    static bool make_point(std::span<const double> e, Vec<double, 4>& p) {
      if (e.size() == 3) {
        p = quaternion_of_rotation_vector(vector(e));
        return true;
      }
      const PolarFactor<double> f = polar_factor(matrix(e));
      p = f.q;
      return f.defined;
    }
    template <class T>
    static Vec<T, 9> error_coordinates(std::span<const T> e) {
      return e.size() == 3 ? Rotation::error_coordinates(quaternion_of_rotation_vector(vector(e))) : scaled(matrix(e));
    }
  };
  static std::vector<Quantity> quantities() {
    using Q = Vec<double, 4>;
    return {quantity<4>("rotation-vector", [](const Q& p) { return to_rotation_vector(p); }),
            quantity<4>("director1", [](const Q& p) { return director(p, 0); }), quantity<4>("director2", [](const Q& p) { return director(p, 1); }),
            quantity<4>("director3", [](const Q& p) { return director(p, 2); })};
  }
  /// The directors as files have them: by squares of all coordinates.
  static std::vector<Quantity> arrays() { return {axis<0>(), axis<1>(), axis<2>()}; }
  static Drawing drawing() { return {.glyph = Glyph::frame, .coordinates = {1, 2, 3, 0}, .components = false, .directors = true}; }

 private:
  /// d_k = q e_k q^-1
  template <int k>
  static Quantity axis() {
    return quantity<4>("director" + std::to_string(k + 1), [](const Vec<double, 4>& p) {
      const double w = p[0], x = p[1], y = p[2], z = p[3];
      const Vec3<double> d[] = {{{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)}},
                                {{2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)}},
                                {{2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}}};
      return d[k];
    });
  }
  template <class T>
  static Vec<T, 9> scaled(const Mat3<T>& r) {
    Vec<T, 9> x;
    for (int i = 0; i < 9; ++i) x[i] = r.e[static_cast<std::size_t>(i)] * (0.5 * std::numbers::sqrt2);
    return x;
  }
  template <class T>
  static Vec3<T> vector(std::span<const T> e) {
    return {{e[0], e[1], e[2]}};
  }
  template <class T>
  static Mat3<T> matrix(std::span<const T> e) {
    Mat3<T> r;
    std::ranges::copy(e, r.e.begin());
    return r;
  }
};

static_assert(HasProjection<Rotation>);

}  // namespace karcher
