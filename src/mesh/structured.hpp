#pragma once
/// \file
/// Cells from grids of parameters.

#include <array>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// A grid of n[0] x n[1] quadrilaterals in the parameter rectangle [lower, upper], possibly glued to itself.
struct SurfaceGrid {
  std::array<int, 2> cells{1, 1};
  std::array<double, 2> lower{0, 0}, upper{1, 1};
  std::array<bool, 2> closed{false, false};  ///< the high end of this direction is the low end again
  bool flipped = false;                      ///< closed[0] glues (upper, s) to (lower, lower[1] + upper[1] - s): Moebius strip, Klein bottle
  bool triangles = true;                     ///< each quadrilateral cut from lower left to upper right
};

/// Cells of order 1 with vertex numbers and parameters, as elevate() takes them.
/// \throws InputError for a closed direction with fewer than three cells
std::vector<Cell> surface_cells(const SurfaceGrid& grid);

/// n[0] x n[1] x n[2] hexahedra in [0, n[0]] x [0, n[1]] x [0, n[2]], or six tetrahedra in each (Kuhn's subdivision along the main diagonal).
std::vector<Cell> solid_cells(const std::array<int, 3>& cells, bool tetrahedra);

/// Triangles, each cut into n x n; corner parameters are interpolated, vertices that triangles share are shared.
std::vector<Cell> subdivide_triangles(const std::vector<Cell>& triangles, int n);

/// Quadrilaterals on the square [-2, 2]^2 of parameters: n x n in [-1, 1]^2 and n rings of 4 n around, their corners on rays from the origin.
std::vector<Cell> ringed_square(int n);

}  // namespace karcher
