#pragma once
/// \file
/// Topological charge of maps of surfaces into the sphere.

#include <map>
#include <string>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// For every field with values in S^2 on an oriented surface: the area that it covers on the sphere, with sign, over 4 pi; a whole number where the surface is closed
/// or the field constant on its rim. The geodesic triangles between the field's nodes are summed (Berg, Luescher, Nucl. Phys. B 190 (1981) 412), so that the whole number
/// is exact whatever the mesh. Fields on one-sided surfaces are left out. \param u  complete on this rank
std::map<std::string, double> topological_charges(const DiscreteProblem& model, const Configuration& u);

}  // namespace karcher
