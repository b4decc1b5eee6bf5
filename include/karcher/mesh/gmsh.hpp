#pragma once
/// \file
/// Reader for Gmsh's mesh files (MSH 2.2 and 4.1, ASCII and binary; https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats).

#include <string>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// What becomes of the nodes that $Periodic pairs: copies of one node (Mesh::first_copies), or nothing.
enum class PeriodicSides { joined, apart };

/// The mesh of all cells of the highest dimension in the file, lines to hexahedra of order 1 to 3; kinds and orders may be mixed. Every physical
/// group becomes a region under its name; a group without one is "point-4", "curve-4", "surface-4" or "volume-4" by its tag. A name that is used in
/// several dimensions belongs to the highest; the others get ":0", ":1", ":2" appended. An entity may belong to any number of groups or none.
/// Nodes that no cell uses are left out, and groups with entities that are no part of a cell: Mesh::left_out.
/// \throws InputError naming the file and the line (ASCII) or section (binary), for what cannot be opened, is truncated or malformed, for cells that
/// we do not read (serendipity cells, prisms, pyramids, order above 3), for nodes that are missing or not finite, for cells that are
/// folded over themselves (folds.hpp), and as check_identity and join_nodes do.
Mesh read_gmsh(const std::string& path, PeriodicSides sides = PeriodicSides::joined);

}  // namespace karcher
