#pragma once
/// \file
/// What tests of the mesh loop over.

#include <array>
#include <random>
#include <vector>

#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

inline constexpr std::array<CellKind, 5> all_kinds = {CellKind::line, CellKind::triangle, CellKind::quadrilateral, CellKind::tetrahedron,
                                                      CellKind::hexahedron};

inline bool is_simplex(CellKind kind) { return kind == CellKind::triangle || kind == CellKind::tetrahedron; }

/// A random point of the reference cell.
inline Vec3<double> random_point(CellKind kind, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Vec3<double> x;
  double sum;
  do {
    sum = 0;
    for (int i = 0; i < dimension(kind); ++i) sum += x[i] = uniform(random);
  } while (is_simplex(kind) && sum > 1);
  return x;
}

/// x^a y^b z^c for all exponents that the polynomials of degree p on the cell have: total degree p on simplices, p in each direction otherwise.
inline std::vector<std::array<int, 3>> exponents(CellKind kind, int p) {
  std::vector<std::array<int, 3>> all;
  const int dim = dimension(kind);
  for (int a = 0; a <= p; ++a)
    for (int b = 0; b <= (dim > 1 ? p : 0); ++b)
      for (int c = 0; c <= (dim > 2 ? p : 0); ++c)
        if (!is_simplex(kind) || a + b + c <= p) all.push_back({a, b, c});
  return all;
}

}  // namespace karcher
