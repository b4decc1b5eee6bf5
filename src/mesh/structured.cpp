#include "mesh/structured.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "karcher/error.hpp"
#include "mesh/elevate.hpp"
#include "mesh/lattice.hpp"

namespace karcher {
namespace {

using Parameters = std::vector<Vec3<double>>;

Cell cell_of(CellKind kind, std::vector<int> nodes, Parameters parameters) { return {kind, 1, std::move(nodes), std::move(parameters)}; }

/// The quadrilateral, or its two triangles at the diagonal from vertex 0 to vertex 2.
void add_quadrilateral(std::vector<Cell>& cells, bool triangles, const std::array<int, 4>& v, const std::array<Vec3<double>, 4>& p) {
  if (!triangles) {
    cells.push_back(cell_of(CellKind::quadrilateral, {v.begin(), v.end()}, {p.begin(), p.end()}));
    return;
  }
  cells.push_back(cell_of(CellKind::triangle, {v[0], v[1], v[2]}, {p[0], p[1], p[2]}));
  cells.push_back(cell_of(CellKind::triangle, {v[0], v[2], v[3]}, {p[0], p[2], p[3]}));
}

}  // namespace

std::vector<Cell> surface_cells(const SurfaceGrid& grid) {
  const auto [n1, n2] = grid.cells;
  for (std::size_t d = 0; d < 2; ++d)
    if (grid.closed[d] && grid.cells[d] < 3)
      throw InputError("A mesh that closes on itself needs at least three cells around, not " + std::to_string(grid.cells[d]) + ".");
  const int columns = n1 + (grid.closed[0] ? 0 : 1), rows = n2 + (grid.closed[1] ? 0 : 1);
  const auto vertex = [&](int i, int j) {
    if (i == columns) {
      i = 0;
      if (grid.flipped) j = n2 - j;
    }
    return i + columns * (j % rows);
  };
  const auto parameter = [&](int i, int j) {
    const auto along = [&](std::size_t d, int k) {
      const double s = static_cast<double>(k) / grid.cells[d];
      return k == grid.cells[d] ? grid.upper[d] : grid.lower[d] + s * (grid.upper[d] - grid.lower[d]);
    };
    return Vec3<double>{{along(0, i), along(1, j), 0.0}};
  };
  std::vector<Cell> cells;
  cells.reserve(static_cast<std::size_t>(n1) * static_cast<std::size_t>(n2) * (grid.triangles ? 2 : 1));
  for (int j = 0; j < n2; ++j)
    for (int i = 0; i < n1; ++i)
      add_quadrilateral(cells, grid.triangles, {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)},
                        {parameter(i, j), parameter(i + 1, j), parameter(i + 1, j + 1), parameter(i, j + 1)});
  return cells;
}

std::vector<Cell> solid_cells(const std::array<int, 3>& n, bool tetrahedra) {
  std::vector<std::array<int, 4>> kuhn;  // corners of the cube along the axes in the order of a permutation
  if (tetrahedra) {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    const auto& corner = corners(CellKind::hexahedron);
    do {
      std::array<int, 4> path{};
      LatticePoint at{0, 0, 0};
      for (std::size_t step = 0; step < 3; ++step) {
        at[axes[step]] = 1;
        path[step + 1] = static_cast<int>(std::find(corner.begin(), corner.end(), at) - corner.begin());
      }
      const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
      if (!even) std::swap(path[1], path[2]);
      kuhn.push_back(path);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  std::vector<Cell> cells;
  cells.reserve(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]) * (tetrahedra ? 6 : 1));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        std::vector<int> v;
        Parameters p;
        for (const LatticePoint& c : corners(CellKind::hexahedron)) {
          const int x = i + c[0], y = j + c[1], z = k + c[2];
          v.push_back(x + (n[0] + 1) * (y + (n[1] + 1) * z));
          p.push_back({{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}});
        }
        if (!tetrahedra) cells.push_back(cell_of(CellKind::hexahedron, v, p));
        for (const auto& t : kuhn) {
          Cell& cell = cells.emplace_back();
          cell.kind = CellKind::tetrahedron;
          for (int local : t) {
            cell.nodes.push_back(v[static_cast<std::size_t>(local)]);
            cell.parameters.push_back(p[static_cast<std::size_t>(local)]);
          }
        }
      }
  return cells;
}

std::vector<Cell> subdivide_triangles(const std::vector<Cell>& triangles, int n) {
  using Place = std::array<std::pair<int, int>, 3>;  // (vertex, weight), ascending, unused ones (-1, 0)
  std::map<Place, int> numbers;
  std::vector<Cell> cells;
  for (const Cell& t : triangles) {
    const auto add = [&](const std::array<std::array<int, 2>, 3>& points) {
      Cell& cell = cells.emplace_back();
      cell.kind = CellKind::triangle;
      for (const auto& [i, j] : points) {
        const std::array<int, 3> weight = {n - i - j, i, j};
        Place place;
        std::vector<double> w;
        for (std::size_t a = 0; a < 3; ++a) {
          place[a] = weight[a] > 0 ? std::pair(t.nodes[a], weight[a]) : std::pair(-1, 0);
          w.push_back(static_cast<double>(weight[a]) / n);
        }
        std::sort(place.begin(), place.end());
        cell.nodes.push_back(numbers.emplace(place, static_cast<int>(numbers.size())).first->second);
        cell.parameters.push_back(combine(w, t.parameters));
      }
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i + j < n; ++i) {
        add({{{i, j}, {i + 1, j}, {i, j + 1}}});
        if (i + j + 1 < n) add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
  }
  return cells;
}

std::vector<Cell> ringed_square(int n) {
  SurfaceGrid core;
  core.cells = {n, n};
  core.lower = {-1, -1};
  core.upper = {1, 1};
  core.triangles = false;
  std::vector<Cell> cells = surface_cells(core);
  const int inner = (n + 1) * (n + 1), around = 4 * n;
  // Places on the perimeter of the square, counter-clockwise from its lower left corner.
  const auto grid_place = [&](int k) {
    const int side = k / n, s = k % n;
    return side == 0 ? std::array{s, 0} : side == 1 ? std::array{n, s} : side == 2 ? std::array{n - s, n} : std::array{0, n - s};
  };
  const auto vertex = [&](int ring, int k) {
    const auto [i, j] = grid_place(k % around);
    return ring == 0 ? i + (n + 1) * j : inner + (ring - 1) * around + k % around;
  };
  const auto parameter = [&](int ring, int k) {
    const auto [i, j] = grid_place(k % around);
    const double size = 1 + static_cast<double>(ring) / n;
    const auto along = [&](int m) { return size * (static_cast<double>(2 * m - n) / n); };
    return Vec3<double>{{along(i), along(j), 0.0}};
  };
  for (int ring = 0; ring < n; ++ring)
    for (int k = 0; k < around; ++k)
      add_quadrilateral(cells, false, {vertex(ring, k + 1), vertex(ring, k), vertex(ring + 1, k), vertex(ring + 1, k + 1)},
                        {parameter(ring, k + 1), parameter(ring, k), parameter(ring + 1, k), parameter(ring + 1, k + 1)});
  return cells;
}

}  // namespace karcher
