#pragma once

#include <vector>

#include "karcher/problem/problem.hpp"

namespace karcher {

/// Nodal values of a field at a load step of earlier results, interpolated to its nodes by its own rule. A node of this mesh takes the value of the place in that
/// mesh at which it is in the stress-free configuration; at a node of that mesh, and so everywhere on the same mesh, bit for bit. Where a surface crosses itself, the
/// place is that in the cell nearest to the node's own.
/// \returns in ambient coordinates, node after node
/// \throws InputError at the place of `start` where the results, the step, or the field are not there, have other values than points of the manifold, or where that
///   mesh has no place within a tenth of a cell of a node of this one
std::vector<double> start_values(const Problem& problem, const FieldSpec& field, const StartSpec& start, const Space& space);

}  // namespace karcher
