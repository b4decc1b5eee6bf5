#include "karcher/io/iterations.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "karcher/error.hpp"

namespace karcher {
namespace {

constexpr std::string_view header = "load_step,iteration,energy,gradient_norm,step_norm,radius,shift,ratio,accepted,seconds";

/// fmt prints doubles by their shortest representation that reads back to the same value.
std::string row(const IterationRecord& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{}\n", r.load_step, r.iteration, r.energy, r.gradient_norm, r.step_norm, r.radius, r.shift, r.ratio,
                     r.accepted ? 1 : 0, r.seconds);
}

/// The next number of a row, whose separator is consumed too; false where there is none.
template <class T>
bool take(std::string_view& rest, T& value) {
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc()) return false;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  if (!rest.empty() && rest.front() == ',') rest.remove_prefix(1);
  return true;
}

bool parse(std::string_view text, IterationRecord& r) {
  int accepted = 0;
  const bool whole = take(text, r.load_step) && take(text, r.iteration) && take(text, r.energy) && take(text, r.gradient_norm) &&
                     take(text, r.step_norm) && take(text, r.radius) && take(text, r.shift) && take(text, r.ratio) && take(text, accepted) &&
                     take(text, r.seconds) && text.empty();
  r.accepted = accepted != 0;
  return whole;
}

std::string rows(const std::filesystem::path& file, int first_load_step) {
  std::string content = fmt::format("{}\n", header);
  if (first_load_step > 0 && std::filesystem::exists(file))
    for (const IterationRecord& r : read_iterations(file))
      if (r.load_step < first_load_step) content += row(r);
  return content;
}

}  // namespace

IterationsCsv::IterationsCsv(const std::filesystem::path& file, int first_load_step) : file_(file, rows(file, first_load_step)) {}

void IterationsCsv::iteration(const IterationRecord& record) { file_.append(row(record)); }

std::vector<IterationRecord> read_iterations(const std::filesystem::path& file) {
  const std::string content = whole_rows(file);
  std::string_view rest = content;
  std::vector<IterationRecord> records;
  for (int line = 1; !rest.empty(); ++line) {
    const std::string_view text = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(text.size() + 1);
    IterationRecord r;
    if (line == 1 ? text != header : !parse(text, r))
      throw InputError(fmt::format("{}, line {}: not a row of a table of iterations.", file.string(), line));
    if (line > 1) records.push_back(r);
  }
  return records;
}

}  // namespace karcher
