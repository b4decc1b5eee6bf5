#include "app/ranks.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "app/launch.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {
namespace {

int exit_code(const std::exception& error) { return dynamic_cast<const InputError*>(&error) ? 2 : 3; }

}  // namespace

int tell_error(const std::exception& error) {
  const bool known = dynamic_cast<const InputError*>(&error) || dynamic_cast<const Error*>(&error);
  fmt::print(stderr, "{}: {}\n", known ? "error" : "internal error", error.what());
  std::fflush(stderr);
  return exit_code(error);
}

int on_ranks(const std::function<int()>& verb) {
  const PetscSession session;
  try {
    return verb();
  } catch (const std::exception& error) {
    const bool shared = dynamic_cast<const SharedInputError*>(&error) || dynamic_cast<const SharedError*>(&error);
    if (world_size() == 1) return tell_error(error);
    if (shared) return world_rank() == 0 ? tell_error(error) : exit_code(error);
    // One rank, or several at the same time: the lowest is quicker to speak, and ends the others.
    std::this_thread::sleep_for(std::chrono::milliseconds(100 * world_rank()));
    const int code = tell_error(error);
    report_exit(code);
    end_all_ranks(code);
  }
}

}  // namespace karcher::app
