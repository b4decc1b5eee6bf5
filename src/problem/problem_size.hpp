#pragma once

#include "karcher/problem/problem.hpp"

namespace karcher {

/// \throws InputError if the mesh, refined, with its fields and the Hessian of its energies cannot fit into memory, or if its nodes cannot be numbered
void require_room(const Problem& problem, const Mesh& coarse);

}  // namespace karcher
