#pragma once
/// \file
/// What a space carries of the closure of a region: a film has nodes on the edge of a wall, not on the wall.

#include <vector>

#include "karcher/field/space.hpp"

namespace karcher {

/// Every entity of the region that the space carries; of one that it does not, the edges and vertices that it does (some twice).
std::vector<Cell> carried_parts(const Space& space, const Region& region);

}  // namespace karcher
