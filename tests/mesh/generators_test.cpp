#include "karcher/mesh/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "karcher/error.hpp"
#include "karcher/mesh/refine.hpp"
#include "mesh/contains.hpp"
#include "mesh/klein_bottle.hpp"
#include "mesh/measure.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using Numbers = std::map<std::string, std::vector<double>>;

Mesh make(const std::string& name, Numbers numbers = {}, const std::string& shape = "") {
  GeneratorOptions options{name, std::move(numbers), {}};
  if (!shape.empty()) options.words["shape"] = shape;
  return generate(options);
}

std::string message(const GeneratorOptions& options) {
  try {
    generate(options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// Union of equivalence classes.
int root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i)
    i = parent[static_cast<std::size_t>(i)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
  return i;
}

/// Number of connected components of cells that share vertices.
int components(const std::vector<Cell>& cells) {
  int vertices = 0;
  for (const Cell& c : cells)
    for (int v : c.nodes) vertices = std::max(vertices, v + 1);
  std::vector<int> parent(static_cast<std::size_t>(vertices));
  std::iota(parent.begin(), parent.end(), 0);
  std::set<int> used;
  for (const Cell& c : cells)
    for (int v = 0; v < vertex_count(c.kind); ++v) {
      used.insert(c.nodes[static_cast<std::size_t>(v)]);
      parent[static_cast<std::size_t>(root(parent, c.nodes[static_cast<std::size_t>(v)]))] = root(parent, c.nodes[0]);
    }
  std::set<int> roots;
  for (int v : used) roots.insert(root(parent, v));
  return static_cast<int>(roots.size());
}

/// Whether the cells of a surface can be turned so that neighbours run through their common edge in opposite directions: a two-colouring of the cells
/// through edges.
bool orientable(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> through;  // edge -> (cell, direction)
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const auto& [i, j] : edges(mesh.cells[c].kind)) {
      const int a = mesh.cells[c].nodes[static_cast<std::size_t>(i)], b = mesh.cells[c].nodes[static_cast<std::size_t>(j)];
      through[std::minmax(a, b)].emplace_back(static_cast<int>(c), a < b ? 1 : -1);
    }
  std::vector<std::vector<std::pair<int, int>>> neighbours(mesh.cells.size());
  for (const auto& [edge, cells] : through)
    if (cells.size() == 2) {
      const int sign = -cells[0].second * cells[1].second;
      neighbours[static_cast<std::size_t>(cells[0].first)].emplace_back(cells[1].first, sign);
      neighbours[static_cast<std::size_t>(cells[1].first)].emplace_back(cells[0].first, sign);
    }
  std::vector<int> side(mesh.cells.size(), 0), stack;
  for (std::size_t start = 0; start < side.size(); ++start) {
    if (side[start]) continue;
    side[start] = 1;
    stack.push_back(static_cast<int>(start));
    while (!stack.empty()) {
      const auto c = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (const auto& [other, sign] : neighbours[c]) {
        int& s = side[static_cast<std::size_t>(other)];
        if (s == 0) {
          s = side[c] * sign;
          stack.push_back(other);
        } else if (s != side[c] * sign) {
          return false;
        }
      }
    }
  }
  return true;
}

TEST(Generators, FlatShapesHaveTheirMeasureForEveryShapeAndOrder) {
  for (double order : {1.0, 2.0, 3.0}) {
    const Mesh line = generate({"interval", {{"length", {2.5}}, {"lower", {1, 2, 3}}, {"order", {order}}}, {{"axis", "y"}}});
    EXPECT_NEAR(measure(line), 2.5, 1e-14);
    EXPECT_EQ(line.region("bottom").cells.size(), 1u);
    EXPECT_DOUBLE_EQ(line.nodes[static_cast<std::size_t>(line.region("top").cells[0].nodes[0])][1], 4.5);
    for (const char* shape : {"triangle", "quadrilateral"}) {
      const Mesh mesh = make("rectangle", {{"lower", {-1, 2}}, {"size", {2, 3}}, {"cells", {3, 2}}, {"order", {order}}}, shape);
      EXPECT_NEAR(measure(mesh), 6, 1e-13);
      EXPECT_NEAR(measure(mesh, mesh.region("left").cells), 3, 1e-14);
      EXPECT_NEAR(measure(mesh, mesh.region("top").cells), 2, 1e-14);
      EXPECT_NEAR(measure(mesh, mesh.region("boundary").cells), 10, 1e-13);
    }
    for (const char* shape : {"tetrahedron", "hexahedron"}) {
      const Mesh mesh = make("box", {{"size", {2, 3, 0.5}}, {"cells", {3, 2, 1}}, {"order", {order}}}, shape);
      EXPECT_NEAR(measure(mesh), 3, 1e-13);
      EXPECT_NEAR(measure(mesh, mesh.region("right").cells), 1.5, 1e-14);
      EXPECT_NEAR(measure(mesh, mesh.region("bottom").cells), 1, 1e-14);
      EXPECT_NEAR(measure(mesh, mesh.region("back").cells), 6, 1e-13);
      for (const Cell& c : mesh.region("back").cells)
        for (int n : c.nodes) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)][2], 0.5);
    }
  }
}

