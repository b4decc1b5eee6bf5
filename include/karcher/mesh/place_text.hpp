#pragma once
/// \file
/// How sentences tell parts of a mesh.

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "karcher/math/tensor.hpp"

namespace karcher {

/// "1 cell", "2 cells".
inline std::string cells_text(int n) { return fmt::format("{} cell{}", n, n == 1 ? "" : "s"); }

/// "(0.5, 1, 0)". \param size  of the body: coordinates below 1e-9 of it are zero
inline std::string place_text(Vec3<double> x, double size) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(x[i]) < 1e-9 * size) x[i] = 0;
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]);
}

}  // namespace karcher
