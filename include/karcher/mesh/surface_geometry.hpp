#pragma once
/// \file
/// First and second fundamental form of a surface at a point, from position, tangents and second derivatives of any parametrisation.
///
/// Notation as in Nebel, Sander, Birsan, Neff (2023): a_a tangents, a^a dual basis, n_0 = a_1 x a_2 / |a_1 x a_2|,
///   b = - sum_a d_a n_0 (x) a^a = sum b_ab a^a (x) a^b,  b_ab = n_0 . d_a d_b x,   c = sqrt(det a_ab) (a^1 (x) a^2 - a^2 (x) a^1).
/// Curvatures are the eigenvalues of b: both -1/r on a sphere of radius r with the outward normal.

#include <array>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

struct SurfaceGeometry {
  Vec3<double> x;
  std::array<Vec3<double>, 2> tangent, dual;  ///< a_a, a^a
  Vec3<double> normal;                        ///< n_0
  double area = 0;                            ///< sqrt(det a_ab): area of the surface per area of the parameter domain
  Mat3<double> b, c;
  std::array<double, 2> curvature{};  ///< principal curvatures, larger one first
  /// Columns: unit principal directions t_1, t_2 of curvature[0], curvature[1], and n_0; right-handed. At an umbilic t_1 is along a_1.
  Mat3<double> frame;

  double mean_curvature() const { return 0.5 * (curvature[0] + curvature[1]); }  ///< H
  double gauss_curvature() const { return curvature[0] * curvature[1]; }         ///< K_G
  /// Orthonormal derivatives from those in the parameters: f_b = sum_a jacobian(a, b) d_a f, with jacobian(a, b) = a^a . t_b.
  Mat<double, 2, 2> jacobian() const;
};

/// \throws InputError with the place if the tangents are linearly dependent to rounding or not finite.
SurfaceGeometry surface_geometry(const GeometryJet& jet);

/// The surface whose lengths along the orthonormal tangents t_1, t_2 are stretch[0] and stretch[1] times those of g, in the same parametrisation and with the same normals:
/// with P = sum_i stretch[i] t_i (x) t_i, tangents P a_a and curvature sym(b P^-1). A cylinder stretched around it has the larger radius.
SurfaceGeometry stretched(const SurfaceGeometry& g, const std::array<Vec3<double>, 2>& t, const std::array<double, 2>& stretch);

}  // namespace karcher
