#pragma once
/// \file
/// Small dense problems: eigenvalues by LAPACK, and the trust region in a ball.

#include <span>
#include <vector>

namespace karcher {

/// Eigenvalues in ascending order and eigenvectors (columns, column-major) of a symmetric n x n matrix. \throws Error if LAPACK fails.
struct Spectrum {
  std::vector<double> values, vectors;
};
Spectrum symmetric_eigen(int n, std::vector<double> matrix);

struct DenseStep {
  std::vector<double> y;
  double multiplier = 0;  ///< lambda >= 0 with (B + lambda I) y = -b, B + lambda I positive semidefinite, lambda (|y| - radius) = 0
  double decrease = 0;    ///< -(b.y + 1/2 y.B y) >= 0
};

/// Global minimiser of b.y + 1/2 y.B y over |y| <= radius, B given by its eigenvalues and -vectors (More, Sorensen 1983; exact, with the hard case).
DenseStep minimise_in_ball(const Spectrum& eigen, std::span<const double> b, double radius);

}  // namespace karcher