TEST(Generators, RectanglesAreCutFromLowerLeftToUpperRight) {
  const Mesh mesh = make("rectangle", {{"cells", {1, 1}}});
  ASSERT_EQ(mesh.cells.size(), 2u);
  for (const Cell& c : mesh.cells) {
    int on_diagonal = 0;
    for (int n : c.nodes) on_diagonal += mesh.nodes[static_cast<std::size_t>(n)][0] == mesh.nodes[static_cast<std::size_t>(n)][1];
    EXPECT_EQ(on_diagonal, 2);
  }
}

TEST(Generators, SurfacesHaveTheirEulerCharacteristicOrientationAndBoundary) {
  struct Expected {
    const char* name;
    int euler, boundaries;
    bool orientable;
  };
  for (const auto& e : {Expected{"sphere", 2, 0, true}, Expected{"torus", 0, 0, true}, Expected{"klein-bottle", 0, 0, false},
                        Expected{"moebius", 0, 1, false}, Expected{"cylinder", 0, 2, true}, Expected{"annulus", 0, 2, true},
                        Expected{"disc", 1, 1, true}, Expected{"helicoid", 1, 1, true}, Expected{"rectangle", 1, 1, true}})
    for (const char* shape : {"triangle", "quadrilateral"}) {
      if (std::string(e.name) == "sphere" && shape[0] == 'q') continue;
      const Mesh mesh = make(e.name, {}, std::string(e.name) == "sphere" ? "" : shape);
      EXPECT_EQ(euler_characteristic(mesh), e.euler) << e.name;
      EXPECT_EQ(orientable(mesh), e.orientable) << e.name;
      EXPECT_EQ(components(boundary_facets(mesh)), e.boundaries) << e.name;
      EXPECT_EQ(components(mesh.cells), 1) << e.name;
    }
}

/// |computed - exact| on a mesh and on the same with twice as many cells in each direction: the observed order.
template <class Error>
double order_of(Error error) {
  return std::log2(error(1) / error(2));
}

TEST(Generators, AreasOfCurvedSurfacesConvergeWithTheOrderOfTheGeometry) {
  const auto helicoid_area = [](double r, double rise) {  // of 0 <= r' <= r over one turn: 2 pi int sqrt(r'^2 + rise^2)
    return 2 * pi * 0.5 * (r * std::sqrt(r * r + rise * rise) + rise * rise * std::asinh(r / rise));
  };
  struct Shape {
    const char* name;
    double area;
    std::vector<double> cells;
  };
  for (const Shape& s : {Shape{"cylinder", 2 * pi, {8, 2}}, Shape{"sphere", 4 * pi, {3}}, Shape{"torus", 4 * pi * pi * 0.4, {16, 10}},
                         Shape{"annulus", pi * 0.75, {8, 1}}, Shape{"disc", pi, {2}}, Shape{"helicoid", helicoid_area(1, 1 / (2 * pi)), {8, 6}}})
    for (int p = 1; p <= 3; ++p) {
      const auto error = [&](double factor) {
        std::vector<double> cells = s.cells;
        for (double& n : cells) n *= factor;
        return std::abs(measure(make(s.name, {{"cells", cells}, {"order", {static_cast<double>(p)}}}), 10) - s.area);
      };
      const double expected = p == 1 ? 2 : 4;  // area is superconvergent at p = 2: the error of an even order is odd in the normal direction
      EXPECT_NEAR(order_of(error), expected, 0.3) << s.name << " p = " << p;
      EXPECT_LT(error(2), p == 1 ? 0.2 : 1e-3) << s.name << " p = " << p;
    }
}

