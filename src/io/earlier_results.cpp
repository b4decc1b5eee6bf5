#include "karcher/io/earlier_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "karcher/error.hpp"
#include "karcher/io/load_steps_file.hpp"
#include "karcher/io/vtu.hpp"

namespace karcher {
namespace {

/// ".NAME.PID.part"
bool is_unfinished(const std::string& name) {
  constexpr std::string_view end = ".part";
  if (!name.starts_with('.') || !name.ends_with(end)) return false;
  const std::size_t stop = name.size() - end.size(), dot = name.rfind('.', stop - 1);
  return dot != std::string::npos && dot > 0 && dot + 1 < stop &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.begin() + static_cast<std::ptrdiff_t>(stop),
                     [](unsigned char c) { return std::isdigit(c); });
}

std::string sentence(const std::filesystem::path& directory) {
  if (!std::filesystem::exists(directory / "summary.json"))
    return std::filesystem::exists(directory / "checkpoint.bin") ? "replaces the results of a run that made no load step" : "";
  try {
    const Summary s = read_results(directory);
    return fmt::format("replaces the results of an earlier run (\"{}\": {}, {} load step{})", s.title, name(s.status), s.load_steps.size(),
                       s.load_steps.size() == 1 ? "" : "s");
  } catch (const InputError&) {
    return "replaces the results of an earlier run";
  }
}

}  // namespace

void remove_unfinished_files(const std::filesystem::path& directory) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory, ignored))
    if (is_unfinished(entry.path().filename().string())) std::filesystem::remove(entry.path(), ignored);
}

std::string remove_earlier_results(const std::filesystem::path& directory) {
  const std::string what = sentence(directory);
  std::error_code ignored;
  const std::filesystem::path collection = directory / "solution.pvd";
  // The checkpoint first: without it, nothing that is left is resumed.
  std::filesystem::remove(directory / "checkpoint.bin", ignored);
  if (std::filesystem::exists(collection)) {
    try {
      for (const VtuEntry& entry : read_collection(collection)) remove_state(directory, entry);
      std::filesystem::remove(collection, ignored);
    } catch (const InputError&) {
      // Another program's collection names files that are not ours.
    }
  }
  for (const char* file : {"summary.json", "load_steps.jsonl", "probes.csv", "report.html", "report.data"})
    std::filesystem::remove(directory / file, ignored);
  remove_unfinished_files(directory);
  return what;
}

}  // namespace karcher
