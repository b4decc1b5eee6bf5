#pragma once
/// \file
/// Orientation: a choice of the unit normal on every cell of a surface such that neighbours agree; or of a curve in the plane.
///
/// A cell's own normal is a_1 x a_2 / |a_1 x a_2|, right-handed to the order of its vertices, of a line a_1 x e_3 / |a_1 x e_3|. Two cells that share an edge agree where they run
/// through it in opposite senses, two lines where one begins at the end of the other. A surface on the boundary of a solid is oriented outwards, as is a curve on that of a plane
/// mesh; any other one as the first cell of each of its connected parts says.

#include <map>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

class Orientation {
 public:
  /// \param region  of dimension 2, or 1; its cells of any kind and order
  Orientation(const Mesh& mesh, const Region& region);

  /// False where there is no consistent choice: a part of the surface is one-sided (a Moebius strip, a Klein bottle), or three cells meet in an edge.
  bool exists() const { return exists_; }
  /// +1 or -1, by which the own normal of a cell of the region is to be multiplied; +1 where no orientation exists.
  int sign(const Cell& cell) const;

 private:
  bool exists_ = true;
  std::map<std::vector<int>, int> sign_;  ///< by the cell's vertices, ascending
};

}  // namespace karcher
