#pragma once
/// \file
/// Measures and topology of meshes, for tests.

#include <cmath>
#include <vector>

#include "karcher/mesh/mesh.hpp"
#include "karcher/mesh/quadrature.hpp"

namespace karcher {

/// Length, area or volume element of the cell's geometry.
inline double jacobian(const GeometryJet& g, int dim) {
  if (dim == 0) return 1;
  if (dim == 1) return std::sqrt(norm2(g.d[0]));
  if (dim == 2) return std::sqrt(norm2(cross(g.d[0], g.d[1])));
  return dot(cross(g.d[0], g.d[1]), g.d[2]);
}

/// Integral of f over cells of the mesh.
template <class F>
double integrate(const Mesh& mesh, const std::vector<Cell>& cells, int degree, F f) {
  double sum = 0;
  for (const Cell& c : cells) {
    const Quadrature& q = quadrature(c.kind, degree);
    for (std::size_t i = 0; i < q.weights.size(); ++i) {
      const GeometryJet g = geometry(mesh, c, q.points[i]);
      sum += q.weights[i] * jacobian(g, dimension(c.kind)) * f(g.x);
    }
  }
  return sum;
}

inline double measure(const Mesh& mesh, const std::vector<Cell>& cells, int degree = 8) {
  return integrate(mesh, cells, degree, [](const Vec3<double>&) { return 1.0; });
}
inline double measure(const Mesh& mesh, int degree = 8) { return measure(mesh, mesh.cells, degree); }

inline int euler_characteristic(const Mesh& mesh) {
  int chi = 0;
  for (int d = 0; d <= mesh.dim; ++d) chi += (d % 2 ? -1 : 1) * static_cast<int>(entities(mesh, d, false).size());
  return chi;
}

}  // namespace karcher
