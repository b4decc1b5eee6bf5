#pragma once
/// \file
/// Errors on several ranks: told once, whichever rank meets them.

#include <functional>
#include <string>

#include "karcher/error.hpp"

namespace karcher::app {

/// Runs a verb that computes, with PETSc and MPI alive. Errors end here: one message on standard error, and the exit code of all ranks.
int on_ranks(const std::function<int()>& verb);

/// The sentence as the program prints it, and its exit code.
int tell_error(const std::exception& error);

}  // namespace karcher::app
