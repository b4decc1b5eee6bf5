#pragma once
/// \file
/// What VTK reads in our files: judge_vtu.py under the system's Python with python3-vtk9. Where that is missing the tests fail, they are not skipped.

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace karcher {

inline nlohmann::json judge(const std::vector<std::filesystem::path>& files, bool values = false) {
  std::string command = "/usr/bin/python3 " KARCHER_SOURCE_DIR "/tests/io/judge_vtu.py";
  if (values) command += " --values";
  for (const auto& f : files) command += " '" + f.string() + "'";
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start the judge");
  std::string text;
  char buffer[4096];
  std::size_t got = 0;
  while ((got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0) text.append(buffer, got);
  if (::pclose(pipe) != 0)
    throw std::runtime_error("The judge of VTU files refuses (it needs the Debian packages python3-vtk9 and python3-meshio): " + text);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
}

}  // namespace karcher
