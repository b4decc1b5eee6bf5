#pragma once
/// \file
/// Uniform refinement: every line into 2 cells, triangle and quadrilateral into 4, tetrahedron and hexahedron into 8.

#include <map>
#include <string>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Where a cell of the refined mesh comes from.
struct Child {
  int parent = 0;                                      ///< cell of the same region of the coarse mesh
  const std::vector<Vec3<double>>* corners = nullptr;  ///< its vertices in the parent's reference coordinates (lives as long as the program)
};

struct Refinement {
  Mesh mesh;
  /// For every region, one entry per refined cell; "all" is for mesh.cells.
  std::map<std::string, std::vector<Child>> children;
};

/// The mesh with all its regions, one level finer, of the same geometry order. New nodes lie on the parametrisation if there is one, else on the
/// geometry of the coarse cell; the shape does not change then. Tetrahedra: the inner octahedron is cut along its shortest diagonal, which keeps
/// angles bounded (Zhang 1995).
Refinement refine(const Mesh& mesh);

/// Reference coordinates in the parent of the point xi of a child of the given kind.
Vec3<double> in_parent(const Child& child, CellKind kind, const Vec3<double>& xi);

}  // namespace karcher
