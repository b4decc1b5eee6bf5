#pragma once
/// \file
/// An immersed Klein bottle: a tube of varying radius r(u) around a plane curve c(u) that leaves the body at the top, turns back through the body's
/// wall and opens into the base from inside (the "bottle with a handle" of Nebel, Sander, Birsan, Neff 2023).
///
///   X(u, v) = (x(u) + r(u) sin v cos phi(u), r(u) cos v, z(u) - r(u) sin v sin phi(u))
///
/// x, z, r are trigonometric polynomials in u, phi(u) = u/2 + such a polynomial, all of degree 4 with coefficients of four digits. Since phi grows by
/// pi over a period, X(u + 2 pi, v) = X(u, -v): the gluing is exact and the surface analytic everywhere. At u = 0 the curve nearly stands still and
/// the tube opens with r' > 0: there the body's base turns into the inner tube.
///
/// The coefficients come from minimising a high power mean of the largest principal curvature near a drawn outline. For height 1: -0.292 <= x <=
/// 0.465, |y| <= 0.285, 0 <= z <= 1, tube radius r between 0.0850 (neck) and 0.2847 (body), area 1.967, largest principal curvature 12.87 (radius
/// 0.0777, at the inside of the handle's bend, u = 3.32), |X_u x X_v| >= 0.0153.

#include "karcher/math/tensor.hpp"

namespace karcher {

/// Point of the bottle of height 1. The base is at z = 0, the handle in the plane y = 0 towards +x.
Vec3<double> klein_bottle(double u, double v);

/// No principal curvature of the bottle of height 1 is larger; of height h: this / h.
inline constexpr double klein_bottle_curvature = 12.88;

}  // namespace karcher
