#pragma once

namespace karcher::app {

/// The whole program: the command line, and every error told once, on standard error.
/// Exit codes: 0 solved, 1 not converged, 2 wrong input, 3 something else, 130 interrupted.
int program(int argc, char** argv);

}  // namespace karcher::app
