#pragma once
/// \file
/// Quadrature on reference cells, exact for polynomials of the given degree, positive weights, interior points.
/// Lines, quadrilaterals, hexahedra: products of Gauss rules with ceil((d+1)/2) points per direction. Simplices: symmetric rules (degree 1: centroid;
/// degree 2 on a triangle: (1/6,1/6), (2/3,1/6), (1/6,2/3)).

#include <vector>

#include "karcher/math/tensor.hpp"
#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

struct Quadrature {
  std::vector<Vec3<double>> points;
  std::vector<double> weights;  ///< sum = reference_measure(kind)
  int size() const { return static_cast<int>(weights.size()); }
};

/// \throws InputError if no rule of this degree is known for the kind (highest: see documentation of the file).
const Quadrature& quadrature(CellKind kind, int degree);

}  // namespace karcher
