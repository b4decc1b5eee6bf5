#pragma once
/// \file
/// Quadrature on reference cells, exact for polynomials of the given degree, positive weights, interior points.
/// Lines, quadrilaterals, hexahedra: products of Gauss rules with ceil((d+1)/2) points per direction. Simplices: symmetric rules (degree 1: centroid;
/// degree 2 on a triangle: (1/6,1/6), (2/3,1/6), (1/6,2/3); triangles to degree 14, tetrahedra to degree 8; beyond, conical products of Gauss-Jacobi
/// rules).

#include <vector>

#include "karcher/math/tensor.hpp"
#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

struct Quadrature {
  std::vector<Vec3<double>> points;
  std::vector<double> weights;  ///< sum = reference_measure(kind)
  int size() const { return static_cast<int>(weights.size()); }
};

/// Kept for the life of the program; safe to call from several threads. \throws InputError unless 0 <= degree <= 40.
const Quadrature& quadrature(CellKind kind, int degree);

}  // namespace karcher
