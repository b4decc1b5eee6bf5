#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace karcher::app {

struct ViewOptions {
  std::filesystem::path directory;
};

/// Makes report.html of a directory of results anew.
int view(const ViewOptions& options);

}  // namespace karcher::app
