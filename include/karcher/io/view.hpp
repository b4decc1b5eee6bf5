#pragma once
/// \file
/// `karcher view DIR`: makes the page of a results directory again, and a picture of it where one is asked for.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace karcher {

struct ViewOptions {
  std::filesystem::path directory;  ///< of the results

  /// A picture in the PNG format, made by a local Chromium that draws the page. Empty: the page only.
  std::filesystem::path png;
  std::optional<std::array<double, 3>> view;  ///< direction from the shape to the eye; default: where most of the shape is seen
  std::string field;                          ///< what gives the colour ("energy", "displacement", "none", ...); empty: what the page starts with
  std::optional<int> step;                    ///< load step, 0: the initial configuration; default: the last one
  int width = 1600, height = 1000;            ///< of the picture, in pixels
  bool dark = false;
  /// More settings of the page by the names of viewer/src/view.ts, e.g. {"edges", "0"}, {"glyphs", "directors of Q"}, {"map", "cividis"}, {"up", "0,1,0"}.
  std::vector<std::pair<std::string, std::string>> settings;
};

/// Returns 0. \throws InputError where the directory holds no results, a field or load step is not in the page, sizes are out of range (64 to 8192), or
/// there is no Chromium (the message says what to install); Error where the browser fails or a file cannot be written.
int view(const ViewOptions& options);

}  // namespace karcher
