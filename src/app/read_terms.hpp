#pragma once
/// \file
/// [[energies]] and [[loads]]: read by the tables of the catalogue.

#include "app/problem_file.hpp"

namespace karcher::app {

/// Appends the terms to the problem and their resolved form to problem.resolved. \param section "energies" or "loads"
void read_terms(const std::string& section, const std::vector<Value>& tables, ProblemFile& problem);

/// \throws InputError naming the fields there are and the nearest
int field_index(const ProblemFile& problem, const std::string& name, const Place& place);

}  // namespace karcher::app
