#include "app/view.hpp"

#include <fmt/format.h>

#include "karcher/io/page.hpp"

namespace karcher::app {

int view(const ViewOptions& options) {
  write_page(options.directory);
  fmt::print("{}\n", (options.directory / "report.html").string());
  return 0;
}

}  // namespace karcher::app
