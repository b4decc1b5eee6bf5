#pragma once
/// \file
/// Mesh: geometry nodes in R^3, cells of any kind and order (mixed), and named regions. No manifold structure is assumed: surfaces may be
/// non-orientable, an edge may belong to any number of cells.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "karcher/mesh/reference_cell.hpp"

namespace karcher {

/// One cell, or an entity of a region (a facet of a cell is a cell of its own, with the geometry nodes of the trace).
struct Cell {
  CellKind kind = CellKind::vertex;
  int order = 1;           ///< geometry order 1..3
  std::vector<int> nodes;  ///< into Mesh::nodes, in the order of reference_cell.hpp; the first vertex_count(kind) are the vertices
  /// Parameters of the vertices, for meshes with Mesh::parametrisation (empty otherwise). Per cell, since a periodic parametrisation is multi-valued.
  std::vector<Vec3<double>> parameters;
};

/// A named set of entities of one dimension.
struct Region {
  std::string name;
  int dim = 0;
  std::vector<Cell> cells;
};

struct Mesh {
  int dim = 0;  ///< highest dimension of a cell
  std::vector<Vec3<double>> nodes;
  std::vector<Cell> cells;                ///< the cells of dimension `dim`
  std::map<std::string, Region> regions;  ///< physical groups and predicate regions; "all" is always there and equals `cells`
  /// Exact geometry of generated meshes: maps parameters to R^3, so that refinement lands on the exact surface. Empty for read meshes.
  std::function<Vec3<double>(const Vec3<double>&)> parametrisation;
  /// Periodic meshes: of every node the first of its copies (itself where it has none), which are one node for fields; the geometry of each copy stays its own.
  /// Empty: none has copies. See periodic.hpp.
  std::vector<int> first_copies;
  /// Groups of a file that are no regions of this mesh, each with the reason.
  std::map<std::string, std::string> left_out;
  std::vector<std::string> warnings;  ///< sentences about what a file has and the mesh has not

  /// Highest geometry order of a cell.
  int order() const;
  /// \throws InputError naming the known regions and the nearest name, or the reason why it was left out.
  const Region& region(const std::string& name) const;
};

/// Mean of a cell's vertices.
Vec3<double> middle(const Mesh& mesh, const Cell& cell);

/// Length of the diagonal of the box around all nodes.
double diagonal(const Mesh& mesh);

/// Facet f of a cell (facets() of reference_cell.hpp), as an entity of its own.
Cell facet(const Cell& cell, int f);
/// All facets of the mesh's cells that belong to exactly one cell.
std::vector<Cell> boundary_facets(const Mesh& mesh);
/// All distinct entities of dimension `dim` (0 vertices .. mesh.dim cells), optionally only those on the boundary.
std::vector<Cell> entities(const Mesh& mesh, int dim, bool boundary_only);
/// Region of all entities of dimension dim whose every geometry node satisfies the predicate. \throws InputError if empty.
Region select(const Mesh& mesh, const std::string& name, int dim, bool boundary_only, const std::function<bool(const Vec3<double>&)>& predicate);

/// Region of the vertex of the mesh that is nearest to a point. \throws InputError where two are equally near to 1e-9 of the mesh's size, or where the point is farther away
/// than the cells around the vertex are large, which makes it a mistake.
Region nearest_node(const Mesh& mesh, const std::string& name, bool boundary_only, const Vec3<double>& point);

/// Makes sure that entities can be told apart by their vertices, which everything built on a mesh relies on. \throws InputError if a cell has a
/// vertex twice, if two cells have the same vertices, or if two different edges join the same two vertices (a periodic mesh needs three cells
/// around).
void check_identity(const Mesh& mesh);

/// Position, tangents dx/dxi_a and second derivatives of the cell's own Lagrange geometry at a reference point.
struct GeometryJet {
  Vec3<double> x;
  std::array<Vec3<double>, 3> d{};
  std::array<Vec3<double>, 6> dd{};  ///< xx, xy, xz, yy, yz, zz
};
GeometryJet geometry(const Mesh& mesh, const Cell& cell, const Vec3<double>& xi);

}  // namespace karcher
