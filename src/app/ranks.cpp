#include "app/ranks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>

#include "app/launch.hpp"
#include "karcher/memory.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

int exit_code(const std::exception& error) { return dynamic_cast<const InputError*>(&error) ? 2 : 3; }

/// A container that asks for more than there is says so in words of its own.
bool is_out_of_memory(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error);
}

/// What there is to tell before MPI can be asked to pass it on: one process tells it itself.
std::string trouble_before_mpi() {
  try {
    take_library_memory();
    return "";
  } catch (const Error& error) {
    if (under_launcher().empty()) throw;
    return error.what();
  }
}

}  // namespace

int tell_error(const std::exception& error) {
  const bool known = dynamic_cast<const InputError*>(&error) || dynamic_cast<const Error*>(&error);
  if (is_out_of_memory(error))
    fmt::print(stderr, "error: the memory is used up; this process may have {}. A coarser mesh or lower orders need less.\n",
               bytes_text(memory_limit()));
  else
    fmt::print(stderr, "{}: {}\n", known ? "error" : "internal error", printable(error.what()));
  std::fflush(stderr);
  return exit_code(error);
}

void use_one_blas_thread(char** argv) {
  if (std::getenv("OPENBLAS_NUM_THREADS") || setenv("OPENBLAS_NUM_THREADS", "1", 0) != 0) return;
  execv("/proc/self/exe", argv);
}

int on_ranks(int asked_for, const std::function<int()>& verb) {
  const std::string trouble = trouble_before_mpi();
  const PetscSession session;
  report_ready();
  try {
    together([&] {
      if (!trouble.empty()) throw Error(trouble);
    });
    if (asked_for > 0 && asked_for != world_size() && world_rank() == 0)
      fmt::print(stderr, "warning: -n {} is ignored: by {} in its environment, this process belongs to a launcher, which has started {} rank{}.\n",
                 asked_for, under_launcher(), world_size(), world_size() == 1 ? "" : "s");
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
