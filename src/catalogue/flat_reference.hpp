#pragma once
/// \file
/// Energies of the plane ask for a stress-free configuration in it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "karcher/assembly/term_input.hpp"
#include "karcher/error.hpp"
#include "karcher/mesh/reference_cell.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher::catalogue {

/// \param energy, otherwise  the sentence's subject and its end: what takes other configurations
/// \throws InputError for a reference off the plane z = 0
inline void require_flat(const TermInput& input, const std::string& energy, const std::string& otherwise) {
  constexpr double rounding = 1e-9;  // |z| <= rounding * largest |x|
  const ReferenceGeometry reference(*input.mesh, input.reference_position, input.reference_order);
  double size = 0;
  Vec3<double> farthest;
  for (const Cell& cell : input.region.cells)
    for (const GeometryJet& jet : reference.at(cell, lagrange_nodes(cell.kind, 3))) {
      size = std::max(size, std::sqrt(norm2(jet.x)));
      if (std::fabs(jet.x[2]) > std::fabs(farthest[2])) farthest = jet.x;
    }
  if (std::fabs(farthest[2]) > rounding * size)
    throw InputError(fmt::format("{}: the stress-free configuration must lie in the plane z = 0, but has the point ({:.6g}, {:.6g}, {:.6g}); {}.",
                                 energy, farthest[0], farthest[1], farthest[2], otherwise));
}

}  // namespace karcher::catalogue
