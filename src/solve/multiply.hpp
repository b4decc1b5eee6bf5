#pragma once

#include <span>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/solve/exchange.hpp"

namespace karcher {

/// y = H x for the symmetric matrix over all ranks; x with filled ghosts, y gets them too. Rows and columns with fixed[dof] != 0 are left out
/// (pass an empty span to keep them). Collective.
void multiply(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> x, std::span<double> y);

}  // namespace karcher
