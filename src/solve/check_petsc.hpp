#pragma once

#include <petscsys.h>

namespace karcher {

/// \throws Error with PETSc's own words if code is not 0.
void check_petsc(PetscErrorCode code);

}  // namespace karcher
