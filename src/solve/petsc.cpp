#include "karcher/solve/petsc.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <petscsys.h>
#include <sys/mman.h>

#include <cstdlib>

#include "karcher/error.hpp"
#include "karcher/memory.hpp"
#include "solve/check_petsc.hpp"

extern "C" void dsymv_(const char* triangle, const int* n, const double* alpha, const double* a, const int* lda, const double* x, const int* dx,
                       const double* beta, double* y, const int* dy, std::size_t);

namespace karcher {
namespace {

std::string last_message;
bool session_running = false;

/// Keeps the first message of an error's way up and prints nothing.
PetscErrorCode keep_message(MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) last_message = message ? message : "";
  return code;
}

/// The BLAS is chosen by the system (Debian's alternatives), so its own switch is looked up at run time.
void use_one_blas_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS")) return;
  if (void* symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<void (*)(int)>(symbol)(1);
}

void ensure_session() {
  if (!session_running) static PetscSession until_the_end;
}

}  // namespace

PetscSession::PetscSession(const std::string& options) {
  if (session_running) return;
  // PETSc reads what it takes for the command line: give it one of our own.
  char name[] = "karcher", no_file[] = "-skip_petscrc", no_signals[] = "-no_signal_handler";
  char* words[] = {name, no_file, no_signals, nullptr};
  int count = 3;
  char** arguments = words;
  // One process needs no daemon beside it, which Open MPI would start, and could not without a PATH.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  // Nor does it need a directory under /tmp: of two processes, the one that ends can remove the parent of the one that the other is making, which then ends with exit code 1.
  if (!std::getenv("OMPI_COMM_WORLD_SIZE") && !std::getenv("PMIX_RANK")) setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  if (PetscInitialize(&count, &arguments, nullptr, nullptr)) throw Error("PETSc did not start.");
  session_running = true;
  check_petsc(PetscPushErrorHandler(keep_message, nullptr));
  if (!options.empty()) check_petsc(PetscOptionsInsertString(nullptr, options.c_str()));
  use_one_blas_thread();
  initial_ = true;
}

PetscSession::~PetscSession() {
  if (!initial_) return;
  PetscPopErrorHandler();
  PetscFinalize();
  session_running = false;
}

void take_library_memory() {
  if (!dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) return;
  // It asks for its buffer again and again until there is memory: so whether there is, with something left for the rest, is asked first.
  constexpr std::size_t buffer = 128 << 20, rest = 16 << 20;
  void* room = mmap(nullptr, buffer + rest, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED)
    throw Error(fmt::format("The memory is used up before the work begins: the BLAS takes {} for itself; this process may have {}.",
                            bytes_text(static_cast<double>(buffer)), bytes_text(memory_limit())));
  munmap(room, buffer + rest);
  const int n = 1;  // small or not, this one asks for the buffer
  const double one = 1;
  double y = 0;
  dsymv_("U", &n, &one, &one, &n, &one, &n, &one, &y, &n, 1);
}

int world_rank() {
  ensure_session();
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

int world_size() {
  ensure_session();
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

void end_all_ranks(int exit_code) {
  MPI_Abort(PETSC_COMM_WORLD, exit_code);
  std::abort();  // unreachable: MPI_Abort does not return
}

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw Error(std::string("PETSc: ") + (text ? text : "unknown error") + (last_message.empty() ? "" : ": " + last_message));
}

}  // namespace karcher
