#pragma once
/// \file
/// run.log: what a run says, also a quiet one, for the next morning. Written line by line; a full disk cuts it off and does not touch the run.

#include <cstdio>
#include <filesystem>
#include <memory>

#include "karcher/io/console_table.hpp"

namespace karcher {

class RunLog {
 public:
  /// \param steps  as of ConsoleTable \param resumed  goes on behind what is there, with the time; else a new file
  /// Make one on the rank that talks only. \throws Error if the file cannot be written
  RunLog(const std::filesystem::path& file, int steps, bool resumed);
  ConsoleTable& table() { return table_; }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  ConsoleTable table_;
};

}  // namespace karcher
