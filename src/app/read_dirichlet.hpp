#pragma once
/// \file
/// [[dirichlet]]: values, and supports in a word.

#include "app/problem_file.hpp"
#include "app/section.hpp"

namespace karcher::app {

/// Appends the entries of one condition to the problem, whose fields and terms are known: one, or for a support in a word one for every field that it holds.
void read_dirichlet(Section& section, ProblemFile& problem);

}  // namespace karcher::app
