#pragma once
/// \file
/// PETSc and MPI, started and ended once. A program makes one PetscSession first and keeps it while anything of solve/ lives; where nobody has made one, the
/// first call that needs it starts a session that lasts until the program ends.
///
/// One rank computes with one thread: the BLAS is set to one thread unless the environment says otherwise (OPENBLAS_NUM_THREADS), so that one rank gives the
/// same bits run after run and ranks do not fight for cores. On several ranks MUMPS adds contributions in the order in which they arrive: results agree to rounding.

#include <petscsys.h>

#include <string>
#include <utility>

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

/// Rank of this process and number of ranks; start a session if there is none.
int world_rank();
int world_size();
/// Ends all ranks at once, for errors that only one of them has met. The message is the caller's business.
[[noreturn]] void end_all_ranks(int exit_code);

/// \throws Error with PETSc's own words if code is not 0.
void check_petsc(PetscErrorCode code);

/// Owner of a PETSc object: `PetscOwned<Mat, MatDestroy> a; check_petsc(MatCreate(comm, a.out()));`
template <class Object, PetscErrorCode (*destroy)(Object*)>
class PetscOwned {
 public:
  PetscOwned() = default;
  PetscOwned(PetscOwned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscOwned& operator=(PetscOwned&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~PetscOwned() {
    if (object_ && PetscInitializeCalled && !PetscFinalizeCalled) destroy(&object_);
  }
  operator Object() const { return object_; }
  Object* out() { return &object_; }

 private:
  Object object_ = nullptr;
};

}  // namespace karcher
