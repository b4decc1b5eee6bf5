#pragma once

#include <vector>

#include "karcher/field/space.hpp"
#include "karcher/problem/problem.hpp"

namespace karcher {

/// The nodes of a space as points of the mesh, with the oriented unit normals of a surface where they are wanted: at a node that several cells share, that of
/// the first one.
std::vector<MeshPoint> mesh_points(const Space& space, bool with_normals);

}  // namespace karcher
