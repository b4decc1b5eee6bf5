#pragma once
/// \file
/// One run at a time writes into a directory of results.

#include <filesystem>

namespace karcher {

/// Holds the file `.lock` of a directory, which says which process has it since when. The lock is the system's (flock): it ends with the process, however that
/// ends, so a file that a killed process left locks nothing.
class DirectoryLock {
 public:
  /// Makes the directory if it is not there.
  /// \throws InputError if it cannot be made or written to, or if another process holds it, with that process and its start time
  explicit DirectoryLock(const std::filesystem::path& directory);
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  ~DirectoryLock();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace karcher
