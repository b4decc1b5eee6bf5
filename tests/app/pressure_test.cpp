// Pressures through the program.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "problems.hpp"

namespace karcher::app {
namespace {

using nlohmann::json;
using testing::Outcome;
using testing::refusal;
using testing::run;
using testing::Workshop;

/// A thin shell on a mesh with cells of order 3. Ends in [[loads]].
std::string shell(const std::string& mesh, const std::string& value) {
  return "[mesh]\norder = 3\n" + mesh + R"toml([fields.m]
manifold = "R3"
[fields.Q]
manifold = "SO3"
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.02
young = 1e6
poisson = 0.3
mu_c = 4e5
L_c = 1e-5
[[loads]]
type = "pressure"
field = "m"
value = )toml" +
         value + "\n";
}
std::string hold(const std::string& on, const std::string& how) { return "[[dirichlet]]\non = \"" + on + "\"\n" + how + "\n"; }
std::string probe(const std::string& name, const std::string& at, const std::string& quantity = "displacement") {
  return "[[probes]]\nname = \"" + name + "\"\nfield = \"m\"\nat = " + at + "\nquantity = \"" + quantity + "\"\n";
}
json probes(const json& summary) { return summary["load_steps"].back()["probes"]; }

/// A quarter of a tube between planes of symmetry.
const std::string tube = shell("generate = \"cylinder\"\nheight = 0.5\nangle = \"pi/2\"\ncells = [4, 1]\nshape = \"quadrilateral\"\n", "\"-t\"") +
                         hold("start", "symmetry = \"y\"") + hold("end", "symmetry = \"x\"") + hold("bottom", "symmetry = \"z\"") +
                         hold("top", "symmetry = \"z\"") + probe("u", "[1, 0, 0.25]");

TEST(Pressure, WidensATubeAsTheThinCylinderOnAnyNumberOfRanks) {
  const Workshop shop;
  const json s = run(shop, tube);
  const double u = (1 - 0.09) / (1e6 * 0.02);  // p r^2 (1 - nu^2)/(E h), held along its axis
  EXPECT_NEAR(probes(s)["u"][0].get<double>() / u, 1, 1e-3);
  EXPECT_EQ(s["warnings"].size(), 0u) << s["warnings"];
  const json two = run(shop, tube, "-n 2", "two");
  EXPECT_NEAR(probes(two)["u"][0].get<double>() / u, probes(s)["u"][0].get<double>() / u, 1e-9);
  EXPECT_NEAR(two["energy"].get<double>() / s["energy"].get<double>(), 1, 1e-12);
  // The volume of the quarter.
  EXPECT_NEAR(s["energies"]["pressure-load"].get<double>(), -std::numbers::pi / 8 * (1 + 2 * u), 1e-5);
}

TEST(Pressure, WidensASphereThatFloats) {
  const Workshop shop;
  std::string sphere = shell("generate = \"sphere\"\ncells = [2]\n", "\"-t\"");
  for (const char* name : {"x", "y"}) sphere += probe(name, std::string(name) == "x" ? "[0, 0, 1]" : "[0, 0, -1]", "value");
  // It may turn: the distance of two poles.
  const auto stretch = [](const json& summary) {
    const json p = probes(summary);
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(p["x"][i].get<double>() - p["y"][i].get<double>(), 2);
    return std::sqrt(sum) / 2 - 1;
  };
  const json s = run(shop, sphere);
  EXPECT_NEAR(stretch(s) / (0.7 / (2e6 * 0.02)), 1, 1e-3);  // p r^2 (1 - nu)/(2 E h)
  EXPECT_EQ(s["load_steps"][0]["negative_eigenvalues"], 0);
}

const std::string square = "generate = \"rectangle\"\ncells = [2, 2]\nshape = \"quadrilateral\"\n";

TEST(Pressure, OnAClampedPlateIsADeadLoadAsLongAsItIsSmall) {
  const Workshop shop;
  const std::string plate = shell(square, "1e-6") + hold("boundary", "support = \"clamped\"") + probe("u", "[0.5, 0.5, 0]");
  std::string dead = plate;
  dead.replace(dead.find("type = \"pressure\""), 17, "type = \"volume\"");
  dead.replace(dead.find("value = 1e-6"), 12, "value = [0, 0, -1e-6]");
  const double follows = probes(run(shop, plate))["u"][2], stays = probes(run(shop, dead, "", "dead"))["u"][2];
  EXPECT_LT(follows, 0);
  EXPECT_NEAR(follows / stays, 1, 1e-7);
}

TEST(Pressure, HasTheDerivativesOfItsEnergy) {
  const Workshop shop;
  shop.write("problem.toml", tube);
  const Outcome o = shop.karcher("check problem.toml --derivatives");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
}

void expect_refused(const std::string& problem, const std::string& sentence) {
  const std::string said = refusal(problem);
  EXPECT_NE(said.find(sentence), std::string::npos) << said;
}
void expect_taken(const std::string& problem, const std::string& arguments = "") {
  const Workshop shop;
  shop.write("problem.toml", problem);
  const Outcome o = shop.karcher("check problem.toml " + arguments);
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.out.find("no potential"), std::string::npos) << o.out;
}

