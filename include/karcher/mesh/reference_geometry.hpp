#pragma once
/// \file
/// The stress-free reference configuration: the mesh's own geometry, or the Lagrange interpolant of a position given as a function of the mesh point.

#include <functional>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

class ReferenceGeometry {
 public:
  using Position = std::function<Vec3<double>(const Vec3<double>&)>;

  /// \param position  empty: the mesh's own geometry  \param order  Lagrange order 1..3 of the interpolant of `position` on every cell
  ReferenceGeometry(const Mesh& mesh, Position position, int order) : mesh_(mesh), position_(std::move(position)), order_(order) {}

  /// Position with first and second derivatives in the reference coordinates, at several points of one cell.
  /// \throws InputError if `position` is not finite at a node of the cell.
  std::vector<GeometryJet> at(const Cell& cell, const std::vector<Vec3<double>>& points) const;

 private:
  const Mesh& mesh_;
  Position position_;
  int order_;
};

/// Orthonormal directions t_1, ..., t_dim of the cell at a point and the measure (length, area, volume per reference measure).
/// Curve: the unit tangent. Surface: t_1 along the projection of e_1 (of e_2 where the surface is nearly normal to e_1), t_2 = n x t_1 with the
/// normal that does not point to -e_3, so that planar problems in the x-y plane have the axes. Solid: the axes.
struct CellFrame {
  double measure = 0;
  std::array<Vec3<double>, 3> t{};
  /// d_a f = sum_b to_frame(a, b) df/dxi_b
  Mat3<double> to_frame;
};
/// \throws InputError with the place where the geometry is degenerate.
CellFrame cell_frame(const GeometryJet& g, int dim);

}  // namespace karcher
