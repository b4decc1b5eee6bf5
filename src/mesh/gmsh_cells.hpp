#pragma once
/// \file
/// The cell types of Gmsh and the order of their nodes.

#include <string>
#include <vector>

#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

/// A cell type that we read. `kind` and `order` as in Cell; node i of our cell is node permutation[i] of Gmsh's.
struct GmshCell {
  CellKind kind = CellKind::vertex;
  int order = 1;
  std::vector<int> permutation;
};

/// nullptr for types that are not read.
const GmshCell* gmsh_cell(int type);
/// What a type is that we do not read: "type 6, a prism".
std::string gmsh_unread(int type);

}  // namespace karcher