TEST(Generators, NodesOfHighOrderLieOnTheExactSurface) {
  for (double order : {1.0, 2.0, 3.0})
    for (const Mesh& mesh : {make("sphere", {{"radius", {2}}, {"cells", {2}}, {"order", {order}}})})
      for (const auto& x : mesh.nodes) EXPECT_NEAR(std::sqrt(norm2(x)), 2, 1e-15);
  const auto check = [](const Mesh& mesh, auto residual) {
    for (const auto& x : mesh.nodes) EXPECT_NEAR(residual(x), 0, 2e-15);
  };
  for (double order : {2.0, 3.0}) {
    check(make("cylinder", {{"order", {order}}}), [](const Vec3<double>& x) { return std::hypot(x[0], x[1]) - 1; });
    check(make("torus", {{"order", {order}}}), [](const Vec3<double>& x) { return std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - 0.4; });
    check(make("helicoid", {{"order", {order}}}),
          [](const Vec3<double>& x) { return x[0] * std::sin(2 * pi * x[2]) - x[1] * std::cos(2 * pi * x[2]); });
    const Mesh disc = make("disc", {{"order", {order}}}, "quadrilateral");
    for (const Cell& c : disc.region("boundary").cells)
      for (int n : c.nodes) EXPECT_NEAR(norm2(disc.nodes[static_cast<std::size_t>(n)]), 1, 1e-14);
  }
}

TEST(Generators, GradingMakesTheCellsAtTheRimLongerThanThoseInTheCentre) {
  for (const char* shape : {"triangle", "quadrilateral"}) {
    const double n = 40, q = 7;
    const Mesh plain = make("disc", {{"cells", {n}}}, shape), graded = make("disc", {{"cells", {n}}, {"grading", {q}}}, shape);
    EXPECT_NEAR(measure(graded, 4), pi, 2e-3);
    // x -> x (1 + c |x|^2) / (1 + c) with 1 + 3 c = q
    for (std::size_t i = 0; i < plain.nodes.size(); ++i) {
      const double r = std::sqrt(norm2(plain.nodes[i]));
      EXPECT_NEAR(std::sqrt(norm2(graded.nodes[i])), r * (1 + (q - 1) / 3 * r * r) / (1 + (q - 1) / 3), 1e-14);
    }
  }
}

TEST(Generators, DiscsAreFlatPositiveAndHaveNoFoldedCell) {
  for (const char* shape : {"triangle", "quadrilateral"})
    for (double order : {1.0, 2.0, 3.0}) {
      const Mesh mesh = make("disc", {{"cells", {3}}, {"order", {order}}}, shape);
      EXPECT_EQ(mesh.cells.size(), shape[0] == 't' ? 54u : 45u);
      for (const Cell& c : mesh.cells)
        for (const auto& xi : quadrature(c.kind, 6).points) {
          const GeometryJet g = geometry(mesh, c, xi);
          EXPECT_GT(cross(g.d[0], g.d[1])[2], 0.01);
        }
    }
}

TEST(Generators, OpenCylindersAndAnnuliHaveAStartAndAnEnd) {
  const Mesh open = make("cylinder", {{"angle", {pi}}, {"height", {3}}});
  EXPECT_NEAR(measure(open, open.region("start").cells), 3, 1e-14);
  EXPECT_NEAR(measure(open, open.region("end").cells), 3, 1e-14);
  EXPECT_EQ(open.region("bottom").cells.size(), 16u);
  const Mesh closed = make("cylinder");
  EXPECT_FALSE(closed.regions.contains("start"));
  EXPECT_EQ(closed.region("bottom").cells.size(), 16u);
  const Mesh sector = make("annulus", {{"angle", {pi / 2}}, {"order", {3}}});
  EXPECT_NEAR(measure(sector, sector.region("inner").cells), pi / 4, 5e-8);
  EXPECT_NEAR(measure(sector, sector.region("outer").cells), pi / 2, 5e-8);
  EXPECT_NEAR(measure(sector, sector.region("end").cells), 0.5, 1e-14);
}

