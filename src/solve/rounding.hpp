#pragma once
/// \file
/// Rounding: how much of a gradient and of an energy is rounding, by the Hessian H and the values of the fields. A gradient is a sum of forces between nodes that
/// are computed from differences of nodal values, so component i is wrong by some roundings of every product H_ij x_j, x_j the size of the value that is
/// subtracted: |coordinate| for points of R^n, 1 for points of the other manifolds. Where forces or strains cancel, as in a structure without load, no relative
/// error of what is left would tell.

#include <span>
#include <vector>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/solve/exchange.hpp"

namespace karcher {

struct Rounding {
  std::vector<double> gradient;  ///< [local dof] e (sum_j (H_ij x_j)^2)^1/2, e the distance of 1 from the next number; 0 where fixed
  double gradient_norm = 0;      ///< |.|_* of it
  double energy = 0;             ///< 1/2 e^2 sum_i |H_ii| x_i^2, the energy of nodal values that are wrong by e x
};

/// All spans by local dof. Collective.
Rounding rounding_of(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> mass,
                     std::span<const double> sizes);

/// x_d for every local dof at u.
std::vector<double> sizes_of(const Layout& layout, const Configuration& u);

}  // namespace karcher
