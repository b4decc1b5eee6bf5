#pragma once
/// \file
/// Errors on several ranks: whichever rank meets one, all throw it.

#include <string>

#include "karcher/error.hpp"

namespace karcher {

/// An error that all ranks throw together.
struct SharedInputError : InputError {
  using InputError::InputError;
};
struct SharedError : Error {
  using Error::Error;
};
/// Collective: throws on all ranks the error of the lowest rank that has one ("I..." InputError, "E..." Error; empty: none).
void throw_everywhere(const std::string& error);

/// Runs work on all ranks; where one throws InputError or Error, all do. Collective, but work itself must not be, after the place where it may throw.
template <class Work>
void together(const Work& work) {
  std::string error;
  try {
    work();
  } catch (const InputError& e) {
    error = std::string("I") + e.what();
  } catch (const Error& e) {
    error = std::string("E") + e.what();
  }
  throw_everywhere(error);
}

}  // namespace karcher
