#include "mesh/gmsh_cells.hpp"

#include <algorithm>
#include <map>

#include "mesh/lattice.hpp"

namespace karcher {
namespace {

using Points = std::vector<LatticePoint>;
using Face = std::vector<int>;

/// Gmsh's own edges and faces ("Node ordering" in its manual); the direction matters for the nodes inside.
std::vector<std::array<int, 2>> gmsh_edges(CellKind kind) {
  switch (kind) {
    case CellKind::vertex:
      return {};
    case CellKind::line:
      return {{0, 1}};
    case CellKind::triangle:
      return {{0, 1}, {1, 2}, {2, 0}};
    case CellKind::quadrilateral:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case CellKind::tetrahedron:
      return {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};
    case CellKind::hexahedron:
      break;
  }
  return {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
}

std::vector<Face> gmsh_faces(CellKind kind) {
  if (kind == CellKind::tetrahedron) return {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}};
  if (kind == CellKind::hexahedron) return {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}};
  return {};
}

/// What remains inside a cell of order p is a cell of the same kind of order p - inset (Gmsh numbers it the same way again).
int inset(CellKind kind) {
  switch (kind) {
    case CellKind::triangle:
      return 3;
    case CellKind::tetrahedron:
      return 4;
    default:
      return 2;
  }
}

Points gmsh_lattice(CellKind kind, int p);

/// Lattice of the interior, in the coordinates of the whole.
Points gmsh_interior(CellKind kind, int p) {
  if (p < inset(kind)) return {};
  Points points = gmsh_lattice(kind, p - inset(kind));
  for (LatticePoint& point : points)
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension(kind)); ++i) ++point[i];
  return points;
}

Points gmsh_lattice(CellKind kind, int p) {
  if (kind == CellKind::vertex || p == 0) return {{0, 0, 0}};
  Points points;
  const auto& corner = corners(kind);
  const auto at = [&](int v) { return corner[static_cast<std::size_t>(v)]; };
  for (const LatticePoint& c : corner) points.push_back({p * c[0], p * c[1], p * c[2]});
  for (const auto& [a, b] : gmsh_edges(kind))
    for (int k = 1; k < p; ++k) {
      LatticePoint& point = points.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) point[i] = (p - k) * at(a)[i] + k * at(b)[i];
    }
  for (const Face& f : gmsh_faces(kind))
    for (const LatticePoint& on_face : gmsh_interior(f.size() == 3 ? CellKind::triangle : CellKind::quadrilateral, p)) {
      LatticePoint& point = points.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        point[i] = p * at(f[0])[i] + on_face[0] * (at(f[1])[i] - at(f[0])[i]) + on_face[1] * (at(f.back())[i] - at(f[0])[i]);
    }
  if (kind != CellKind::line)
    for (const LatticePoint& point : gmsh_interior(kind, p)) points.push_back(point);
  return points;
}

GmshCell make(CellKind kind, int order) {
  GmshCell cell{kind, order, {}};
  const Points theirs = gmsh_lattice(kind, order);
  for (const LatticePoint& ours : lattice(kind, order))
    cell.permutation.push_back(static_cast<int>(std::find(theirs.begin(), theirs.end(), ours) - theirs.begin()));
  return cell;
}

}  // namespace

const GmshCell* gmsh_cell(int type) {
  using enum CellKind;
  static const std::map<int, GmshCell> known = {
      {15, make(vertex, 1)},        {1, make(line, 1)},           {8, make(line, 2)},        {26, make(line, 3)},
      {2, make(triangle, 1)},       {9, make(triangle, 2)},       {21, make(triangle, 3)},   {3, make(quadrilateral, 1)},
      {10, make(quadrilateral, 2)}, {36, make(quadrilateral, 3)}, {4, make(tetrahedron, 1)}, {11, make(tetrahedron, 2)},
      {29, make(tetrahedron, 3)},   {5, make(hexahedron, 1)},     {12, make(hexahedron, 2)}, {92, make(hexahedron, 3)},
  };
  const auto it = known.find(type);
  return it == known.end() ? nullptr : &it->second;
}

std::string gmsh_unread(int type) {
  static const std::map<int, const char*> known = {
      {6, "a prism"},
      {7, "a pyramid"},
      {13, "a prism of order 2"},
      {14, "a pyramid of order 2"},
      {16, "a quadrilateral of 8 nodes (serendipity; set Mesh.SecondOrderIncomplete = 0)"},
      {17, "a hexahedron of 20 nodes (serendipity; set Mesh.SecondOrderIncomplete = 0)"},
      {18, "a prism of 15 nodes"},
      {19, "a pyramid of 13 nodes"},
      {20, "a triangle of 9 nodes (incomplete order 3; set Mesh.SecondOrderIncomplete = 0)"},
      {22, "a triangle of 12 nodes (incomplete order 4)"},
      {23, "a triangle of order 4"},
      {24, "a triangle of 15 nodes (incomplete order 5)"},
      {25, "a triangle of order 5"},
      {27, "a line of order 4"},
      {28, "a line of order 5"},
      {30, "a tetrahedron of order 4"},
      {31, "a tetrahedron of order 5"},
      {37, "a quadrilateral of order 4"},
      {39, "a quadrilateral of 12 nodes (serendipity; set Mesh.SecondOrderIncomplete = 0)"},
      {93, "a hexahedron of order 4"},
      {99, "a hexahedron of 32 nodes (serendipity; set Mesh.SecondOrderIncomplete = 0)"},
  };
  const auto it = known.find(type);
  return "type " + std::to_string(type) + (it == known.end() ? std::string() : std::string(", ") + it->second);
}

}  // namespace karcher
