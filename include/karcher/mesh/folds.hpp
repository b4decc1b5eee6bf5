#pragma once
/// \file
/// Cells that fold over themselves: their maps are not one to one, and integrals over them mean nothing.

#include <optional>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

struct Fold {
  int cell = 0;
  Vec3<double> place;          ///< where the cell lies with its other side up
  double least = 0, most = 0;  ///< measures (length, area, volume per reference measure) in the sense of the cell's mean, least < 0
};

/// The first cell that is folded. Of a curve the tangent, of a surface the normal d_1 x d_2, of a solid the determinant is looked at on a lattice of
/// points, with the vertices: a cell is folded where it turns over between two points of a line that follow each other among those where it is larger than a
/// fiftieth of its largest size in the cell. So a surface in space may bend as it likes, and a corner of 180 degrees at a curved boundary, whose interpolation turns a little of the cell over, is forgiven.
/// Straight simplices are never folded.
std::optional<Fold> first_fold(const Mesh& mesh);

}  // namespace karcher
