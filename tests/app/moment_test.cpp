// Moments through the program.

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

json probe(const json& summary, const std::string& name) { return summary["load_steps"].back()["probes"][name]; }

const std::string cubic_fields = R"toml([fields.m]
manifold = "R3"
order = 3
[fields.Q]
manifold = "SO3"
order = 3
)toml";

/// A rod along z of length 10, clamped below, that a couple at its end bends about x.
const std::string rod = R"toml([parameters]
turn = "2.5*pi"
[mesh]
generate = "interval"
axis = "z"
length = 10
cells = [20]
[regions.tip]
near = [0, 0, 10]
)toml" + cubic_fields + R"toml([[energies]]
type = "cosserat-rod"
deformation = "m"
rotation = "Q"
A = [1e3, 1e3, 1e3]
K = [2, 20, 20]
[[dirichlet]]
on = "front"
support = "clamped"
[continuation]
steps = 5
[[probes]]
name = "tip"
field = "m"
at = [0, 0, 10]
[[loads]]
type = "moment"
field = "Q"
on = "tip"
value = ["2*turn/10*t", 0, 0]
)toml";
const std::string free_about_x = "[[dirichlet]]\nfield = \"Q\"\non = \"tip\"\nvalue = {axis-free = \"e1\"}\n";

TEST(Moment, BendsARodIntoMoreThanACircle) {
  const Workshop shop;
  const json s = run(shop, rod + free_about_x);
  const double angle = 2.5 * std::numbers::pi, curvature = angle / 10;  // M = K kappa
  EXPECT_NEAR(probe(s, "tip")[1].get<double>(), -(1 - std::cos(angle)) / curvature, 2e-3);
  EXPECT_NEAR(probe(s, "tip")[2].get<double>(), std::sin(angle) / curvature, 1e-3);
  EXPECT_NEAR(s["energies"]["cosserat-rod"].get<double>(), 10 * curvature * curvature, 1e-3);
  EXPECT_NEAR(s["energies"]["moment-load"].get<double>(), -2 * curvature * angle, 1e-3);
  EXPECT_EQ(s["load_steps"].back()["negative_eigenvalues"], 0);
  EXPECT_EQ(s["warnings"].size(), 0u) << s["warnings"];
}

/// A strip of length 10 and width 2 that a moment per length bends about -y or y.
const std::string strip = R"toml([mesh]
generate = "rectangle"
size = [10, 2]
cells = [12, 1]
shape = "quadrilateral"
)toml" + cubic_fields + R"toml([[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.1
young = 1.2e5
poisson = 0
mu_c = 6e4
L_c = 1e-4
[[dirichlet]]
on = "left"
support = "clamped"
[[dirichlet]]
field = "Q"
on = "right"
value = {axis-free = "e2"}
[[loads]]
type = "moment"
field = "Q"
on = "right"
value = [0, "-10*pi/10*t", 0]
[continuation]
steps = 3
[[probes]]
name = "tip"
field = "m"
at = [10, 1, 0]
)toml";

TEST(Moment, BendsAStripIntoAHalfCircleOnAnyNumberOfRanks) {
  const Workshop shop;
  for (const std::string ranks : {"1", "2"}) {
    const json s = run(shop, strip, "-n " + ranks);
    const double curvature = std::numbers::pi / 10;  // M = E h^3/12 kappa = 10 kappa
    EXPECT_NEAR(probe(s, "tip")[0].get<double>(), 0, 1e-3) << ranks;
    EXPECT_NEAR(probe(s, "tip")[2].get<double>(), 2 / curvature, 1e-3) << ranks;
    EXPECT_NEAR(s["energies"]["moment-load"].get<double>(), -10 * curvature * std::numbers::pi * 2, 2e-3) << ranks;
  }
}

TEST(Moment, HasTheDerivativesOfItsEnergy) {
  const Workshop shop;
  shop.write("problem.toml", rod + free_about_x);
  const Outcome o = shop.karcher("check problem.toml --derivatives");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
}

TEST(Moment, RefusesRotationsThatTurnAboutSeveralAxes) {
  const auto expect = [](const std::string& problem, const std::string& sentence) {
    const std::string said = refusal(problem);
    EXPECT_NE(said.find(sentence), std::string::npos) << said;
  };
  expect(
      rod,
      "problem.toml:31:1: loads.0: a moment has a potential only where the rotation turns about one axis, the same in all load steps; \"Q\" can turn "
      "about several at (0, 0, 10). Leave one axis free there (under [[dirichlet]], value = {axis-free = \"e3\"}), or prescribe the rotation "
      "instead");
  expect(rod + free_about_x + "to = 0.5\n", "can turn about several at (0, 0, 10)");
  std::string changes = free_about_x + "from = 0.5\n";
  changes.replace(changes.find("e1"), 2, "e2");
  expect(rod + free_about_x + "to = 0.5\n" + changes, "can turn about others at (0, 0, 10)");
  std::string of_m = rod;
  of_m.replace(of_m.find("field = \"Q\"\non = \"tip\""), 11, "field = \"m\"");
  expect(of_m, "loads.0.field of moment takes a field with values in SO3");
}

}  // namespace
}  // namespace karcher::app
