#pragma once
/// \file
/// PETSc and MPI, started and ended once. A program makes one PetscSession first and keeps it while anything of solve/ lives; where nobody has made one, the
/// first call that needs it starts a session that lasts until the program ends.
///
/// One rank computes with one thread: the BLAS is set to one thread unless the environment says otherwise (OPENBLAS_NUM_THREADS), so that one rank gives the
/// same bits run after run and ranks do not fight for cores. On several ranks MUMPS adds contributions in the order in which they arrive: results agree to rounding.

#include <string>

namespace karcher {

class PetscSession {
 public:
  /// \param options  for experts, as on a PETSc command line: "-log_view -mat_view". The program's own arguments, ~/.petscrc and signals are left alone;
  ///                 the environment variable PETSC_OPTIONS is read.
  /// Joins an MPI that runs already. Sessions may be nested; the outermost one counts.
  explicit PetscSession(const std::string& options = "");
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;

 private:
  bool initial_ = false;
};

/// Makes the BLAS take the memory that it works in, once and for all. OpenBLAS takes it at its first call, which is the first factorisation otherwise; where no
/// memory is left by then, it waits for ever. \throws Error if there is not enough, on this rank
void take_library_memory();

/// Rank of this process and number of ranks; start a session if there is none.
int world_rank();
int world_size();
/// Ends all ranks at once, for errors that only one of them has met. The message is the caller's business.
[[noreturn]] void end_all_ranks(int exit_code);

}  // namespace karcher
