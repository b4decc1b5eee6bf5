#pragma once
/// \file
/// How large a mesh will be, before it is made.

#include <limits>
#include <string>

#include "karcher/memory.hpp"
#include "karcher/mesh/mesh.hpp"

namespace karcher {

struct MeshSize {
  double cells = 0;
  double nodes = 0;  ///< of the Lagrange lattice of the order, about
  double bytes = 0;  ///< while it is made, at least about
};

/// \param cells  number of cells of the kind
inline MeshSize mesh_size(CellKind kind, int order, double cells) {
  MeshSize s{cells, cells * reference_measure(kind), 0};
  for (int d = 0; d < dimension(kind); ++d) s.nodes *= order;
  // A cell is kept twice, under "all" too, and stands twice in what is made of it; a node has a position, a key and a place in the numbering.
  const double cell = static_cast<double>(sizeof(Cell)) + 16 + 4.0 * node_count(kind, order), node = 100;
  s.bytes = 4 * cells * cell + node * s.nodes;
  return s;
}

/// \throws InputError if nodes cannot be numbered by an int, or if memory is too small
inline void require_room(const MeshSize& size, const std::string& what) {
  if (size.nodes > std::numeric_limits<int>::max() || size.cells > std::numeric_limits<int>::max())
    throw InputError(fmt::format("{} has about {:.3g} cells and {:.3g} nodes; more than {:.2g} are not numbered.", what, size.cells, size.nodes,
                                 static_cast<double>(std::numeric_limits<int>::max())));
  require_memory(size.bytes, fmt::format("{} of about {:.3g} cells", what, size.cells));
}

}  // namespace karcher
