#include "karcher/mesh/reference_geometry.hpp"

#include <fmt/format.h>

#include <cmath>

#include "karcher/error.hpp"

namespace karcher {

std::vector<GeometryJet> ReferenceGeometry::at(const Cell& cell, const std::vector<Vec3<double>>& points) const {
  std::vector<GeometryJet> jets;
  jets.reserve(points.size());
  if (!position_) {
    for (const auto& xi : points) jets.push_back(geometry(mesh_, cell, xi));
    return jets;
  }
  std::vector<Vec3<double>> nodes;
  for (const auto& xi : lagrange_nodes(cell.kind, order_)) {
    const Vec3<double> x = geometry(mesh_, cell, xi).x, p = position_(x);
    if (!std::isfinite(p[0] + p[1] + p[2]))
      throw InputError(fmt::format("The reference position is not finite at ({:.6g}, {:.6g}, {:.6g}).", x[0], x[1], x[2]));
    nodes.push_back(p);
  }
  for (const auto& xi : points) {
    const Shape shape = lagrange(cell.kind, order_, xi);
    GeometryJet& g = jets.emplace_back();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      g.x += shape.value[n] * nodes[n];
      for (std::size_t a = 0; a < 3; ++a) g.d[a] += shape.gradient[n][a] * nodes[n];
      for (std::size_t a = 0; a < 6; ++a) g.dd[a] += shape.hessian[n][a] * nodes[n];
    }
  }
  return jets;
}

CellFrame cell_frame(const GeometryJet& g, int dim) {
  CellFrame f;
  const auto degenerate = [&](double measure, double scale) {
    if (!(measure > 1e-14 * scale) || !std::isfinite(measure))
      throw InputError(
          fmt::format("A cell is degenerate (its map has measure {:.3g}) at ({:.6g}, {:.6g}, {:.6g}).", measure, g.x[0], g.x[1], g.x[2]));
  };
  if (dim == 0) {
    f.measure = 1;
  } else if (dim == 1) {
    f.measure = std::sqrt(norm2(g.d[0]));
    degenerate(f.measure, 1e-280);
    f.t[0] = (1 / f.measure) * g.d[0];
    f.to_frame(0, 0) = 1 / f.measure;
  } else if (dim == 2) {
    Vec3<double> n = cross(g.d[0], g.d[1]);
    f.measure = std::sqrt(norm2(n));
    degenerate(f.measure, std::sqrt(norm2(g.d[0]) * norm2(g.d[1])));
    n = (1 / f.measure) * n;
    if (n[2] < 0) n = -n;
    Vec3<double> t{{1, 0, 0}};
    t -= n[0] * n;
    if (norm2(t) < 0.01) t = Vec3<double>{{0, 1, 0}} - n[1] * n;
    f.t[0] = (1 / std::sqrt(norm2(t))) * t;
    f.t[1] = cross(n, f.t[0]);
    // df/dt_a = sum_b (a^b . t_a) df/dxi_b, the inverse of the matrix (a_b . t_a)
    Mat<double, 2, 2> m;
    for (int b = 0; b < 2; ++b)
      for (int a = 0; a < 2; ++a) m(b, a) = dot(g.d[static_cast<std::size_t>(b)], f.t[static_cast<std::size_t>(a)]);
    m = inverse(m);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) f.to_frame(a, b) = m(a, b);
  } else {
    Mat3<double> j;  // j(b, a) = dx_a/dxi_b
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) j(b, a) = g.d[static_cast<std::size_t>(b)][a];
    f.measure = std::abs(determinant(j));
    degenerate(f.measure, std::sqrt(norm2(g.d[0]) * norm2(g.d[1]) * norm2(g.d[2])));
    for (int a = 0; a < 3; ++a) f.t[static_cast<std::size_t>(a)][a] = 1;
    f.to_frame = inverse(j);
  }
  return f;
}

}  // namespace karcher
