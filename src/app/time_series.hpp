#pragma once
/// \file
/// Parameters that follow a measured or planned history: a column of a CSV file, piecewise linear in t.

#include <filesystem>
#include <string>

#include "app/expression.hpp"
#include "app/section.hpp"

namespace karcher::app {

struct TimeSeries {
  std::string parameter;  ///< for messages: "parameters.P"
  Place place;            ///< in the problem file
  std::filesystem::path file;
  std::string content;  ///< of the file
  double first = 0, last = 0;
  int first_line = 0, last_line = 0;
  Expression value;
};

/// \param s the table {csv = ..., column = ...} \param base directory of relative paths \throws InputError with the line of the CSV file
TimeSeries read_time_series(Section& s, const std::filesystem::path& base, const Scope& scope);

/// \throws InputError where load steps from `from` to `to` leave the series
void require_range(const TimeSeries& series, double from, double to);

}  // namespace karcher::app
