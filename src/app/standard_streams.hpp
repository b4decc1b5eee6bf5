#pragma once
/// \file
/// Standard output and error that may be full, closed, or a pipe whose reader has gone: printing never fails where it is done, and what could not be written is
/// told at the end.

#include <string>

namespace karcher::app {

/// To be called before anything is opened or printed. Descriptors 0 to 2 are taken, so that no file of ours becomes one of them; a pipe without reader is an
/// error of its writer, not its end (SIGPIPE); `stdout` and `stderr` take whatever is printed and remember the first failure.
void guard_standard_streams();

/// Flushes standard output. Returns what the system said when it could first not be written, or nothing.
std::string output_failure();

}  // namespace karcher::app
