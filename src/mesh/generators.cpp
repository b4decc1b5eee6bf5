#include "karcher/mesh/generators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "karcher/error.hpp"
#include "karcher/text.hpp"
#include "mesh/elevate.hpp"
#include "mesh/klein_bottle.hpp"
#include "mesh/structured.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using Point = Vec3<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Arguments with all defaults filled in and checked.
class Arguments {
 public:
  explicit Arguments(GeneratorOptions options) : options_(std::move(options)) {}

  double number(const std::string& argument, std::size_t i = 0) const { return options_.numbers.at(argument)[i]; }
  int integer(const std::string& argument, std::size_t i = 0) const { return static_cast<int>(number(argument, i)); }
  Point point(const std::string& argument) const {
    Point p;
    const auto& values = options_.numbers.at(argument);
    for (std::size_t i = 0; i < values.size(); ++i) p[static_cast<int>(i)] = values[i];
    return p;
  }
  const std::string& word(const std::string& argument) const { return options_.words.at(argument); }
  bool triangles() const { return word("shape") == "triangle"; }
  int order() const { return integer("order"); }
  [[noreturn]] void refuse(const std::string& sentence) const { throw InputError("Mesh generator \"" + options_.name + "\": " + sentence); }

 private:
  GeneratorOptions options_;
};

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

/// Six triangles around the origin, corners at distance 1, each cut into n x n. With rho the norm whose unit ball is the hexagon, p goes to
/// R p (1 + rho (rho / |p| - 1)): affine at the centre, the circle at the rim.
Mesh disc_of_triangles(int n, int order, double radius) {
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
    return radius * (1 + rho * (rho / distance - 1)) * p;
  });
}

/// n x n quadrilaterals in a square of half width 0.45 R and n rings of 4 n around it, which blend the square's sides linearly into the circle.
Mesh disc_of_quadrilaterals(int n, int order, double radius) {
  return elevate(ringed_square(n), order, [=](const Point& p) {
    constexpr double core = 0.45;
    const int main = std::abs(p[0]) >= std::abs(p[1]) ? 0 : 1;
    const double size = std::abs(p[main]), blend = std::max(0.0, size - 1);
    if (blend == 0) return radius * core * p;
    const double along = p[1 - main] / size, sign = p[main] > 0 ? 1 : -1;
    Point x;
    x[main] = sign * radius * ((1 - blend) * core + blend * std::cos(along * pi / 4));
    x[1 - main] = radius * ((1 - blend) * core * along + blend * std::sin(along * pi / 4));
    return x;
  });
}

