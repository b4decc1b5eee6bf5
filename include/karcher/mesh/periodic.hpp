#pragma once
/// \file
/// Periodic meshes: nodes at different places that are one node for fields.

#include <utility>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Nodes of one side, each with the node of the other side that it is a copy of.
using PeriodicSide = std::vector<std::pair<int, int>>;

/// Sets Mesh::first_copies so that the two nodes of every pair are copies; pairs of nodes that are no vertices say nothing. \throws InputError where fields would
/// not fit together: a cell that meets itself or, in two edges, its neighbour (less than three cells around), sides whose cells do not match, cells that become one
void join_nodes(Mesh& mesh, const std::vector<PeriodicSide>& sides);

}  // namespace karcher
