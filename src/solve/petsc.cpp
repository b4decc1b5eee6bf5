#include "karcher/solve/petsc.hpp"

#include <dlfcn.h>
#include <petscsys.h>

#include <cstdlib>

#include "karcher/error.hpp"
#include "solve/check_petsc.hpp"

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
