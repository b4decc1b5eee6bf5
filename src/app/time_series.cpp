#include "app/time_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace karcher::app {
namespace {

struct Row {
  double t = 0, value = 0;
  int line = 0;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r";
  const auto begin = text.find_first_not_of(space);
  if (begin == text.npos) return {};
  text = text.substr(begin, text.find_last_not_of(space) - begin + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string read_file(const Place& place, const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  if (!in || !std::filesystem::is_regular_file(file) || !(content << in.rdbuf()))
    refuse(place, fmt::format("the file {} cannot be read.", file.string()));
  std::string text = content.str();
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

/// The rows of two columns; names stand in the first line that is neither empty nor a comment (#).
std::vector<Row> rows_of(const TimeSeries& series, const std::string& time, const std::string& column) {
  const std::string file = series.file.string();
  std::vector<Row> rows;
  std::vector<std::string> names;
  std::size_t t_place = 0, value_place = 0;
  std::istringstream in(series.content);
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const Place here{file, line, 1};
    if (const std::string_view content = trimmed(text); content.empty() || content.front() == '#') continue;
    const std::vector<std::string> cells = cells_of(text);
    if (names.empty()) {
      names = cells;
      const auto place_of = [&](const std::string& name) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) refuse_name(here, series.parameter + ": there is no column", name, names);
        return static_cast<std::size_t>(found - names.begin());
      };
      t_place = place_of(time);
      value_place = place_of(column);
      continue;
    }
    if (cells.size() != names.size())
      refuse(here, fmt::format("{}: {} columns are expected, as in the line of names, not {}.", series.parameter, names.size(), cells.size()));
    const auto number = [&](std::size_t place) {
      const std::string& cell = cells[place];
      double x = 0;
      const char *begin = cell.data() + (cell.starts_with('+') ? 1 : 0), *end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(begin, end, x);
      if (error != std::errc() || stop != end || !std::isfinite(x))
        refuse(here, fmt::format("{}: \"{}\" in the column \"{}\" is no number.", series.parameter, cell, names[place]));
      return x;
    };
    const Row row{number(t_place), number(value_place), line};
    if (!rows.empty() && !(row.t > rows.back().t))
      refuse(here, fmt::format("{}: {} must increase from line to line, but {} follows {} of line {}.", series.parameter, time, row.t, rows.back().t,
                               rows.back().line));
    rows.push_back(row);
  }
  if (names.empty()) refuse({file, 1, 1}, series.parameter + ": the file is empty; a line with the names of the columns comes first.");
  if (rows.size() < 2)
    refuse({file, 1, 1},
           fmt::format("{}: a series needs at least two lines of numbers; there {}.", series.parameter, rows.empty() ? "is none" : "is one"));
  return rows;
}

/// The chords between rows `first` and `last`, found by bisection, so that no value takes longer than the logarithm of their number.
void append_formula(const std::vector<Row>& rows, std::size_t first, std::size_t last, std::string& text) {
  if (last - first > 1) {
    const std::size_t middle = (first + last) / 2;
    text += fmt::format("(t<{}?", rows[middle].t);
    append_formula(rows, first, middle, text);
    text += ':';
    append_formula(rows, middle, last, text);
    text += ')';
    return;
  }
  const Row &a = rows[first], &b = rows[last];
  text += a.value == b.value ? fmt::format("{}+0*t", a.value) : fmt::format("{}+{}*(t-{})", a.value, (b.value - a.value) / (b.t - a.t), a.t);
}

}  // namespace

TimeSeries read_time_series(Section& s, const std::filesystem::path& base, const Scope& scope) {
  TimeSeries series;
  series.parameter = s.path();
  series.place = s.place();
  const std::filesystem::path given = s.text("csv");
  series.file = (given.is_absolute() ? given : base / given).lexically_normal();
  s.note("csv", Value::of(series.file.string()));
  const std::string column = s.text("column"), time = s.text("time");
  series.content = read_file(s.place("csv"), series.file);
  const std::vector<Row> rows = rows_of(series, time, column);
  std::string formula;
  append_formula(rows, 0, rows.size() - 1, formula);
  if (formula.size() > Symbols::longest_text)
    refuse(s.place("csv"), fmt::format("{}: {} has {} lines of numbers, which are too many (about 10000 are possible).", series.parameter,
                                       series.file.string(), rows.size()));
  series.value = scope.compile(formula, series.parameter, series.place);
  series.first = rows.front().t;
  series.last = rows.back().t;
  series.first_line = rows.front().line;
  series.last_line = rows.back().line;
  return series;
}

void require_range(const TimeSeries& series, double from, double to) {
  const double least = std::min(from, to), most = std::max(from, to), same = 1e-9 * (most - least);
  const auto outside = [&](const char* what, double t, int line) {
    refuse(series.place, fmt::format("{}: {} {} at t = {} (line {}), but the load parameter goes from {} to {}.", series.parameter,
                                     series.file.string(), what, t, line, from, to));
  };
  if (series.first > least + same) outside("begins", series.first, series.first_line);
  if (series.last < most - same) outside("ends", series.last, series.last_line);
}

}  // namespace karcher::app
