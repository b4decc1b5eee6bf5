#pragma once
/// \file
/// The table of subproblems, by the names that SolverOptions::subproblem may take. A new one is its header, its source and a line in the table.

#include <memory>
#include <span>

#include "solve/subproblem.hpp"

namespace karcher {

struct SubproblemKind {
  const char* name;
  std::unique_ptr<Subproblem> (*make)(const SubproblemInput&);
};
std::span<const SubproblemKind> subproblems();

}  // namespace karcher
