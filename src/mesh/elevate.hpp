#pragma once
/// \file
/// Meshes of geometry order 1 to 3 from cells given by vertices and their parameters.

#include <functional>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

using Map = std::function<Vec3<double>(const Vec3<double>&)>;

/// Cells of order 1 (`nodes` are vertex numbers from 0 without gaps, `parameters` one for each) to a mesh of the given order: every node is the image
/// of the parameters that (multi)linear interpolation gives it, through the first cell that has the node. Region "all" is set, all others are not.
/// \throws InputError as check_identity does
Mesh elevate(std::vector<Cell> cells, int order, const Map& map);

/// sum_i w_i p_i with weights of sum 1, exact in every coordinate that the points of non-zero weight share.
Vec3<double> combine(const std::vector<double>& weights, const std::vector<Vec3<double>>& points);

}  // namespace karcher
