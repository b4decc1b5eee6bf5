#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "karcher/error.hpp"
#include "karcher/io/vtu.hpp"

namespace karcher {
namespace {

using Place = std::array<int, 3>;  // reference coordinates times the order

/// Interior points of the edge from a to b (copies: the places grow meanwhile).
void append_edge(std::vector<Place>& places, Place a, Place b, int p) {
  for (int k = 1; k < p; ++k) {
    Place x{};
    for (std::size_t i = 0; i < 3; ++i) x[i] = a[i] + (b[i] - a[i]) / p * k;
    places.push_back(x);
  }
}

void append_edges(std::vector<Place>& places, const std::vector<std::array<int, 2>>& ends, int p) {
  for (const auto& [a, b] : ends) append_edge(places, places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)], p);
}

/// Interior points of the square spanned by u and v at a corner, u fastest.
void append_square(std::vector<Place>& places, const Place& corner, const Place& u, const Place& v, int p) {
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) {
      Place x = corner;
      for (std::size_t c = 0; c < 3; ++c) x[c] += i * u[c] + j * v[c];
      places.push_back(x);
    }
}

/// Points in the order of vtkLagrangeCurve, Triangle, Quadrilateral, Tetra and Hexahedron in files of version 1.0 (VTK 9.1 and later order the last two edges of a
/// hexahedron otherwise, and read files below version 2.1 in this order). Unlike ours, VTK's third and fourth edge of a square run in +xi and +eta direction; its
/// hexahedron numbers faces by their normals -x, +x, -y, +y, -z, +z.
std::vector<Place> vtk_places(CellKind kind, int p) {
  std::vector<Place> places;
  switch (kind) {
    case CellKind::vertex:
      return {{0, 0, 0}};
    case CellKind::line:
      places = {{0, 0, 0}, {p, 0, 0}};
      append_edges(places, {{0, 1}}, p);
      return places;
    case CellKind::triangle:
      places = {{0, 0, 0}, {p, 0, 0}, {0, p, 0}};
      append_edges(places, {{0, 1}, {1, 2}, {2, 0}}, p);
      if (p == 3) places.push_back({1, 1, 0});
      return places;
    case CellKind::quadrilateral:
      places = {{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}};
      append_edges(places, {{0, 1}, {1, 2}, {3, 2}, {0, 3}}, p);
      append_square(places, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, p);
      return places;
    case CellKind::tetrahedron:
      places = {{0, 0, 0}, {p, 0, 0}, {0, p, 0}, {0, 0, p}};
      append_edges(places, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}, p);
      if (p == 3) places.insert(places.end(), {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 1, 0}});
      return places;
    case CellKind::hexahedron:
      places = {{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}, {0, 0, p}, {p, 0, p}, {p, p, p}, {0, p, p}};
      append_edges(places, {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6}, {7, 6}, {4, 7}, {0, 4}, {1, 5}, {3, 7}, {2, 6}}, p);
      for (const int x : {0, p}) append_square(places, {x, 0, 0}, {0, 1, 0}, {0, 0, 1}, p);
      for (const int y : {0, p}) append_square(places, {0, y, 0}, {1, 0, 0}, {0, 0, 1}, p);
      for (const int z : {0, p}) append_square(places, {0, 0, z}, {1, 0, 0}, {0, 1, 0}, p);
      for (int k = 1; k < p; ++k) append_square(places, {0, 0, k}, {1, 0, 0}, {0, 1, 0}, p);
      return places;
  }
  return places;
}

std::vector<int> match(CellKind kind, int p) {
  const auto& ours = lagrange_nodes(kind, p);
  std::vector<int> order;
  for (const Place& place : vtk_places(kind, p)) {
    const auto found = std::find_if(ours.begin(), ours.end(), [&](const Vec3<double>& xi) {
      for (int i = 0; i < 3; ++i)
        if (std::lround(p * xi[i]) != place[static_cast<std::size_t>(i)]) return false;
      return true;
    });
    assert(found != ours.end());
    order.push_back(static_cast<int>(found - ours.begin()));
  }
  return order;
}

}  // namespace

int vtk_cell_type(CellKind kind) {
  static constexpr std::array<int, 6> types = {1, 68, 69, 70, 71, 72};
  return types[static_cast<std::size_t>(kind)];
}

const std::vector<int>& vtk_node_order(CellKind kind, int order) {
  if (order < 1 || order > 3) throw InputError("Cells for ParaView have order 1, 2 or 3, not " + std::to_string(order) + ".");
  static const auto table = [] {
    std::array<std::array<std::vector<int>, 3>, 6> all;
    for (std::size_t k = 0; k < all.size(); ++k)
      for (int p = 1; p <= 3; ++p) all[k][static_cast<std::size_t>(p - 1)] = match(static_cast<CellKind>(k), p);
    return all;
  }();
  return table[static_cast<std::size_t>(kind)][static_cast<std::size_t>(order - 1)];
}

}  // namespace karcher
