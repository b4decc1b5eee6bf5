#pragma once
/// \file
/// load_steps.jsonl: the entry of summary.json of every finished load step, one line of JSON each, on the disk before the checkpoint that counts it.

#include <filesystem>
#include <vector>

#include "karcher/io/row_file.hpp"
#include "karcher/io/summary.hpp"

namespace karcher {

class LoadStepsFile {
 public:
  /// A new file with the load steps that are finished. \throws Error if it cannot be written
  LoadStepsFile(const std::filesystem::path& directory, const std::vector<LoadStepSummary>& finished);
  void add(const LoadStepSummary& step);

 private:
  RowFile file_;
};

/// What the file in a directory of results holds; nothing if there is none. \throws InputError naming file and line of what is no load step
std::vector<LoadStepSummary> read_load_steps(const std::filesystem::path& directory);

/// summary.json of a directory with the load steps that it does not hold yet: it is written more seldom than they end where they take milliseconds.
/// \throws InputError naming the file
Summary read_results(const std::filesystem::path& directory);

}  // namespace karcher
