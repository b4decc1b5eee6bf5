#pragma once
/// \file
/// The stress-free configuration at a point, for densities that ask for it: `operator()(const S& s, const U&... u)` with S a ReferencePoint and a jet for
/// every field. It is the mesh itself, or what [reference] of a problem puts in its place.
///
///   s.x           position in R^3; s[0], s[1], s[2] for short
///   s.tangent[a]  orthonormal directions t_a: u.d[a] is the derivative along t_a. In a solid the axes.
/// Surfaces have besides
///   s.normal      unit normal n_0, the same side on neighbouring cells if s.oriented (outwards on the boundary of a solid); else the cell's own
///   s.b           second fundamental tensor in the directions t_a: b_ab = n_0 . d_a d_b x = -d_a n_0 . t_b (a sphere of radius r with the outward normal: -1/r)
///   s.oriented    whether there is such a choice of n_0: not on a Moebius strip
/// Curves of a plane mesh have s.normal in the plane, and s.oriented.
/// The basis (t_1, t_2, n_0) need not be right-handed. Derivatives in space of a field u on a surface are those of its constant continuation along the normal:
/// grad u = sum_a d_a u (x) t_a, div u = sum_a t_a . d_a u, curl u = sum_a t_a x d_a u.

#include <array>

#include "karcher/math/tensor.hpp"

namespace karcher {

/// T: double or a pack of several points.
template <int D, class T>
struct ReferencePoint {
  Vec3<T> x;
  std::array<Vec3<T>, static_cast<std::size_t>(D)> tangent{};
  const T& operator[](int i) const { return x[i]; }
};

template <class T>
struct ReferencePoint<1, T> {
  Vec3<T> x;
  std::array<Vec3<T>, 1> tangent{};
  Vec3<T> normal;
  bool oriented = true;
  const T& operator[](int i) const { return x[i]; }
};

template <class T>
struct ReferencePoint<2, T> {
  Vec3<T> x;
  std::array<Vec3<T>, 2> tangent{};
  Vec3<T> normal;
  Mat<T, 2, 2> b;
  bool oriented = true;
  const T& operator[](int i) const { return x[i]; }
};

}  // namespace karcher
