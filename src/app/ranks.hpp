#pragma once
/// \file
/// Errors on several ranks: told once, whichever rank meets them.

#include <functional>
#include <string>

#include "karcher/error.hpp"

namespace karcher::app {

/// OpenBLAS starts its threads when it is loaded, each with a buffer of 128 MB for which it waits as long as there is no memory: so where the environment does not
/// say otherwise (OPENBLAS_NUM_THREADS), the program starts anew with one. Returns in the process that has it.
void use_one_blas_thread(char** argv);

/// Runs a verb that computes, with PETSc and MPI alive. Errors end here: one message on standard error, and the exit code of all ranks.
/// \param asked_for  number of ranks that the user asked for; where a launcher has started others, that is told. 0: none in particular
int on_ranks(int asked_for, const std::function<int()>& verb);

/// The sentence as the program prints it, and its exit code.
int tell_error(const std::exception& error);

}  // namespace karcher::app
