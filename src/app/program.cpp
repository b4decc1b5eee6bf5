#include "app/program.hpp"

#include <exception>

#include "app/command_line.hpp"
#include "app/launch.hpp"
#include "app/ranks.hpp"
#include "app/standard_streams.hpp"
#include "karcher/problem/results.hpp"

namespace karcher::app {

int program(int argc, char** argv) {
  seconds_now();
  join_launcher();
  guard_standard_streams();
  try {
    return report_exit(command_line(argc, argv));
  } catch (const std::exception& error) {
    return report_exit(tell_error(error));
  }
}

}  // namespace karcher::app
