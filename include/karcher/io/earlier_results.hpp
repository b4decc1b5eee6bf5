#pragma once
/// \file
/// What earlier runs left in a directory of results.

#include <filesystem>
#include <string>

namespace karcher {

/// Removes the files that a killed process was writing (atomic_file.hpp). The caller holds the directory (directory_lock.hpp).
void remove_unfinished_files(const std::filesystem::path& directory);

/// Removes what would be taken for a new run's: checkpoint, summary, page with its data, and the states that the collection names; and unfinished files.
/// \returns a sentence about the run that made them; empty if there was none
std::string remove_earlier_results(const std::filesystem::path& directory);

}  // namespace karcher
