#pragma once
/// \file
/// Problem files: every key known, every type right, every name of a field resolved, every default filled in.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/point_value.hpp"
#include "app/toml_value.hpp"
#include "karcher/problem/problem.hpp"

namespace karcher::app {

/// A problem while it is read, and what its data are read from.
struct ProblemFile : Problem {
  Scope scope;
  Value values;                            ///< the file with all defaults: Problem::resolved
  std::map<int, PointValue> exact_values;  ///< by field
};

struct ReadOptions {
  std::vector<std::string> overrides;  ///< --set
  std::filesystem::path output;        ///< --output; empty: as the file says
};

/// \throws InputError with file, line and column of what is wrong
Problem read_problem(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace karcher::app
