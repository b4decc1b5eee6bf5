#pragma once
/// \file
/// Reference cells and their Lagrange bases of order 1 to 3.
///
/// Reference domains: line [0,1]; triangle {x, y >= 0, x + y <= 1}; quadrilateral [0,1]^2; tetrahedron; hexahedron [0,1]^3. Vertex order is that of
/// VTK and Gmsh (quadrilateral counter-clockwise, hexahedron bottom then top). Nodes of order p are equispaced; their order is: vertices; interior
/// nodes of edge 0 from its first to its second vertex, edge 1, ...; interior nodes of face 0, ...; interior nodes of the cell. Several interior
/// nodes of a face or cell are numbered with their first coordinate running fastest, in the face's own reference coordinates (its first vertex the
/// origin, x towards its second).
///
/// Edges: triangle 01 12 20; quadrilateral 01 12 23 30; tetrahedron 01 12 20 03 13 23; hexahedron 01 12 23 30, 45 56 67 74, 04 15 26 37.
/// Faces, counter-clockwise seen from outside: tetrahedron 021 013 032 123; hexahedron 0321 4567 0154 2376 0473 1265.

#include <array>
#include <string_view>
#include <vector>

#include "karcher/math/tensor.hpp"

namespace karcher {

enum class CellKind { vertex, line, triangle, quadrilateral, tetrahedron, hexahedron };

std::string_view name(CellKind kind);
int dimension(CellKind kind);
int vertex_count(CellKind kind);
int node_count(CellKind kind, int order);
double reference_measure(CellKind kind);

/// Local vertex numbers of every sub-entity of dimension 1 (edges; of a line: itself) and 2 (faces; of a 2D cell: none, it is not listed itself).
const std::vector<std::array<int, 2>>& edges(CellKind kind);
struct ReferenceFace {
  CellKind kind;
  std::vector<int> vertices;
};
const std::vector<ReferenceFace>& faces(CellKind kind);
/// Facets (dimension one lower): faces of a 3D cell, edges of a 2D cell (as lines), ends of a line (as vertices).
const std::vector<ReferenceFace>& facets(CellKind kind);

/// Reference coordinates of the Lagrange nodes, in the order of the file comment (unused coordinates 0).
const std::vector<Vec3<double>>& lagrange_nodes(CellKind kind, int order);
/// Local node numbers (of the order-p cell) that lie on facet f, in the node order of the facet's own kind with vertices as in facets(kind)[f].
const std::vector<int>& facet_nodes(CellKind kind, int order, int f);

/// Values, first and second derivatives of the Lagrange basis at a reference point.
struct Shape {
  std::vector<double> value;                    ///< [node]
  std::vector<std::array<double, 3>> gradient;  ///< [node][direction], directions beyond the dimension are 0
  std::vector<std::array<double, 6>> hessian;   ///< [node][xx, xy, xz, yy, yz, zz]
};
/// \throws InputError unless 1 <= order <= 3 (as do lagrange_nodes and facet_nodes).
Shape lagrange(CellKind kind, int order, const Vec3<double>& xi);

}  // namespace karcher
