#pragma once
/// \file
/// Where a mesh is not one: fields are not joined across a seam.

#include <string>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Sentences about parts of the mesh that share no node, and about nodes that lie at one place (to 1e-9 of the size of the mesh) without being one node.
std::vector<std::string> seams(const Mesh& mesh);

}  // namespace karcher
