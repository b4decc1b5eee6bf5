#pragma once
/// \file
/// Fully symmetric quadrature rules on triangles and tetrahedra, stored by orbit.

#include <array>
#include <span>
#include <vector>

namespace karcher {

/// The points that arise from barycentric coordinates by all permutations; each has this weight (for a simplex of measure 1).
struct Orbit {
  double weight;
  std::array<double, 4> barycentric;  ///< the last entry of a triangle's is unused
};

struct SymmetricRule {
  int degree;
  std::vector<Orbit> orbits;
};

/// Rules with positive weights and interior points, by ascending degree.
std::span<const SymmetricRule> triangle_rules();
std::span<const SymmetricRule> tetrahedron_rules();

}  // namespace karcher