TEST(Generators, TheTwoPublishedMeshesHaveTheirSizes) {
  const Mesh bottle = make("klein-bottle", {{"cells", {48, 32}}, {"order", {2}}});
  EXPECT_EQ(bottle.cells.size(), 3072u);
  EXPECT_EQ(bottle.nodes.size(), 6144u);
  EXPECT_EQ(make("cylinder", {{"cells", {80, 40}}, {"order", {2}}}).cells.size(), 6400u);
}

/// Largest principal curvature and area element at a point, by central differences of fourth order.
struct Bend {
  double curvature, area;
};
Bend bend(double u, double v) {
  const double h = 2e-3;
  constexpr std::array<double, 5> d1 = {1. / 12, -2. / 3, 0, 2. / 3, -1. / 12}, d2 = {-1. / 12, 4. / 3, -5. / 2, 4. / 3, -1. / 12};
  Vec3<double> xu, xv, xuu, xuv, xvv;
  for (int i = 0; i < 5; ++i) {
    const auto a = static_cast<std::size_t>(i);
    xu += (d1[a] / h) * klein_bottle(u + (i - 2) * h, v);
    xv += (d1[a] / h) * klein_bottle(u, v + (i - 2) * h);
    xuu += (d2[a] / (h * h)) * klein_bottle(u + (i - 2) * h, v);
    xvv += (d2[a] / (h * h)) * klein_bottle(u, v + (i - 2) * h);
    for (int j = 0; j < 5; ++j) xuv += (d1[a] * d1[static_cast<std::size_t>(j)] / (h * h)) * klein_bottle(u + (i - 2) * h, v + (j - 2) * h);
  }
  const Vec3<double> n = cross(xu, xv);
  const double area = std::sqrt(norm2(n)), e = dot(xu, xu), f = dot(xu, xv), g = dot(xv, xv);
  const double l = dot(xuu, n) / area, m = dot(xuv, n) / area, k = dot(xvv, n) / area;
  const double mean = (e * k - 2 * f * m + g * l) / (2 * area * area), gauss = (l * k - m * m) / (area * area);
  return {std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss)), area};
}

TEST(KleinBottle, GluesItsEndsWithAFlipIncludingAllDerivatives) {
  for (double v = -3; v < 3; v += 0.37)
    for (double u : {-0.2, 0.0, 0.3})  // equal on an interval around the seam, so all derivatives are
      EXPECT_LT(norm2(klein_bottle(u + 2 * pi, v) - klein_bottle(u, -v)), 1e-28);
}

TEST(KleinBottle, IsRegularWithTheDocumentedLargestCurvatureAndSize) {
  double curvature = 0, least_area = 1, area = 0;
  Vec3<double> lower{{1, 1, 1}}, upper{{-1, -1, -1}};
  const int nu = 400, nv = 100;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double u = 2 * pi * i / nu, v = 2 * pi * j / nv;
      const Bend b = bend(u, v);
      curvature = std::max(curvature, b.curvature);
      least_area = std::min(least_area, b.area);
      area += b.area * 4 * pi * pi / (nu * nv);
      const Vec3<double> x = klein_bottle(u, v);
      for (int a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], x[a]);
        upper[a] = std::max(upper[a], x[a]);
      }
    }
  EXPECT_LT(curvature, klein_bottle_curvature);
  EXPECT_GT(curvature, klein_bottle_curvature - 0.03);
  EXPECT_GT(least_area, 0.015);
  EXPECT_NEAR(area, 1.967, 5e-4);
  EXPECT_NEAR(lower[2], 0, 2e-4);
  EXPECT_NEAR(upper[2], 1, 2e-4);
  EXPECT_NEAR(lower[0], -0.292, 5e-4);
  EXPECT_NEAR(upper[0], 0.465, 1e-3);
}

TEST(KleinBottle, AreaOfTheMeshConverges) {
  const double exact = measure(make("klein-bottle", {{"cells", {96, 64}}, {"order", {3}}}), 8);
  const auto error = [&](double f) { return std::abs(measure(make("klein-bottle", {{"cells", {24 * f, 16 * f}}, {"order", {2}}}), 8) - exact); };
  EXPECT_NEAR(std::log2(error(1) / error(2)), 4, 0.5);
  EXPECT_LT(error(2) / exact, 5e-4);
}

