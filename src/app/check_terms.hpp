#pragma once
/// \file
/// What `karcher check` measures term by term, at random nodal values near the initial ones; on one rank.

#include "karcher/problem/discrete_problem.hpp"

namespace karcher::app {

/// Prints how far gradient and Hessian of every term are from differences of its energy. \returns whether they are right
bool check_derivatives(const DiscreteProblem& model);

/// Prints how much the energy of every term of positions, rotations and directors changes by rigid motions of them together. \returns whether none does
bool check_objectivity(const Problem& problem, const DiscreteProblem& model);

}  // namespace karcher::app
