// Rods through the program: closed forms, a published benchmark, and what is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "problems.hpp"

namespace karcher::app {
namespace {

using nlohmann::json;
using std::numbers::pi;
using testing::refusal;
using testing::run;
using testing::Workshop;

/// A straight rod along z with its directors along the axes, clamped at z = 0; the energy's last keys follow.
const std::string straight = R"toml([parameters]
angle = 4.71238898038469
force = 0.03
n = 8
[mesh]
generate = "interval"
axis = "z"
length = 2
cells = ["n"]
[fields.m]
manifold = "R3"
order = 2
[fields.R]
manifold = "SO3"
order = 2
[[dirichlet]]
field = "m"
on = "front"
value = "initial"
[[dirichlet]]
field = "R"
on = "front"
value = "initial"
[[probes]]
name = "tip"
field = "m"
at = [0, 0, 2]
[[energies]]
type = "cosserat-rod"
deformation = "m"
rotation = "R"
)toml";
const std::string numbers = "A = [80, 90, 100]\nK = [2, 1, 0.7]\n";
const std::string turned_end = "[[dirichlet]]\nfield = \"R\"\non = \"back\"\nvalue = [0, \"angle*t\", 0]\n[continuation]\nsteps = 3\n";
const std::string end_force = "[[loads]]\ntype = \"point\"\nfield = \"m\"\non = \"back\"\nvalue = [\"force*t\", 0, 0]\n";

json last(const json& summary) { return summary["load_steps"].back(); }

TEST(CosseratRod, RollsToACircleByAnEndMoment) {
  // Pure bending: curvature k = angle/L, energy K_2 k^2 L/2, no force; a quarter, a half and three quarters of a circle. (The full one is no minimum here: it twists.)
  const Workshop shop;
  const json s = run(shop, straight + numbers + turned_end, "--set n=16 --set fields.m.order=3 --set fields.R.order=3");
  for (std::size_t step = 1; step <= 3; ++step) {
    const double k = 0.25 * pi * static_cast<double>(step);
    const json tip = s["load_steps"][step - 1]["probes"]["tip"];
    EXPECT_NEAR(tip[0].get<double>(), (1 - std::cos(2 * k)) / k, 1e-6) << step;
    EXPECT_NEAR(tip[1].get<double>(), 0, 1e-9);
    EXPECT_NEAR(tip[2].get<double>(), std::sin(2 * k) / k, 1e-6) << step;
    EXPECT_NEAR(s["load_steps"][step - 1]["energy"].get<double>(), 2 * 0.5 * k * k, 1e-6) << step;
  }
}

TEST(CosseratRod, ConvergesWithTwiceItsOrderInTheEnergy) {
  const Workshop shop;
  const double exact = 0.25 * 2.5 * 2.5;
  for (const std::string rule : {"projection", "geodesic"})
    for (const int order : {1, 2}) {
      const auto error = [&](int n) {
        const std::string orders = " --set fields.m.order=" + std::to_string(order) + " --set fields.R.order=" + std::to_string(order);
        const json s =
            run(shop, straight + numbers + turned_end,
                "--set angle=2.5 --set continuation.steps=1 --set fields.R.interpolation=" + rule + " --set n=" + std::to_string(n) + orders);
        return last(s)["energy"].get<double>() - exact;
      };
      EXPECT_NEAR(std::log2(error(8) / error(16)), 2 * order, 0.2) << rule << order;
    }
}

TEST(CosseratRod, BendsAsTimoshenkosBeamUnderASmallForce) {
  // P L^3/(3 E I_2) + P L/(k_s G A)
  const double force = 1e-7, young = 12, shear = young / 2.6, width = 0.3, height = 0.5;
  const double deflection = force * 8 / (3 * young * std::pow(width, 3) * height / 12) + force * 2 / (0.8 * shear * width * height);
  const Workshop shop;
  const json s =
      run(shop, straight + "section = \"rectangle\"\nyoung = 12\npoisson = 0.3\nwidth = 0.3\nheight = 0.5\nshear_correction = 0.8\n" + end_force,
          "--set n=2 --set fields.m.order=3 --set force=1e-7");
  EXPECT_NEAR(last(s)["probes"]["tip"][0].get<double>() / deflection, 1, 1e-6);
}

/// The arc of 45 degrees of Bathe and Bolourchi, IJNME 14 (1979): radius 100, square section of side 1, E = 1e7, G = 5e6, lateral end force of 600.
const std::string bend = R"toml([mesh]
generate = "interval"
length = 78.53981633974483
cells = [8]
[reference]
position = ["100*sin(x/100)", "100*(1 - cos(x/100))", 0]
[fields.m]
manifold = "R3"
order = 3
[fields.R]
manifold = "SO3"
order = 3
initial = [0, "sin(x/100)", "cos(x/100)", 0, "-cos(x/100)", "sin(x/100)", 1, 0, 0]
[[energies]]
type = "cosserat-rod"
deformation = "m"
rotation = "R"
section = "rectangle"
width = 1
height = 1
young = 1e7
poisson = 0
[[loads]]
type = "point"
field = "m"
on = "right"
value = [0, 0, "600*t"]
[[dirichlet]]
field = "m"
on = "left"
value = "initial"
[[dirichlet]]
field = "R"
on = "left"
value = "initial"
[[probes]]
name = "tip"
field = "m"
at = [78.53981633974483, 0, 0]
[continuation]
steps = 2
)toml";