TEST(KleinBottle, ScalesWithItsHeight) { EXPECT_NEAR(measure(make("klein-bottle", {{"height", {3}}})), 9 * measure(make("klein-bottle")), 1e-12); }

TEST(Generators, RefuseWhatTheyDoNotKnowWithTheNearestName) {
  EXPECT_TRUE(contains(message({"kleinbottle", {}, {}}), "Did you mean \"klein-bottle\"?"));
  EXPECT_TRUE(contains(message({"sphere", {{"raduis", {1}}}, {}}), "Did you mean \"radius\"?"));
  EXPECT_TRUE(contains(message({"sphere", {}, {{"shape", "triangle"}}}), "no argument \"shape\""));
  EXPECT_TRUE(contains(message({"torus", {}, {{"shape", "trinagle"}}}), "Did you mean \"triangle\"?"));
}

TEST(Generators, RefuseWrongNumbers) {
  EXPECT_TRUE(contains(message({"sphere", {{"radius", {0}}}, {}}), "greater than 0"));
  EXPECT_TRUE(contains(message({"sphere", {{"radius", {std::nan("")}}}, {}}), "finite"));
  EXPECT_TRUE(contains(message({"sphere", {{"cells", {1.5}}}, {}}), "whole number"));
  EXPECT_TRUE(contains(message({"sphere", {{"order", {4}}}, {}}), "1, 2 or 3"));
  EXPECT_TRUE(contains(message({"box", {{"size", {1, 1}}}, {}}), "takes 3 numbers, not 2"));
  EXPECT_TRUE(contains(message({"box", {{"shape", {1}}}, {}}), "tetrahedron, hexahedron"));
  EXPECT_TRUE(contains(message({"torus", {{"tube", {1}}}, {}}), "less than radius"));
  EXPECT_TRUE(contains(message({"box", {{"cells", {1e4, 1e4, 1e4}}}, {}}),
                       "a mesh has about 6e+12 cells and 1e+12 nodes; more than 2.1e+09 are not numbered"));
  EXPECT_TRUE(contains(message({"cylinder", {{"angle", {7}}}, {}}), "at most 2 pi"));
}

TEST(Generators, RefuseMeshesWithLessThanThreeCellsAround) {
  for (const auto& [name, cells] : std::map<std::string, std::vector<double>>{
           {"cylinder", {2, 4}}, {"annulus", {2, 4}}, {"torus", {2, 4}}, {"moebius", {2, 4}}, {"klein-bottle", {4, 2}}, {"klein-bottle", {2, 4}}})
    EXPECT_TRUE(contains(message({name, {{"cells", cells}}, {}}), "at least three cells")) << name;
  for (const char* name : {"cylinder", "torus", "moebius", "klein-bottle"}) EXPECT_NO_THROW(make(name, {{"cells", {3, 3}}, {"order", {3}}})) << name;
  EXPECT_NO_THROW(make("moebius", {{"cells", {3, 1}}}, "quadrilateral"));
}

TEST(Generators, TableNamesEveryArgumentWithADefaultThatWorks) {
  std::set<std::string> names;
  for (const GeneratorInfo& info : generators()) {
    names.insert(info.name);
    EXPECT_NO_THROW(make(info.name)) << info.name;
    std::set<std::string> arguments;
    for (const auto& a : info.arguments) {
      EXPECT_FALSE(a.description.empty() || a.unit.empty()) << info.name << a.name;
      EXPECT_TRUE(a.is_choice() != !a.numbers.empty());
      arguments.insert(a.name);
    }
    EXPECT_TRUE(arguments.contains("cells") && arguments.contains("order")) << info.name;
    EXPECT_EQ(make(info.name).regions.contains("boundary"), std::count(info.regions.begin(), info.regions.end(), "boundary") == 1) << info.name;
  }
  const std::set<std::string> contract = {"interval", "rectangle", "box",     "cylinder",     "annulus", "disc",
                                          "sphere",   "torus",     "moebius", "klein-bottle", "helicoid"};
  EXPECT_EQ(names, contract);
}

}  // namespace
}  // namespace karcher
