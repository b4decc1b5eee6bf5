#pragma once
/// \file
/// Ctrl-C, or a terminal that is closed: the first ends the run after the current iteration, with results; the second ends the program at once.

namespace karcher::app {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP, and for SIGUSR1, by which the launcher of ranks passes them on.
void catch_interrupts();

}  // namespace karcher::app
