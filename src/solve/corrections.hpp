#pragma once

#include "solve/system.hpp"

namespace karcher {

/// Goes on from the trial point x with the matrix that the subproblem has already, as long as it pays (simplified Newton steps), at most
/// SolverOptions::max_corrections times and until |g|_* <= tolerance. x is evaluated; the energy of what it becomes is never higher, but for noise.
/// \param base_energy  where the step began; +infinity: unknown
/// \param step         from there to x
void correct(System& system, Iterate& x, double base_energy, const Step& step, double tolerance);

}  // namespace karcher
