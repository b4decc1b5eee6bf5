#pragma once
/// \file
/// Several ranks from one command: `karcher run -n N` starts itself N times through mpiexec, also as root and in a container.

#include <optional>

namespace karcher::app {

/// Is this process one of several that mpirun, mpiexec or srun started?
bool under_launcher();

/// Starts `ranks` copies of this program with the same arguments, waits for them, and returns their exit code. Ctrl-C and SIGTERM reach the ranks as a request
/// to end after the current iteration; the second one kills them. Empty if this process is to do the work itself: one rank, or an existing launcher, which it
/// joins.
/// \throws Error if there is no mpiexec
std::optional<int> launch_ranks(int ranks, int argc, char** argv);

/// A rank's exit code, told to the launcher that started it, so that mpiexec itself sees success and keeps silent.
int report_exit(int code);

/// Does standard output end at a terminal? (A rank's own output is a pipe of mpiexec.)
bool on_terminal();

}  // namespace karcher::app
