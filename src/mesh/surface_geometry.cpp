#include "karcher/mesh/surface_geometry.hpp"

#include <fmt/format.h>

#include <cmath>

#include "karcher/error.hpp"

namespace karcher {

namespace {

/// Curvatures and frame of b, for the tangents and the normal of g.
void set_principal_frame(SurfaceGeometry& g) {
  // b in the orthonormal basis (s1, s2) is ((mean + d, o), (o, mean - d)): its eigenvectors are at half the angle of (d, o). An umbilic has d = o = 0 and
  // keeps s1, s2; near one the angle is that of rounding errors, which does no harm, since both curvatures agree there.
  const Vec3<double> s1 = (1 / std::sqrt(norm2(g.tangent[0]))) * g.tangent[0], s2 = cross(g.normal, s1);
  const double c11 = dot(s1, g.b * s1), c12 = dot(s1, g.b * s2), c22 = dot(s2, g.b * s2);
  const double mean = 0.5 * (c11 + c22), d = 0.5 * (c11 - c22), radius = std::hypot(d, c12), angle = 0.5 * std::atan2(c12, d);
  const Vec3<double> t1 = std::cos(angle) * s1 + std::sin(angle) * s2, t2 = cross(g.normal, t1);
  g.curvature = {mean + radius, mean - radius};
  for (int i = 0; i < 3; ++i) {
    g.frame(i, 0) = t1[i];
    g.frame(i, 1) = t2[i];
    g.frame(i, 2) = g.normal[i];
  }
}

}  // namespace

Mat<double, 2, 2> SurfaceGeometry::jacobian() const {
  Mat<double, 2, 2> j;
  for (int row = 0; row < 2; ++row)
    for (int col = 0; col < 2; ++col) j(row, col) = dot(dual[static_cast<std::size_t>(row)], column(frame, col));
  return j;
}

SurfaceGeometry surface_geometry(const GeometryJet& jet) {
  SurfaceGeometry g;
  g.x = jet.x;
  g.tangent = {jet.d[0], jet.d[1]};
  const Vec3<double> a1 = jet.d[0], a2 = jet.d[1], n = cross(a1, a2);
  g.area = std::sqrt(norm2(n));
  const double scale = std::sqrt(norm2(a1) * norm2(a2));
  if (!(g.area > 1e-12 * scale) || !std::isfinite(scale)) {
    throw InputError(
        fmt::format("The reference surface is degenerate at ({:.6g}, {:.6g}, {:.6g}): its two tangent vectors are parallel, zero or not finite.",
                    jet.x[0], jet.x[1], jet.x[2]));
  }
  g.normal = (1 / g.area) * n;
  const double area2 = g.area * g.area;
  g.dual[0] = (1 / area2) * cross(a2, n);
  g.dual[1] = (1 / area2) * cross(n, a1);
  const double b11 = dot(g.normal, jet.dd[0]), b12 = dot(g.normal, jet.dd[1]), b22 = dot(g.normal, jet.dd[3]);
  g.b = b11 * outer(g.dual[0], g.dual[0]) + b12 * (outer(g.dual[0], g.dual[1]) + outer(g.dual[1], g.dual[0])) + b22 * outer(g.dual[1], g.dual[1]);
  g.c = g.area * (outer(g.dual[0], g.dual[1]) - outer(g.dual[1], g.dual[0]));

  set_principal_frame(g);
  return g;
}

SurfaceGeometry stretched(const SurfaceGeometry& g, const std::array<Vec3<double>, 2>& t, const std::array<double, 2>& stretch) {
  SurfaceGeometry s = g;
  for (auto& a : s.tangent) a = stretch[0] * dot(t[0], a) * t[0] + stretch[1] * dot(t[1], a) * t[1];
  for (auto& a : s.dual) a = dot(t[0], a) / stretch[0] * t[0] + dot(t[1], a) / stretch[1] * t[1];
  s.area *= stretch[0] * stretch[1];
  const Mat3<double> shrink = (1 / stretch[0]) * outer(t[0], t[0]) + (1 / stretch[1]) * outer(t[1], t[1]), b = g.b * shrink;
  s.b = 0.5 * (b + transpose(b));
  set_principal_frame(s);
  return s;
}

}  // namespace karcher
