#include "karcher/mesh/generators.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "karcher/error.hpp"
#include "karcher/mesh/mesh_size.hpp"
#include "karcher/text.hpp"
#include "mesh/shapes.hpp"

namespace karcher {
namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();

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
  int sectors = 0;  ///< of n x n triangles, where cells is one number n; 0: cells are numbers along directions
};

const std::vector<Generator>& table() {
  static const std::vector<Generator> all = [] {
    std::vector<Generator> list = {
        {{"interval",
          "Line cells on an axis from lower.",
          {length("length", "of the interval", 1), vector("lower", "its first point", {0, 0, 0}), choice("axis", "its direction", {"x", "y", "z"}),
           counts("number of cells", {8})},
          {"left", "right", "(bottom, top on axis y; front, back on axis z)"}},
         shapes::interval},
        {{"rectangle",
          "[lower, lower + size] in the plane z = 0.",
          {vector("lower", "lower left corner", {0, 0}), sizes("width and height", {1, 1}), counts("along x and y", {8, 8}), surface_shape()},
          {"left", "right", "bottom", "top"}},
         shapes::rectangle},
        {{"box",
          "[lower, lower + size]; a tetrahedral mesh cuts each hexahedron into six along its main diagonal.",
          {vector("lower", "corner of the lowest coordinates", {0, 0, 0}), sizes("edge lengths", {1, 1, 1}), counts("along x, y and z", {4, 4, 4}),
           choice("shape", "of the cells", {"tetrahedron", "hexahedron"})},
          {"left", "right", "bottom", "top", "front", "back"}},
         shapes::box},
        {{"cylinder",
          "(R cos u, R sin u, z), 0 <= u <= angle, 0 <= z <= height.",
          {length("radius", "R", 1), length("height", "along the z axis", 1), counts("around and along the axis", {16, 8}), angle(), surface_shape()},
          {"bottom", "top", "start", "end"}},
         shapes::cylinder},
        {{"annulus",
          "(r cos u, r sin u, 0), inner <= r <= outer, 0 <= u <= angle.",
          {length("inner", "smallest r", 0.5), length("outer", "largest r", 1), angle(), counts("around and across", {16, 4}), surface_shape()},
          {"inner", "outer", "start", "end"}},
         shapes::annulus},
        {{"disc",
          "Disc around the origin in the plane z = 0.\nTriangles: six sectors of n x n; quadrilaterals: a square of n x n and n rings of 4 n around "
          "it.",
          {length("radius", "of the disc", 1),
           counts("n", {4}),
           choice("shape", "of the cells", {"triangle", "quadrilateral"}),
           {"grading", "1", "size of the cells at the rim, along the radius, over that in the centre", {1}, {}, 1, true, false}},
          {"boundary"}},
         shapes::disc,
         6},
        {{"sphere",
          "Sphere around the origin: an icosahedron with each edge cut into n, 20 n x n triangles.",
          {length("radius", "of the sphere", 1), counts("n", {4})},
          {}},
         shapes::sphere,
         20},
        {{"torus",
          "((R + r cos v) cos u, (R + r cos v) sin u, r sin v).",
          {length("radius", "R, of the circle in the middle of the tube", 1), length("tube", "r < R", 0.4), counts("along u and across v", {24, 12}),
           surface_shape()},
          {}},
         shapes::torus},
        {{"moebius",
          "Moebius strip ((R + s cos(u/2)) cos u, (R + s cos(u/2)) sin u, s sin(u/2)), -width/2 <= s <= width/2.",
          {length("radius", "R, of the middle line", 1), length("width", "of the strip", 0.5), counts("along u and across s", {24, 4}),
           surface_shape()},
          {"boundary"}},
         shapes::moebius},
        {{"klein-bottle",
          "Immersed Klein bottle: a bottle whose neck turns back through its wall and opens into its base.\n"
          "The base is on the plane z = 0, the handle bends towards +x. Analytic everywhere; no principal curvature exceeds 12.88 / height, the neck "
          "has the "
          "radius 0.085 height, the body 0.285 height.",
          {length("height", "from the base to the top of the handle", 1), counts("along the tube and across it", {48, 32}), surface_shape()},
          {}},
         shapes::bottle},
        {{"helicoid",
          "(r cos u, r sin u, pitch u / (2 pi)), inner <= r <= outer, 0 <= u <= 2 pi turns.",
          {{"inner", "length", "smallest r (may be 0 or negative)", {0}, {}, -infinity, true, false},
           length("outer", "largest r", 1),
           length("pitch", "rise per turn", 1),
           {"turns", "1", "number of turns", {1}, {}, 0, false, false},
           counts("along u and across r", {24, 6}),
           surface_shape()},
          {"inner", "outer", "start", "end"}},
         shapes::helicoid},
    };
    for (Generator& g : list) {
      g.info.arguments.push_back({"order", "1", "geometry order of the cells, 1 to 3", {1}, {}, 1, true, true});
      auto& regions = g.info.regions;
      if (!regions.empty() && regions.back() != "boundary") regions.push_back("boundary");
    }
    return list;
  }();
  return all;
}

std::vector<std::string> names_of(const std::vector<GeneratorArgument>& arguments) {
  std::vector<std::string> names;
  for (const auto& a : arguments) names.push_back(a.name);
  return names;
}

/// Refuses what would be too large, before it is made.
void check_size(const Generator& g, const GeneratorOptions& all) {
  const std::vector<double>& counts = all.numbers.at("cells");
  double cells = std::accumulate(counts.begin(), counts.end(), 1.0, std::multiplies<>());
  CellKind kind = CellKind::triangle;
  if (g.sectors > 0) {
    cells *= g.sectors * counts[0];
  } else if (const auto shape = all.words.find("shape"); shape == all.words.end()) {
    kind = CellKind::line;
  } else {
    const std::string& word = shape->second;
    kind = word == "triangle" ? CellKind::triangle : word == "quadrilateral" ? CellKind::quadrilateral : CellKind::hexahedron;
    if (word == "triangle") cells *= 2;
    if (word == "tetrahedron") {
      kind = CellKind::tetrahedron;
      cells *= 6;
    }
  }
  require_room(mesh_size(kind, static_cast<int>(all.numbers.at("order")[0]), cells), "Mesh generator \"" + g.info.name + "\": a mesh");
}

Arguments resolve(const Generator& g, const GeneratorOptions& given) {
  const GeneratorInfo& info = g.info;
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
  check_size(g, all);
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
  return g.make(resolve(g, options));
}

}  // namespace karcher
