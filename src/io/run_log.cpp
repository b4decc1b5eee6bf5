#include "karcher/io/run_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "karcher/error.hpp"
#include "karcher/version.hpp"

namespace karcher {
namespace {

std::FILE* opened(const std::filesystem::path& file, bool resumed) {
  std::FILE* f = std::fopen(file.c_str(), resumed ? "ae" : "we");
  if (!f) throw Error(fmt::format("The file {} cannot be written: {}.", file.string(), std::strerror(errno)));
  return f;
}

}  // namespace

RunLog::RunLog(const std::filesystem::path& file, int steps, bool resumed)
    : file_(opened(file, resumed), std::fclose), table_(file_.get(), steps, false) {
  table_.line(fmt::format("{}karcher {}, {:%Y-%m-%d %H:%M:%S}", resumed ? "\n" : "", version_string, fmt::localtime(std::time(nullptr))));
}

}  // namespace karcher
