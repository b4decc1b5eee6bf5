#pragma once
/// \file
/// Several ranks from one command: `karcher run -n N` starts itself N times through mpiexec, also as root and in a container.

#include <optional>
#include <string>

namespace karcher::app {

/// The variable by which mpirun, mpiexec or srun tells this process that it is one of several; empty if none has started it.
std::string under_launcher();

/// Starts `ranks` copies of this program with the same arguments, waits for them, and returns their exit code. Ctrl-C, SIGTERM and SIGHUP reach the ranks as a
/// request to end after the current iteration; the second one kills them. Empty if this process is to do the work itself: one rank, or an existing launcher, which
/// it joins.
///
/// What ranks print and tell goes through pipes of this process, not through mpiexec: they leave nothing behind when it is killed, and what mpiexec itself says is
/// shown where it matters: when ranks do not start, or die.
/// \throws Error if there is no mpiexec, InputError if TMPDIR, which mpiexec needs, names no directory
std::optional<int> launch_ranks(int ranks, int argc, char** argv);

/// On a rank that launch_ranks started: takes its pipes as standard output and error. Before anything is printed.
void join_launcher();
/// Did launch_ranks start this process?
bool launched();

/// Words of a rank to the launcher that started it; without one they are lost.
void report_ready();
void report_results(const std::string& directory);
/// A rank's exit code; so mpiexec itself sees success.
int report_exit(int code);

/// Does standard output end at a terminal? (A rank's own output is a pipe of the launcher.)
bool on_terminal();

}  // namespace karcher::app
