#include "karcher/io/load_steps_file.hpp"

#include <fmt/format.h>

#include <string_view>

namespace karcher {
namespace {

constexpr const char* file_name = "load_steps.jsonl";

std::string rows(const std::vector<LoadStepSummary>& steps) {
  std::string text;
  for (const LoadStepSummary& step : steps) text += to_json_line(step);
  return text;
}

}  // namespace

LoadStepsFile::LoadStepsFile(const std::filesystem::path& directory, const std::vector<LoadStepSummary>& finished)
    : file_(directory / file_name, rows(finished)) {}

void LoadStepsFile::add(const LoadStepSummary& step) {
  file_.append(to_json_line(step));
  file_.flush();
}

std::vector<LoadStepSummary> read_load_steps(const std::filesystem::path& directory) {
  std::vector<LoadStepSummary> steps;
  const std::filesystem::path file = directory / file_name;
  if (!std::filesystem::exists(file)) return steps;
  const std::string content = whole_rows(file);
  for (std::string_view rest = content; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(line.size() + 1);
    steps.push_back(load_step_from_json(line, fmt::format("{}, line {}", file.string(), steps.size() + 1)));
  }
  return steps;
}

Summary read_results(const std::filesystem::path& directory) {
  Summary summary = read_summary(directory / "summary.json");
  std::vector<LoadStepSummary> steps = read_load_steps(directory);
  if (steps.size() > summary.load_steps.size()) summary.load_steps = std::move(steps);
  return summary;
}

}  // namespace karcher
