#pragma once

namespace karcher::app {

/// Reads the command line, does what it says, and returns the exit code.
int command_line(int argc, char** argv);

}  // namespace karcher::app
