#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/vtu.hpp"

namespace karcher {
namespace {

/// Value of an attribute in a line that we wrote; empty where it is missing.
std::string_view attribute(std::string_view line, std::string_view key) {
  const std::string start = fmt::format(" {}=\"", key);
  const std::size_t begin = line.find(start);
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin + start.size());
  return line.substr(0, line.find('"'));
}

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

std::string_view next_line(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  return line;
}

}  // namespace

std::vector<VtuEntry> read_collection(const std::filesystem::path& file) {
  const std::string content = read_whole(file);
  std::string_view rest = content;
  std::vector<VtuEntry> entries;
  bool ended = false, good = true;
  while (!rest.empty()) {
    const std::string_view line = next_line(rest);
    ended = ended || line == "</VTKFile>";
    if (line.find("<DataSet") == std::string_view::npos) continue;
    VtuEntry e;
    e.region = attribute(line, "name");
    e.file = attribute(line, "file");
    good = good && parse(attribute(line, "timestep"), e.t) && parse(attribute(line, "part"), e.part) && parse(attribute(line, "state"), e.state) &&
           !e.file.empty();
    entries.push_back(std::move(e));
  }
  if (!good || !ended) throw InputError(fmt::format("The collection {} was not written by Karcher.", file.string()));
  std::stable_sort(entries.begin(), entries.end(),
                   [](const VtuEntry& a, const VtuEntry& b) { return std::pair(a.state, a.part) < std::pair(b.state, b.part); });
  return entries;
}

}  // namespace karcher
