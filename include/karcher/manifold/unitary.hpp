#pragma once
/// \file
/// Unitary: SU(2) as the unit quaternions (w, x, y, z), with the metric of the unit sphere in R^4 and the left-invariant frame q i, q j, q k.
///
/// exp, log, dist, projection and chord are those of S^3: with a bi-invariant metric the group's and the sphere's exponential maps are one. q and -q differ
/// here; rotation.hpp identifies them.

#include <numbers>

#include "karcher/manifold/quaternion.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher {

struct Unitary {
  static constexpr std::string_view name = "SU2";
  static constexpr std::string_view description =
      "special unitary group as unit quaternions (w, x, y, z), q and -q different; metric of the unit sphere of R^4";
  static constexpr int ambient = 4;
  static constexpr int dim = 3;
  static constexpr double injectivity_radius = std::numbers::pi;
  static constexpr int unit_scale = 1;

  /// The identity.
  static Vec<double, 4> origin() { return {{1.0}}; }
  static constexpr bool has_identity = true;
  static Drawing drawing() { return {.glyph = Glyph::frame, .coordinates = {1, 2, 3, 0}}; }
  template <class T>
  static Vec<T, 4> exp(const Vec<T, 4>& p, const Vec<T, 4>& a) {
    return unit_vector::exp(p, a);
  }
  /// Not defined (NaN) for opposite points.
  template <class T>
  static Vec<T, 4> log(const Vec<T, 4>& p, const Vec<T, 4>& q) {
    return unit_vector::log(p, q);
  }
  static double dist(const Vec<double, 4>& p, const Vec<double, 4>& q) { return angle_between(p, q); }
  template <class T>
  static T inner(const Vec<T, 4>&, const Vec<T, 4>& a, const Vec<T, 4>& b) {
    return dot(a, b);
  }
  template <class T>
  static Mat<T, 4, 3> frame(const Vec<T, 4>& p) {
    return left_invariant_frame(p);
  }
  template <class T>
  static Vec<T, 4> project(const Vec<T, 4>& x) {
    return unit_vector::project(x);
  }
  template <class T>
  static Vec<T, 4> chord(const Vec<T, 4>& q, const Vec<T, 4>& p) {
    return unit_vector::chord(q, p);
  }
  static double defect(const Vec<double, 4>& x) { return unit_vector::defect(x); }
};

static_assert(HasProjection<Unitary>);

}  // namespace karcher
