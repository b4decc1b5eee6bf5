#pragma once

#include <map>
#include <string>
#include <vector>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Values of the probes at a complete configuration, by their names. \throws InputError for a probe off the field's region
std::map<std::string, std::vector<double>> probe_values(const Problem& problem, const DiscreteProblem& model, const Configuration& u);

/// One probe. \throws InputError as above
std::vector<double> probe_value(const ProbeSpec& probe, const Problem& problem, const DiscreteProblem& model, const Configuration& u);

}  // namespace karcher
