#pragma once
/// \file
/// Vectors without any symmetry, from which the solver seeks directions of negative curvature. A symmetric structure under a symmetric load has a symmetric
/// gradient; left to itself, rounding would choose the way in which it buckles.

#include <cstdint>
#include <vector>

#include "karcher/field/layout.hpp"

namespace karcher {

/// A number for each local dof that tells field, node and component, and is the same on any number of ranks.
std::vector<std::uint64_t> seed_numbers(const Layout& layout);

/// Entry in [-1, 1] of a seed vector at the dof of that number: pseudo-random.
double seed_entry(int seed, std::uint64_t number);

}  // namespace karcher