TEST(Pressure, RefusesRimsThatCanSweepArea) {
  const std::string plate = shell(square, "1");
  expect_refused(plate, "problem.toml:19:1: loads.0: the pressure on \"all\" has no potential: its rim can move at (");
  std::string three = plate;
  for (const char* side : {"left", "right", "bottom"}) three += hold(side, "support = \"clamped\"");
  expect_refused(three, "its rim can move at (0.25, 1, 0). The surface must be closed, or its rim clamped, or held in planes normal to the axes");
  expect_taken(three + hold("top", "support = \"pinned\""));
  // A rim that slides in a plane, at any load.
  const auto slides = [](const std::string& z) { return "field = \"m\"\nvalue = [\"free\", \"free\", \"" + z + "\"]"; };
  expect_taken(plate + hold("boundary", slides("t")));
  for (const char* z : {"x*sin(pi*t)", "0.1*x"}) expect_refused(plate + hold("boundary", slides(z)), "has no potential");
  // Two planes of symmetry may meet, but where neither x nor y is held all axes move.
  const std::string corner = plate + hold("left", "symmetry = \"x\"") + hold("bottom", "symmetry = \"y\"");
  expect_refused(corner, "has no potential");
  expect_taken(corner + hold("right", "support = \"pinned\"") + hold("top", "support = \"pinned\""));
  // A support that is released frees the rim.
  expect_refused(plate + hold("boundary", "support = \"clamped\"\nto = 0.5"), "has no potential");
}

TEST(Pressure, TakesARimThatCanMoveIfItIsForcedAndSaysSo) {
  const Workshop shop;
  shop.write("problem.toml", shell(square, "1e-3") + "force = true\n" + hold("left", "support = \"clamped\""));
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("warning: problem.toml:19:1: the pressure on \"all\" has no potential, since its rim can move at ("), std::string::npos)
      << o.out;
  EXPECT_NE(o.out.find("adds the forces value/3 (m - o) x dm/ds along the rim"), std::string::npos) << o.out;
  expect_taken(shell(square, "1") + "force = true\n" + hold("boundary", "support = \"clamped\""));
}

TEST(Pressure, RefusesWhatItDoesNotTake) {
  expect_refused(shell("generate = \"moebius\"\ncells = [8, 1]\n", "1") + hold("boundary", "support = \"clamped\""),
                 "needs a surface with two sides");
  expect_refused(shell(square, "\"1 + x\""), "loads.0.value must be the same everywhere: an expression of t and parameters, without x, y and z.");
  expect_refused(shell(square, "[0, 0, 1]"), "loads.0.value");
  expect_refused(shell(square, "1") + "on = \"left\"\n", "A pressure works on surfaces of a deformation in R3");
  expect_refused(shell(square, "1") + "on = \"corner\"\n[regions.corner]\ndim = 0\nwhere = \"x + y < 0.1\"\n",
                 "pressure is an integral over a region of dimension 1 or 2");
}

TEST(Pressure, OfAPlaneBodyNeedsEndsThatAreHeld) {
  const std::string body = R"toml([mesh]
generate = "rectangle"
cells = [2, 2]
[fields.m]
manifold = "R2"
[[energies]]
type = "harmonic"
field = "m"
[[loads]]
type = "pressure"
field = "m"
on = "top"
value = 0.1
)toml";
  expect_refused(body, "loads.0: the pressure on \"top\" has no potential: its end can move at (");
  const auto held = [](const char* side, const char* value) { return hold(side, std::string("field = \"m\"\nvalue = ") + value); };
  expect_taken(body + held("left", "[0, \"free\"]") + held("right", "[\"2*t\", \"free\"]"), "--derivatives");
  expect_taken(body + held("left", "[0, \"free\"]") + held("right", "[\"free\", 0]"));
  expect_refused(body + held("left", "[0, \"free\"]"), "its end can move at (1, 1, 0)");
}

}  // namespace
}  // namespace karcher::app
