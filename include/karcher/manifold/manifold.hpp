#pragma once
/// \file
/// The concept of a manifold.
///
/// A manifold is a stateless type M that speaks about points in ambient coordinates, `Vec<T, M::ambient>`. A point is a plain value; all
/// operations are static templates over the scalar T (double, Pack, Jet, Dual), which is how every derivative in Karcher that is not written in
/// closed form is obtained, exactly. The metric is that of `inner`.
///
/// Notation as in Absil, Mahony, Sepulchre, "Optimization Algorithms on Matrix Manifolds" (2008): p, q points; a, b tangent vectors at p in ambient
/// coordinates; v coordinates of a tangent vector in the frame E(p), whose columns are orthonormal in the metric at p.

#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

#include "karcher/math/jet.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class M, class T = double>
using Point = Vec<T, M::ambient>;

namespace manifold_detail {
template <class M>
concept HasName = requires {
  { M::name } -> std::convertible_to<std::string_view>;
};
template <class M>
concept HasDimensions = requires {
  { M::ambient } -> std::convertible_to<int>;
  { M::dim } -> std::convertible_to<int>;
};
template <class M>
concept HasExp = requires(Point<M> p) {
  { M::exp(p, p) } -> std::same_as<Point<M>>;
};
template <class M>
concept HasLog = requires(Point<M> p) {
  { M::log(p, p) } -> std::same_as<Point<M>>;
};
template <class M>
concept HasInner = requires(Point<M> p) {
  { M::inner(p, p, p) } -> std::same_as<double>;
};
template <class M>
concept HasFrame = requires(Point<M> p) {
  { M::frame(p) } -> std::same_as<Mat<double, M::ambient, M::dim>>;
};
template <class M>
concept HasInjectivityRadius = requires {
  { M::injectivity_radius } -> std::convertible_to<double>;
};
template <class M>
concept AnyScalar = requires(Point<M, Jet<double, 2>> p) {
  M::exp(p, p);
  M::log(p, p);
  M::inner(p, p, p);
  M::frame(p);
};
template <class M>
concept ProjectionIsWhole = requires(Point<M> p) {
  M::project(p);
}
== requires(Point<M> p) { M::chord(p, p); };
}  // namespace manifold_detail

/// M::name                     std::string_view, as problem files say it
/// M::ambient, M::dim          numbers of ambient coordinates and of tangent coordinates
/// M::exp(p, a)                exponential map of the ambient tangent vector a at p; smooth in both, also at a = 0
/// M::log(p, q)                its inverse, an ambient tangent vector at p; smooth also at q = p; meaningful for dist(p, q) < injectivity_radius
/// M::inner(p, a, b)           metric at p (on ambient vectors; linear in a and b even where they are not exactly tangent)
/// M::frame(p)                 ambient x dim, columns orthonormal in the metric at p; need not be smooth in p; deterministic
/// M::injectivity_radius       infinity where there is no cut locus
/// Optional:
/// M::project(x)               closest point of the manifold to an ambient vector (makes the projection rule available)
/// M::chord(q, p)              tangent vector at q that is the gradient in q of -1/2 |p - q|^2 (ambient): the projection of p to T_qM; comes with project
/// M::unit_scale               points are the unit vectors of R^ambient, log is that of the sphere, the metric s^2 times the ambient one: s = 1; or s = 2, where p
///                             and -p are besides the same point (rotations). Interpolation has closed forms then (unit_vector_mean.hpp)
/// M::origin()                 some point, at double: where the law suite begins
/// M::LogAround<S, T>          log_q(w)(p(v)) in a moving frame, written by hand (spd.hpp) for weighted_mean.hpp
/// M::dist(p, q)               at double: see distance() below
/// M::defect(x)                at double: how far x is from the manifold, relatively; 0 for points up to rounding
/// What else may be told, e.g. how problem files write points and how the page draws them: traits.hpp.
template <class M>
concept Manifold = manifold_detail::HasName<M> && manifold_detail::HasDimensions<M> && manifold_detail::HasExp<M> && manifold_detail::HasLog<M> &&
    manifold_detail::HasInner<M> && manifold_detail::HasFrame<M> && manifold_detail::HasInjectivityRadius<M>;

template <class M>
concept HasProjection = Manifold<M> && requires(Point<M> p) {
  { M::project(p) } -> std::same_as<Point<M>>;
  { M::chord(p, p) } -> std::same_as<Point<M>>;
};

/// One sentence for every member that M lacks: `static_assert(CheckManifold<M>::passed)` says what a failed `Manifold<M>` does not.
template <class M>
struct CheckManifold {
  static_assert(manifold_detail::HasName<M>, "A manifold needs `static constexpr std::string_view name`.");
  static_assert(manifold_detail::HasDimensions<M>, "A manifold needs `static constexpr int ambient` and `static constexpr int dim`.");
  static_assert(manifold_detail::HasInjectivityRadius<M>,
                "A manifold needs `static constexpr double injectivity_radius` (infinity where there is no cut locus).");
  static_assert(manifold_detail::HasExp<M>,
                "A manifold needs `template <class T> static Vec<T, ambient> exp(const Vec<T, ambient>& p, const Vec<T, ambient>& a)`.");
  static_assert(manifold_detail::HasLog<M>,
                "A manifold needs `template <class T> static Vec<T, ambient> log(const Vec<T, ambient>& p, const Vec<T, ambient>& q)`.");
  static_assert(
      manifold_detail::HasInner<M>,
      "A manifold needs `template <class T> static T inner(const Vec<T, ambient>& p, const Vec<T, ambient>& a, const Vec<T, ambient>& b)`.");
  static_assert(manifold_detail::HasFrame<M>, "A manifold needs `template <class T> static Mat<T, ambient, dim> frame(const Vec<T, ambient>& p)`.");
  static_assert(manifold_detail::AnyScalar<M>,
                "exp, log, inner and frame of a manifold must be templates over the scalar: jets and packs run through them.");
  static_assert(manifold_detail::ProjectionIsWhole<M>, "A manifold has both project(x) and chord(q, p), or neither.");
  static constexpr bool passed = Manifold<M>;
};

/// Riemannian distance: M::dist where it is written, else the length of log.
template <class M>
double distance(const Point<M>& p, const Point<M>& q) {
  if constexpr (requires { M::dist(p, q); }) {
    return M::dist(p, q);
  } else {
    const Point<M> a = M::log(p, q);
    return std::sqrt(M::inner(p, a, a));
  }
}

/// Point with the coordinates v in the frame at p: exp_p(E(p) v). This is the retraction that the solver steps with.
template <class M, class T>
Point<M, T> retract(const Point<M, T>& p, const Vec<T, M::dim>& v) {
  return M::exp(p, M::frame(p) * v);
}

/// Coordinates in the frame e of the tangent vector a at p.
template <class M, class T>
Vec<T, M::dim> coordinates(const Point<M, T>& p, const Mat<T, M::ambient, M::dim>& e, const Vec<T, M::ambient>& a) {
  Vec<T, M::dim> v;
  for (int k = 0; k < M::dim; ++k) v[k] = M::inner(p, column(e, k), a);
  return v;
}

}  // namespace karcher
