#pragma once
/// \file
/// Places in a problem file, as messages name them.

#include <algorithm>
#include <string>
#include <string_view>

#include "karcher/error.hpp"

namespace karcher {

/// "problem.toml:12:3" (line and column from 1), or "--set solver.x=3" for what came from the command line.
struct Place {
  std::string file;
  int line = 0, column = 0;

  std::string text() const {
    if (file.empty()) return {};
    return line > 0 ? file + ":" + std::to_string(line) + ":" + std::to_string(column) : file;
  }
  /// The place `columns` to the right.
  Place shifted(int columns) const { return {file, line, column + columns}; }
  /// The place behind a text that begins here.
  Place after(std::string_view text) const {
    const std::size_t end = text.rfind('\n');
    if (end == text.npos || line == 0) return shifted(static_cast<int>(text.size()));
    return {file, line + static_cast<int>(std::count(text.begin(), text.end(), '\n')), static_cast<int>(text.size() - end)};
  }
};

[[noreturn]] inline void refuse(const Place& place, const std::string& sentence) {
  throw InputError(place.file.empty() ? sentence : place.text() + ": " + sentence);
}

/// Runs `work`; the place is put before the message of an InputError that leaves it.
template <class Work>
decltype(auto) at_place(const Place& place, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(place.file)) throw;
    refuse(place, what);
  }
}

}  // namespace karcher
