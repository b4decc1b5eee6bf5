#pragma once
/// \file
/// probes.csv: the probes after every load step, a row each.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "karcher/io/row_file.hpp"
#include "karcher/io/summary.hpp"

namespace karcher {

/// load_step,t,NAME for probes of one number, NAME.0, NAME.1, ... for those of several; names with commas or quotes stand in quotes. Numbers read back to the
/// same double; not finite ones are nan, inf, -inf. Problems without probes have no file.
/// Names of the columns of probes in CSV files: "tip.0" where a probe has several numbers, quoted where its name has commas or quotes.
std::vector<std::string> probe_columns(const std::map<std::string, std::vector<double>>& probes);

class ProbesCsv {
 public:
  /// Writes the rows of the finished load steps, if there are any; else the file is made with the first row.
  ProbesCsv(std::filesystem::path file, const std::vector<LoadStepSummary>& finished);
  /// \param load_step  its number, from 1 \throws Error if the file cannot be written
  void add(int load_step, const LoadStepSummary& step);

 private:
  std::filesystem::path file_;
  std::optional<RowFile> rows_;
};

}  // namespace karcher
