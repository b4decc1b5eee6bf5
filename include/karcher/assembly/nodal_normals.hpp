#pragma once
/// \file
/// Unit normals of the stress-free surface at the nodes of a space, for directors: at a node the mean of the normals of the cells around it, by their areas there, all on the
/// side that Orientation chooses.

#include <vector>

#include "karcher/field/space.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {

/// \param region  of dimension 2, carried by the space
/// \param mirrors  by node, none or bit i where the surface goes on as its mirror image in a plane normal to axis i: the mean with the image's normal has no component along it
/// \returns one for every node; zero at nodes off the region
/// \throws InputError where the surface is one-sided, or folded so that the normals around a node cancel
std::vector<Vec3<double>> nodal_normals(const Space& space, const Region& region, const ReferenceGeometry& reference,
                                        const std::vector<unsigned char>& mirrors = {});

}  // namespace karcher
