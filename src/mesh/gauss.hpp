#pragma once
/// \file
/// Gauss-Jacobi rules on [0, 1].

#include <vector>

namespace karcher {

struct GaussRule {
  std::vector<double> points, weights;
};

/// n points, exact for f of degree 2 n - 1 in the integral of (1 - x)^alpha f(x) over [0, 1]; alpha = 0: Gauss-Legendre. Points ascending.
GaussRule gauss_jacobi(int n, int alpha);

}  // namespace karcher
