#pragma once
/// \file
/// iterations.csv: one row per iteration, on the disk as soon as the iteration is done.
///
/// load_step,iteration,energy,gradient_norm,step_norm,radius,shift,ratio,accepted,seconds
/// Numbers read back to the same double (nan, inf, -inf where they are that); accepted is 1 or 0. Rows are whole (row_file.hpp).

#include <filesystem>
#include <string>
#include <vector>

#include "karcher/io/row_file.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

class IterationsCsv : public Observer {
 public:
  /// Starts a new file, or, with first_load_step > 0 (a resumed run), keeps the rows of earlier load steps and drops the others.
  /// Make one on the rank that writes only. \throws Error if the file cannot be written, InputError if a kept file is not of this format.
  explicit IterationsCsv(const std::filesystem::path& file, int first_load_step = 0);

  void iteration(const IterationRecord& record) override;

 private:
  RowFile file_;
};

/// \throws InputError naming file and line.
std::vector<IterationRecord> read_iterations(const std::filesystem::path& file);

}  // namespace karcher
