#pragma once
/// \file
/// How far a body has moved.

#include "karcher/assembly/functional.hpp"

namespace karcher {

/// Largest distance between the places of a node in two configurations, over all fields that a term takes for places (TermInfo::moving), in diagonals of the mesh's
/// bounding box; 0 without such a field. Collective.
double diameters_moved(const Functional& functional, const Configuration& from, const Configuration& to);

}  // namespace karcher
