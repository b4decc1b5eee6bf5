#pragma once
/// \file
/// The largest strain of the energies that are made for small ones.

#include <optional>

#include "karcher/io/summary.hpp"
#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Over all cells of the terms that tell a strain (QuantityInfo::small_up_to); nothing if there is no such term, or no number. \param u  the values that this rank
/// sees suffice. Collective.
std::optional<LargestStrain> largest_strain(const DiscreteProblem& model, const Configuration& u);

/// A sentence if it is larger than what the energy is made for; else empty.
std::string strain_warning(const DiscreteProblem& model, const LargestStrain& strain);

}  // namespace karcher
