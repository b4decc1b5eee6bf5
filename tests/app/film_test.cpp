// Shells on the boundary of solids.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

/// Its material follows.
const std::string solid = R"toml([fields.m]
manifold = "R3"
order = 2
[[energies]]
type = "hyperelastic"
deformation = "m"
)toml";

/// A shell on the face z = 1 of a box: its field, which starts without stress, and its energy.
std::string film(const std::string& type, int order, const std::string& rest) {
  const bool director = type == "reissner-mindlin";
  return "[fields.film]\non = \"back\"\norder = " + std::to_string(order) + "\nmanifold = \"" + (director ? "S2" : "SO3") +
         "\"\n[[energies]]\non = \"back\"\ntype = \"" + type + "\"\ndeformation = \"m\"\n" +
         (director ? "director = \"film\"\n" : "rotation = \"film\"\nmu_c = 5\nL_c = 1e-5\n") + rest;
}

/// A strip of length 10, width 1 and height 1 without lateral contraction, held at one end so that it can bend freely.
const std::string strip_of_solid = R"toml([mesh]
generate = "box"
size = [10, 1, 1]
cells = [12, 1, 2]
shape = "hexahedron"
[regions.corner]
near = [0, 0, 0]
[regions.other_corner]
near = [0, 1, 0]
)toml" + solid + R"toml(material = "saint-venant-kirchhoff"
young = 1
poisson = 0
[[dirichlet]]
field = "m"
on = "left"
value = [0, "free", "free"]
[[dirichlet]]
field = "m"
on = "corner"
value = [0, 0, 0]
[[dirichlet]]
field = "m"
on = "other_corner"
value = [0, "free", 0]
[[probes]]
name = "tip"
field = "m"
at = [10, 0.5, 0.5]
quantity = "displacement"
)toml";

TEST(Film, BendsAStripThatIsTooShortForIt) {
  // The film has the force E_f h (e - 0.001) per width, e the strain of the face; force and couple of the section vanish (Timoshenko 1925 for a thin film),
  // but for a length of about the height at the free end, where the film begins to pull.
  const double stiffness = 10 * 0.01, force = -stiffness * 0.001 / (1 + 4 * stiffness), curvature = -6 * force, stretch = -force;
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"})
    for (const std::string rule : {"projection", "geodesic"}) {
      const Workshop shop;
      std::string shell = film(type, 2, "thickness = 0.01\nyoung = 10\npoisson = 0\nprestretch = [\"1 + 0.001*t\", 1]\n");
      shell.insert(shell.find("order"), "interpolation = \"" + rule + "\"\n");
      const json s = run(shop, strip_of_solid + shell);
      const json tip = s["load_steps"].back()["probes"]["tip"];
      EXPECT_NEAR(tip[2].get<double>(), -50 * curvature, 0.003 * 50 * curvature) << type;
      EXPECT_NEAR(tip[0].get<double>(), 10 * stretch - 10 * std::pow(10 * curvature, 2) / 6, 0.1 * stretch * 10) << type;
      EXPECT_EQ(s["load_steps"].back()["negative_eigenvalues"], 0);
      EXPECT_TRUE(s["warnings"].empty()) << s["warnings"];
    }
}

/// A block that is pressed together, of cells of some shape.
std::string block(const std::string& shape) {
  return "[mesh]\ngenerate = \"box\"\nsize = [2, 1, 1]\ncells = [3, 2, 2]\nshape = \"" + shape + R"toml("
)toml" + solid +
         R"toml(material = "neo-hooke"
mu = 1
lambda = 2
[[dirichlet]]
field = "m"
on = "left"
value = "initial"
[[dirichlet]]
field = "m"
on = "right"
value = ["x - 0.1*t", "y", "z"]
)toml";
}

TEST(Film, OfNoThicknessLeavesTheSolidAsItIs) {
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"}) {
    const Workshop shop;
    const double alone = run(shop, block("hexahedron"), "", "alone")["energy"];
    const json s = run(shop, block("hexahedron") + film(type, 1, "thickness = 1e-9\nmu = 10\nlambda = 20\n"));
    EXPECT_NEAR(s["energy"].get<double>(), alone, 1e-6 * alone) << type;
    const json thick = run(shop, block("hexahedron") + film(type, 1, "thickness = 0.05\nmu = 10\nlambda = 20\n"));
    EXPECT_GT(thick["energy"].get<double>(), 1.1 * alone) << type;
  }
}

TEST(Film, LivesOnTheCurvedFacesOfAnyCell) {
  for (const std::string shape : {"hexahedron", "tetrahedron"})
    for (const std::string type : {"cosserat-shell", "reissner-mindlin"})
      for (const int order : {1, 2}) {
        const Workshop shop;
        shop.write("problem.toml", block(shape) + "[reference]\nposition = [\"x + 0.1*z^2\", \"y - 0.1*x*z\", \"z + 0.1*x^2\"]\norder = 2\n" +
                                       film(type, order, "thickness = 0.05\nmu = 10\nlambda = 20\n"));
        const Outcome o = shop.karcher("check problem.toml --derivatives --objectivity");
        const std::string what = shape + ' ' + type + ' ' + std::to_string(order) + '\n';
        EXPECT_EQ(o.code, 0) << what << o.out << o.err;
        EXPECT_EQ(o.out.find("warning"), std::string::npos) << what << o.out;
        EXPECT_NE(o.out.find("no energy changes"), std::string::npos) << what << o.out;
      }
}

TEST(Film, EndsInTheSameStateOnTwoRanks) {
  const Workshop shop;
  const std::string problem = block("hexahedron") + film("cosserat-shell", 1, "thickness = 0.05\nmu = 10\nlambda = 20\nprestretch = [1.05, 1.02]\n");
  const double one = run(shop, problem)["energy"], two = run(shop, problem, "-n 2", "two")["energy"];
  EXPECT_NEAR(two, one, 1e-10 * one);
}

TEST(Film, IsHeldByTheWallsThatItTouches) {
  const Workshop shop;
  std::string walls = block("hexahedron") + film("cosserat-shell", 2, "thickness = 0.05\nmu = 10\nlambda = 20\n");
  walls +=
      "[[dirichlet]]\nfield = \"film\"\non = \"bottom\"\nvalue = \"identity\"\n";  // the face y = 0, of which the film has an edge of three cells
  shop.write("problem.toml", walls);
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("35 nodes, 105 unknowns, 21 fixed"), std::string::npos) << o.out;
  // The face z = 0 is on the other side.
  std::string away = walls;
  away.replace(away.find("on = \"bottom\""), 13, "on = \"front\"");
  EXPECT_NE(refusal(away).find("has no node on the region \"front\""), std::string::npos) << refusal(away);
}

TEST(Film, IsRefusedInsideTheSolid) {
  const std::string said = refusal(
      block("hexahedron") + "[regions.inside]\ndim = 3\nwhere = \"x < 1\"\n" +
      "[fields.film]\nmanifold = \"SO3\"\n[[energies]]\ntype = \"cosserat-shell\"\non = \"inside\"\ndeformation = \"m\"\nrotation = \"film\"\n"
      "mu_c = 1\nL_c = 1e-3\nthickness = 0.1\nmu = 1\nlambda = 1\n");
  EXPECT_NE(said.find("energies.1: cosserat-shell is an integral over a region of dimension 2, but \"inside\" has dimension 3."), std::string::npos)
      << said;
}

}  // namespace
}  // namespace karcher::testing
