#pragma once
/// \file
/// What a problem lacks to be held: rigid motions that no boundary condition prevents.

#include <string>
#include <vector>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Sentences about the connected parts of the body that an elastic energy (EnergyInfo::stress_free) makes of its deformation: the rigid motions v = a + w x (x - c),
/// to which rotations answer by w, that no fixed component of the deformation or of a rotation prevents, and whether the loads at the end push that way. A field
/// that another energy than a load holds, too, is passed over. Motions count from the stress-free configuration. Collective.
std::vector<std::string> free_motions(const Problem& problem, const DiscreteProblem& model);

}  // namespace karcher
