#pragma once
/// \file
/// The verbs of the program. Each returns the exit code: 0 solved, 1 not converged, 130 interrupted; errors leave as exceptions (program.cpp).

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/problem_file.hpp"

namespace karcher::app {

struct RunOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool quiet = false;
  bool resume = false;
};
int run(const RunOptions& options);

struct EvaluateOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool json = false;
};
int evaluate(const EvaluateOptions& options);

struct CheckOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool derivatives = false, objectivity = false;
};
int check(const CheckOptions& options);

struct ConvergeOptions {
  std::filesystem::path file;
  ReadOptions read;
  int levels = 3;
  std::string start = "prolonged";  ///< or "initial"
  bool json = false;
  bool quiet = false;
};
int converge(const ConvergeOptions& options);

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
/// Makes the page of a results directory again, and a picture of it where one is asked for.
/// \throws InputError where the directory holds no results, a field, load step or setting is not in the page, sizes are out of range (64 to 8192), or there is no
///   Chromium (the message says what to install); Error where the browser fails or a file cannot be written.
int view(const ViewOptions& options);

int list(const std::string& what);
/// \param key  a page, or a word that is looked for in all of them  \param as_markdown the keys of a section as a table in Markdown, else text for a terminal
int doc(const std::string& key, bool as_markdown);
int version();
/// Copies an example. \param name of the new directory
int make_new(const std::string& name, const std::string& example);

/// Directory of the examples: KARCHER_EXAMPLES, else beside a program that was built, else installed. \throws Error if there is none
std::filesystem::path examples_directory();

}  // namespace karcher::app
