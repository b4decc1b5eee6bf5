#pragma once
/// \file
/// Energy of every term on every cell, in a form that can be sent between ranks.

#include <array>
#include <vector>

#include "karcher/assembly/functional.hpp"

namespace karcher {

/// Energy of term `term` (index into Functional::terms) on one entity of the mesh. Trivially copyable: ranks may exchange it as bytes.
struct CellEnergy {
  int term = 0;
  CellKind kind = CellKind::vertex;
  std::array<int, 8> vertices{-1, -1, -1, -1, -1, -1, -1, -1};  ///< ascending mesh nodes, filled up with -1
  double energy = 0;
};

/// Of this rank's cells only; a run on several ranks gathers them on the one that writes.
std::vector<CellEnergy> cell_energies(const Functional& functional, const Configuration& u);

}  // namespace karcher
