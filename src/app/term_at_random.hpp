#pragma once
/// \file
/// Terms of a problem at random nodal values near the initial ones, by themselves, for what `karcher check` measures; on one rank.

#include <random>
#include <vector>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher::app {

/// Tangent coordinates of all nodes of all fields, those that are fixed, too.
using Step = std::vector<std::vector<double>>;

/// Positions move by parts of a cell, other fields by parts of a radian.
Step random_step(const DiscreteProblem& model, double size, std::mt19937& random);
/// from, moved by factor times the step.
Configuration moved(const DiscreteProblem& model, const Configuration& from, const Step& step, double factor);
/// Initial values with random ones near them, at which all terms are defined; further away first.
Configuration near_the_start(const DiscreteProblem& model, std::mt19937& random);

/// A term at a configuration; with the derivatives along a step, where one is given.
struct Along {
  double energy = 0, first = 0, second = 0;
  double size = 0, first_size = 0, second_size = 0;  ///< sums of absolute values
  bool defined = true;
};
Along evaluate(const Term& term, const Configuration& u, const Step* step = nullptr);

}  // namespace karcher::app
