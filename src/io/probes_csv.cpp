#include "karcher/io/probes_csv.hpp"

#include <fmt/format.h>

namespace karcher {
namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string text;
  for (const char c : name) text.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", text);
}

std::string header(const LoadStepSummary& step) {
  std::string line = "load_step,t";
  for (const std::string& name : probe_columns(step.probes)) line += "," + name;
  return line + "\n";
}

std::string row(int load_step, const LoadStepSummary& step) {
  std::string line = fmt::format("{},{}", load_step, step.t);
  for (const auto& entry : step.probes)
    for (const double x : entry.second) line += fmt::format(",{}", x);
  return line + "\n";
}

}  // namespace

std::vector<std::string> probe_columns(const std::map<std::string, std::vector<double>>& probes) {
  std::vector<std::string> names;
  for (const auto& [name, values] : probes)
    for (std::size_t i = 0; i < values.size(); ++i) names.push_back(quoted(values.size() == 1 ? name : fmt::format("{}.{}", name, i)));
  return names;
}

ProbesCsv::ProbesCsv(std::filesystem::path file, const std::vector<LoadStepSummary>& finished) : file_(std::move(file)) {
  if (finished.empty() || finished.front().probes.empty()) return;
  std::string content = header(finished.front());
  for (std::size_t k = 0; k < finished.size(); ++k) content += row(static_cast<int>(k) + 1, finished[k]);
  rows_.emplace(file_, content);
}

void ProbesCsv::add(int load_step, const LoadStepSummary& step) {
  if (step.probes.empty()) return;
  if (rows_)
    rows_->append(row(load_step, step));
  else
    rows_.emplace(file_, header(step) + row(load_step, step));
}

}  // namespace karcher
