#pragma once
/// \file
/// The entity of a region nearest to a point, for probes.

#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

struct Location {
  int cell = -1;             ///< of the region
  Vec3<double> xi;           ///< reference coordinates there, inside the reference cell
  double distance = 0;       ///< from the point to the place found
  double cell_diameter = 0;  ///< largest distance of two vertices of the cell
};

/// The nearest place of the region's (curved) geometry; of several equally near, one in the cell of lowest number.
Location nearest(const Mesh& mesh, const Region& region, const Vec3<double>& point);

/// The nearest place, which must be near: a probe is a point of the exact surface, from which a mesh of straight cells differs.
/// \param tolerance  largest distance in diameters of the nearest cell \throws InputError with the distance and the nearest place if it is farther or the
/// point is not finite
Location locate(const Mesh& mesh, const Region& region, const Vec3<double>& point, double tolerance = 0.1);

}  // namespace karcher