Mesh disc(const Arguments& a) {
  Mesh mesh = a.triangles() ? disc_of_triangles(a.integer("cells"), a.order(), a.number("radius"))
                            : disc_of_quadrilaterals(a.integer("cells"), a.order(), a.number("radius"));
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

GeneratorArgument length(const char* name, const char* description, double value) {
  return {name, "length", description, {value}, {}, 0, false, false};
}
GeneratorArgument counts(const char* description, std::vector<double> values) {
  return {"cells", "1", description, std::move(values), {}, 1, true, true};
}
GeneratorArgument choice(const char* name, const char* description, std::vector<std::string> words) {
  return {name, "1", description, {}, std::move(words), -infinity, true, false};
}
GeneratorArgument vector(const char* name, const char* description, std::vector<double> values) {
  return {name, "length", description, std::move(values), {}, -infinity, true, false};
}
GeneratorArgument sizes(const char* description, std::vector<double> values) {
  return {"size", "length", description, std::move(values), {}, 0, false, false};
}
GeneratorArgument angle() { return {"angle", "angle", "from the x axis towards the y axis; 2 pi closes the mesh", {2 * pi}, {}, 0, false, false}; }
GeneratorArgument surface_shape() {
  return choice("shape", "each grid cell whole, or cut from lower left to upper right", {"triangle", "quadrilateral"});
}

struct Generator {
  GeneratorInfo info;
  Mesh (*make)(const Arguments&);
};

const std::vector<Generator>& table() {
  static const std::vector<Generator> all = [] {
    std::vector<Generator> list = {
        {{"interval",
          "Line cells on an axis from lower.",
          {length("length", "of the interval", 1), vector("lower", "its first point", {0, 0, 0}), choice("axis", "its direction", {"x", "y", "z"}),
           counts("number of cells", {8})},
          {"left", "right", "(bottom, top on axis y; front, back on axis z)"}},
         interval},
        {{"rectangle",
          "[lower, lower + size] in the plane z = 0.",
          {vector("lower", "lower left corner", {0, 0}), sizes("width and height", {1, 1}), counts("along x and y", {8, 8}), surface_shape()},
          {"left", "right", "bottom", "top"}},
         rectangle},
        {{"box",
          "[lower, lower + size]; a tetrahedral mesh cuts each hexahedron into six along its main diagonal.",
          {vector("lower", "corner of the lowest coordinates", {0, 0, 0}), sizes("edge lengths", {1, 1, 1}), counts("along x, y and z", {4, 4, 4}),
           choice("shape", "of the cells", {"tetrahedron", "hexahedron"})},
          {"left", "right", "bottom", "top", "front", "back"}},
         box},
        {{"cylinder",
          "(R cos u, R sin u, z), 0 <= u <= angle, 0 <= z <= height.",
          {length("radius", "R", 1), length("height", "along the z axis", 1), counts("around and along the axis", {16, 8}), angle(), surface_shape()},
          {"bottom", "top", "start", "end"}},
         cylinder},
        {{"annulus",
          "(r cos u, r sin u, 0), inner <= r <= outer, 0 <= u <= angle.",
          {length("inner", "smallest r", 0.5), length("outer", "largest r", 1), angle(), counts("around and across", {16, 4}), surface_shape()},
          {"inner", "outer", "start", "end"}},
         annulus},
        {{"disc",
          "Disc around the origin in the plane z = 0. Triangles: six sectors of n x n; quadrilaterals: a square of n x n and n rings of 4 n around "
          "it.",
          {length("radius", "of the disc", 1), counts("n", {4}), choice("shape", "of the cells", {"triangle", "quadrilateral"})},
          {"boundary"}},
         disc},
        {{"sphere",
          "Sphere around the origin: an icosahedron with each edge cut into n, 20 n x n triangles.",
          {length("radius", "of the sphere", 1), counts("n", {4})},
          {}},
         sphere},
        {{"torus",
          "((R + r cos v) cos u, (R + r cos v) sin u, r sin v).",
          {length("radius", "R, of the circle in the middle of the tube", 1), length("tube", "r < R", 0.4), counts("along u and across v", {24, 12}),
           surface_shape()},
          {}},
         torus},
        {{"moebius",
          "Moebius strip ((R + s cos(u/2)) cos u, (R + s cos(u/2)) sin u, s sin(u/2)), -width/2 <= s <= width/2.",
          {length("radius", "R, of the middle line", 1), length("width", "of the strip", 0.5), counts("along u and across s", {24, 4}),
           surface_shape()},
          {"boundary"}},
         moebius},
        {{"klein-bottle",
          "Immersed Klein bottle: a body on the plane z = 0, whose neck bends over as a handle towards +x, passes back through the body's wall and "
          "opens into "
          "the base from inside. Analytic; no principal curvature exceeds 12.88 / height, the neck's radius is 0.085 height, the body's 0.285 "
          "height.",
          {length("height", "from the base to the top of the handle", 1), counts("along the tube and across it", {48, 32}), surface_shape()},
          {}},
         bottle},
        {{"helicoid",
          "(r cos u, r sin u, pitch u / (2 pi)), inner <= r <= outer, 0 <= u <= 2 pi turns.",
          {{"inner", "length", "smallest r (may be 0 or negative)", {0}, {}, -infinity, true, false},
           length("outer", "largest r", 1),
           length("pitch", "rise per turn", 1),
           {"turns", "1", "number of turns", {1}, {}, 0, false, false},
           counts("along u and across r", {24, 6}),
           surface_shape()},
          {"inner", "outer", "start", "end"}},
         helicoid},
    };
    for (Generator& g : list) g.info.arguments.push_back({"order", "1", "geometry order of the cells, 1 to 3", {1}, {}, 1, true, true});
    return list;
  }();
  return all;
}

std::vector<std::string> names_of(const std::vector<GeneratorArgument>& arguments) {
  std::vector<std::string> names;
  for (const auto& a : arguments) names.push_back(a.name);
  return names;
}

Arguments resolve(const GeneratorInfo& info, const GeneratorOptions& given) {
  const auto refuse = [&](const std::string& sentence) { throw InputError("Mesh generator \"" + info.name + "\": " + sentence); };
  GeneratorOptions all = given;
  const auto check_known = [&](const std::string& name, bool is_choice) {
    for (const auto& a : info.arguments)
      if (a.name == name) {
        if (a.is_choice() != is_choice) refuse(name + (is_choice ? " is a number, not a word." : " is one of " + join_names(a.words) + "."));
        return;
      }
    refuse("there is no argument \"" + name + "\". " + suggestion(name, names_of(info.arguments), "Arguments"));
  };
  for (const auto& entry : given.numbers) check_known(entry.first, false);
  for (const auto& entry : given.words) check_known(entry.first, true);
  for (const auto& a : info.arguments) {
    if (a.is_choice()) {
      const std::string& word = all.words.emplace(a.name, a.words.front()).first->second;
      if (std::find(a.words.begin(), a.words.end(), word) == a.words.end())
        refuse(a.name + " is \"" + word + "\". " + suggestion(word, a.words, "Allowed"));
      continue;
    }
    const std::vector<double>& values = all.numbers.emplace(a.name, a.numbers).first->second;
    if (values.size() != a.numbers.size())
      refuse(a.name + " takes " + std::to_string(a.numbers.size()) + (a.numbers.size() == 1 ? " number" : " numbers") + ", not " +
             std::to_string(values.size()) + ".");
    for (const double x : values) {
      if (!std::isfinite(x)) refuse(a.name + " must be finite.");
      if (a.integer && (x != std::floor(x) || x > 1e8)) refuse(a.name + " must be a whole number.");
      if (x < a.minimum || (x == a.minimum && !a.minimum_allowed))
        refuse(a.name + (a.minimum_allowed ? " must be at least " : " must be greater than ") + std::to_string(static_cast<int>(a.minimum)) + ".");
    }
  }
  if (all.numbers.at("order")[0] > 3) refuse("order is 1, 2 or 3.");
  return Arguments(std::move(all));
}

const Generator& find(const std::string& name) {
  std::vector<std::string> names;
  for (const Generator& g : table()) {
    if (g.info.name == name) return g;
    names.push_back(g.info.name);
  }
  throw InputError("There is no mesh generator \"" + name + "\". " + suggestion(name, names, "Generators"));
}

}  // namespace

const std::vector<GeneratorInfo>& generators() {
  static const std::vector<GeneratorInfo> all = [] {
    std::vector<GeneratorInfo> infos;
    for (const Generator& g : table()) infos.push_back(g.info);
    return infos;
  }();
  return all;
}

const GeneratorInfo& generator(const std::string& name) { return find(name).info; }

Mesh generate(const GeneratorOptions& options) {
  const Generator& g = find(options.name);
  return g.make(resolve(g.info, options));
}

}  // namespace karcher
