#pragma once
/// \file
/// Mirror planes of the body through nodes of a field of directions (`symmetry` under [[dirichlet]]): there a director lies in the plane, as the mean of its own and of its mirror image's normal does.

#include <vector>

#include "karcher/problem/problem.hpp"

namespace karcher {

/// For every node of the space bit i: a mirror plane normal to axis i passes through it.
std::vector<unsigned char> mirror_planes(const Problem& problem, int field, const Space& space);

}  // namespace karcher
