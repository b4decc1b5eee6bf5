#include "mesh/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/elevate.hpp"
#include "mesh/klein_bottle.hpp"
#include "mesh/structured.hpp"

namespace karcher::shapes {
namespace {

using std::numbers::pi;
using Point = Vec3<double>;

/// A piece of the boundary: the facets whose corners all have parameters that satisfy the predicate.
struct Piece {
  const char* name;
  std::function<bool(const Point&)> contains;
};

std::function<bool(const Point&)> coordinate_is(int i, double value, double scale) {
  return [=](const Point& p) { return std::abs(p[i] - value) < 1e-9 * scale; };
}

void name_boundary(Mesh& mesh, const std::vector<Piece>& pieces) {
  std::vector<Cell> boundary = boundary_facets(mesh);
  for (const Piece& piece : pieces) {
    Region region{piece.name, mesh.dim - 1, {}};
    for (const Cell& c : boundary)
      if (std::all_of(c.parameters.begin(), c.parameters.end(), piece.contains)) region.cells.push_back(c);
    if (!region.cells.empty()) mesh.regions[piece.name] = std::move(region);
  }
  if (!boundary.empty()) mesh.regions["boundary"] = {"boundary", mesh.dim - 1, std::move(boundary)};
}

/// Flat meshes need no parameters: refinement of their own geometry is exact.
Mesh without_parameters(Mesh mesh) {
  mesh.parametrisation = {};
  const auto clear = [](std::vector<Cell>& cells) {
    for (Cell& c : cells) c.parameters = {};
  };
  clear(mesh.cells);
  for (auto& entry : mesh.regions) clear(entry.second.cells);
  return mesh;
}

Mesh surface(const Arguments& arguments, SurfaceGrid grid, const Map& map, const std::vector<Piece>& pieces) {
  grid.cells = {arguments.integer("cells", 0), arguments.integer("cells", 1)};
  grid.triangles = arguments.triangles();
  Mesh mesh = elevate(surface_cells(grid), arguments.order(), map);
  name_boundary(mesh, pieces);
  return mesh;
}

/// The low and high ends of both directions of an open grid.
std::vector<Piece> ends(const SurfaceGrid& grid, const char* low0, const char* high0, const char* low1, const char* high1) {
  const double size0 = grid.upper[0] - grid.lower[0], size1 = grid.upper[1] - grid.lower[1];
  return {{low0, coordinate_is(0, grid.lower[0], size0)},
          {high0, coordinate_is(0, grid.upper[0], size0)},
          {low1, coordinate_is(1, grid.lower[1], size1)},
          {high1, coordinate_is(1, grid.upper[1], size1)}};
}

/// First direction: an angle from 0, closed if it is the full turn.
SurfaceGrid around(const Arguments& arguments, double low, double high) {
  const double angle = arguments.number("angle");
  if (angle > 2 * pi * (1 + 1e-12)) arguments.refuse("angle is at most 2 pi.");
  SurfaceGrid grid;
  grid.lower = {0, low};
  grid.upper = {angle, high};
  grid.closed[0] = angle > 2 * pi * (1 - 1e-9);
  return grid;
}

/// Six triangles around the origin, corners at distance 1, each cut into n x n. With rho the norm whose unit ball is the hexagon, p goes to
/// R p (1 + rho (rho / |p| - 1)): affine at the centre, the circle at the rim.
/// Radial stretch of the unit disc, x -> x (1 + c |x|^2) / (1 + c), smooth at the origin; its derivative at the rim is `grading` times that at the origin.
Point graded(const Point& x, double grading) {
  const double c = (grading - 1) / 3;
  return (1 + c * norm2(x)) / (1 + c) * x;
}

Mesh disc_of_triangles(int n, int order, double radius, double grading) {
  std::vector<Cell> sectors;
  const auto corner = [](int k) { return Point{{std::cos(k * pi / 3), std::sin(k * pi / 3), 0.0}}; };
  for (int k = 0; k < 6; ++k) sectors.push_back({CellKind::triangle, 1, {0, k + 1, (k + 1) % 6 + 1}, {Point{}, corner(k), corner(k + 1)}});
  return elevate(subdivide_triangles(sectors, n), order, [=](const Point& p) {
    const double distance = std::hypot(p[0], p[1]);
    if (distance == 0) return Point{};
    double rho = 0;
    for (int k = 0; k < 6; ++k) {
      const double angle = (k + 0.5) * pi / 3;
      rho = std::max(rho, (p[0] * std::cos(angle) + p[1] * std::sin(angle)) / std::cos(pi / 6));
    }
    return radius * graded((1 + rho * (rho / distance - 1)) * p, grading);
  });
}

/// n x n quadrilaterals in a square of half width 0.45 R and n rings of 4 n around it, which blend the square's sides linearly into the circle.
Mesh disc_of_quadrilaterals(int n, int order, double radius, double grading) {
  return elevate(ringed_square(n), order, [=](const Point& p) {
    constexpr double core = 0.45;
    const int main = std::abs(p[0]) >= std::abs(p[1]) ? 0 : 1;
    const double size = std::abs(p[main]), blend = std::max(0.0, size - 1);
    if (blend == 0) return radius * graded(core * p, grading);
    const double along = p[1 - main] / size, sign = p[main] > 0 ? 1 : -1;
    Point x;
    x[main] = sign * ((1 - blend) * core + blend * std::cos(along * pi / 4));
    x[1 - main] = (1 - blend) * core * along + blend * std::sin(along * pi / 4);
    return radius * graded(x, grading);
  });
}

}  // namespace

Mesh interval(const Arguments& a) {
  const Point lower = a.point("lower");
  const double length = a.number("length");
  const int n = a.integer("cells"), axis = a.word("axis")[0] - 'x';
  std::vector<Cell> cells;
  for (int i = 0; i < n; ++i) {
    const auto at = [&](int k) { return Point{{static_cast<double>(k) / n, 0.0, 0.0}}; };
    cells.push_back({CellKind::line, 1, {i, i + 1}, {at(i), at(i + 1)}});
  }
  Mesh mesh = elevate(std::move(cells), a.order(), [=](const Point& p) {
    Point x = lower;
    x[axis] += length * p[0];
    return x;
  });
  static constexpr std::array<std::array<const char*, 2>, 3> names = {{{"left", "right"}, {"bottom", "top"}, {"front", "back"}}};
  const auto& [low, high] = names[static_cast<std::size_t>(axis)];
  name_boundary(mesh, {{low, coordinate_is(0, 0, 1)}, {high, coordinate_is(0, 1, 1)}});
  return without_parameters(std::move(mesh));
}

Mesh rectangle(const Arguments& a) {
  const Point lower = a.point("lower"), size = a.point("size");
  const SurfaceGrid unit;
  return without_parameters(surface(
      a, unit,
      [=](const Point& p) {
        return Point{{lower[0] + size[0] * p[0], lower[1] + size[1] * p[1], 0.0}};
      },
      ends(unit, "left", "right", "bottom", "top")));
}

Mesh box(const Arguments& a) {
  const Point lower = a.point("lower"), size = a.point("size");
  const std::array<int, 3> n = {a.integer("cells", 0), a.integer("cells", 1), a.integer("cells", 2)};
  Mesh mesh = elevate(solid_cells(n, a.word("shape") == "tetrahedron"), a.order(), [=](const Point& p) {
    Point x = lower;
    for (int i = 0; i < 3; ++i) x[i] += size[i] * (p[i] / n[static_cast<std::size_t>(i)]);
    return x;
  });
  std::vector<Piece> pieces;
  static constexpr std::array<const char*, 6> names = {"left", "right", "bottom", "top", "front", "back"};
  for (int i = 0; i < 3; ++i) {
    pieces.push_back({names[static_cast<std::size_t>(2 * i)], coordinate_is(i, 0, 1)});
    pieces.push_back({names[static_cast<std::size_t>(2 * i + 1)], coordinate_is(i, n[static_cast<std::size_t>(i)], 1)});
  }
  name_boundary(mesh, pieces);
  return without_parameters(std::move(mesh));
}

Mesh cylinder(const Arguments& a) {
  const double radius = a.number("radius");
  const SurfaceGrid grid = around(a, 0, a.number("height"));
  return surface(
      a, grid,
      [=](const Point& p) {
        return Point{{radius * std::cos(p[0]), radius * std::sin(p[0]), p[1]}};
      },
      ends(grid, "start", "end", "bottom", "top"));
}

Mesh annulus(const Arguments& a) {
  if (a.number("inner") >= a.number("outer")) a.refuse("inner must be less than outer.");
  const SurfaceGrid grid = around(a, a.number("inner"), a.number("outer"));
  return surface(
      a, grid,
      [](const Point& p) {
        return Point{{p[1] * std::cos(p[0]), p[1] * std::sin(p[0]), 0.0}};
      },
      ends(grid, "start", "end", "inner", "outer"));
}

Mesh disc(const Arguments& a) {
  Mesh mesh = a.triangles() ? disc_of_triangles(a.integer("cells"), a.order(), a.number("radius"), a.number("grading"))
                            : disc_of_quadrilaterals(a.integer("cells"), a.order(), a.number("radius"), a.number("grading"));
  name_boundary(mesh, {});
  return mesh;
}

Mesh sphere(const Arguments& a) {
  const double radius = a.number("radius"), g = std::numbers::phi;
  const std::array<Point, 12> corner = {{{{-1, g, 0}},
                                         {{1, g, 0}},
                                         {{-1, -g, 0}},
                                         {{1, -g, 0}},
                                         {{0, -1, g}},
                                         {{0, 1, g}},
                                         {{0, -1, -g}},
                                         {{0, 1, -g}},
                                         {{g, 0, -1}},
                                         {{g, 0, 1}},
                                         {{-g, 0, -1}},
                                         {{-g, 0, 1}}}};
  static constexpr std::array<std::array<int, 3>, 20> icosahedron = {
      {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
       {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
  std::vector<Cell> cells;
  for (const auto& t : icosahedron) {
    Cell& c = cells.emplace_back();
    c.kind = CellKind::triangle;
    for (int v : t) {
      c.nodes.push_back(v);
      c.parameters.push_back(corner[static_cast<std::size_t>(v)]);
    }
  }
  return elevate(subdivide_triangles(cells, a.integer("cells")), a.order(),
                 [=](const Point& p) { return (radius / std::hypot(p[0], p[1], p[2])) * p; });
}

Mesh torus(const Arguments& a) {
  const double radius = a.number("radius"), tube = a.number("tube");
  if (tube >= radius) a.refuse("tube must be less than radius.");
  SurfaceGrid grid;
  grid.upper = {2 * pi, 2 * pi};
  grid.closed = {true, true};
  return surface(a, grid,
                 [=](const Point& p) {
                   const double r = radius + tube * std::cos(p[1]);
                   return Point{{r * std::cos(p[0]), r * std::sin(p[0]), tube * std::sin(p[1])}};
                 },
                 {});
}

Mesh moebius(const Arguments& a) {
  const double radius = a.number("radius"), width = a.number("width");
  if (width >= 2 * radius) a.refuse("width must be less than twice the radius.");
  SurfaceGrid grid;
  grid.lower = {0, -width / 2};
  grid.upper = {2 * pi, width / 2};
  grid.closed[0] = grid.flipped = true;
  return surface(a, grid,
                 [=](const Point& p) {
                   const double r = radius + p[1] * std::cos(p[0] / 2);
                   return Point{{r * std::cos(p[0]), r * std::sin(p[0]), p[1] * std::sin(p[0] / 2)}};
                 },
                 {});
}

Mesh bottle(const Arguments& a) {
  const double height = a.number("height");
  SurfaceGrid grid;
  grid.lower = {0, -pi};
  grid.upper = {2 * pi, pi};
  grid.closed = {true, true};
  grid.flipped = true;
  return surface(a, grid, [=](const Point& p) { return height * klein_bottle(p[0], p[1]); }, {});
}

Mesh helicoid(const Arguments& a) {
  if (a.number("inner") >= a.number("outer")) a.refuse("inner must be less than outer.");
  SurfaceGrid grid;
  grid.lower = {0, a.number("inner")};
  grid.upper = {2 * pi * a.number("turns"), a.number("outer")};
  const double rise = a.number("pitch") / (2 * pi);
  return surface(
      a, grid,
      [=](const Point& p) {
        return Point{{p[1] * std::cos(p[0]), p[1] * std::sin(p[0]), rise * p[0]}};
      },
      ends(grid, "start", "end", "inner", "outer"));
}

}  // namespace karcher::shapes
