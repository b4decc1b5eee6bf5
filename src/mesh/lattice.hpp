#pragma once
/// \file
/// Equispaced lattices on reference cells, of any order q (a cell of order p refined once has the lattice of order 2 p), and the smallest entity of
/// the cell that holds each point. Everything in integers, so that equal places are found equal.

#include <array>
#include <vector>

#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

/// Point i / q of the reference cell.
using LatticePoint = std::array<int, 3>;

/// The smallest entity of the cell that holds a lattice point.
struct LatticePlace {
  CellKind entity = CellKind::vertex;
  std::array<int, 8> vertices{-1, -1, -1, -1, -1, -1, -1, -1};  ///< local vertex numbers, in the entity's own order
  LatticePoint point{};                                         ///< in the entity's own reference coordinates
};

/// Points of the lattice, in the node order of reference_cell.hpp; interior points of faces and cells with x fastest, then y, then z.
const std::vector<LatticePoint>& lattice(CellKind kind, int q);
/// Place of every lattice point, same order. Edges, faces and their vertices as in edges(kind), faces(kind).
const std::vector<LatticePlace>& lattice_places(CellKind kind, int q);

/// Corners of the reference cell (coordinates 0 or 1).
const std::vector<LatticePoint>& corners(CellKind kind);

/// Values of the vertex functions (order 1) at a reference point: barycentric or tensor product coordinates.
std::vector<double> vertex_functions(CellKind kind, const Vec3<double>& xi);
/// The same at point / q, exactly zero for the vertices that do not matter there.
std::vector<double> vertex_functions(CellKind kind, const LatticePoint& point, int q);

}  // namespace karcher