TEST(CosseratRod, BendsAndTwistsAsTheArcOfBatheAndBolourchi) {
  const Workshop shop;
  for (const std::string rule : {"projection", "geodesic"}) {
    const json s = run(shop, bend, "--set mesh.cells=[32] --set fields.R.interpolation=" + rule);
    EXPECT_EQ(s["warnings"].size(), 0u) << s["warnings"];
    const std::vector<double> tip = last(s)["probes"]["tip"];
    // The same rod solved as an ordinary boundary value problem to ten digits; the paper has 47.2, 15.9, 53.4.
    EXPECT_NEAR(tip[0], 47.1500962403, 1e-5);
    EXPECT_NEAR(tip[1], 15.6846894790, 1e-5);
    EXPECT_NEAR(tip[2], 53.4754779982, 1e-5);
  }
}

TEST(CosseratRod, RestsWithoutLoadsWhereItIsCurved) {
  const Workshop shop;
  shop.write("bend.toml", bend);
  const testing::Outcome o = shop.karcher("evaluate bend.toml --json --set loads.0.value=[0,0,0]");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_LT(std::fabs(json::parse(o.out)["energies"]["cosserat-rod"].get<double>()), 1e-20);
  // A stretch by 1 % has the energy 4e4.
  EXPECT_EQ(shop.karcher("check bend.toml").out.find("warning"), std::string::npos);
}

TEST(CosseratRod, TakesEitherStiffnessesOrASection) {
  const auto expect = [](const std::string& keys, const std::string& sentence) {
    const std::string err = refusal(straight + keys);
    EXPECT_NE(err.find(sentence), std::string::npos) << keys << err;
    EXPECT_EQ(err.find("error: problem.toml:"), 0u) << err;
  };
  expect("A = [1, 1, 1]\n", "energies.0 lacks the key \"K\"");
  expect(numbers + "radius = 1\n", "energies.0.radius goes with section = \"circle\" or \"tube\", not with \"given\"");
  expect(numbers + "section = \"circle\"\nradius = 1\nyoung = 1\npoisson = 0\n", "energies.0.A goes with section = \"given\", not with \"circle\"");
  expect("section = \"rectangle\"\nwidth = 1\nyoung = 1\npoisson = 0\n", "energies.0 lacks the key \"height\"");
  expect("section = \"tube\"\nradius = 1\nwall = 1.5\nyoung = 1\npoisson = 0\n", "wall is 1.5, but the radius of the tube is 1");
}

}  // namespace
}  // namespace karcher::app
