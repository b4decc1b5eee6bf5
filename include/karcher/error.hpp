#pragma once
/// \file
/// The two kinds of errors that reach a user.

#include <stdexcept>
#include <string>

namespace karcher {

/// Something a user typed is wrong. The message is a full sentence; file, line and column are added by the problem file where they are known.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The system refused something (disk full, a library failed).
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace karcher
