#pragma once
/// \file
/// The energy of the stress-free configuration, which is zero where the fields can take it.

#include <string>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Sets model.reference_energies, of the terms with EnergyInfo::stress_free, and warns of those that are not zero: of more than 1e-12 of the energy of a body that
/// is larger by a hundredth, which is a strain of 1e-8. Collective.
void measure_reference(const Problem& problem, DiscreteProblem& model);

/// "energy at the reference: 1.2e-31 (cosserat-shell)"; empty without such terms.
std::string reference_sentence(const DiscreteProblem& model);

}  // namespace karcher
