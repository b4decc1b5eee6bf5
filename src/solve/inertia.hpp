#pragma once

namespace karcher {

/// Signs of the eigenvalues of a symmetric matrix, on the free unknowns.
struct Inertia {
  int negative = 0;
  int null = 0;  ///< zero to rounding
};

}  // namespace karcher
