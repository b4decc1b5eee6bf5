// What makes a result doubtful although it is a minimum of what was computed: values far apart, large strains, jumps.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "problems.hpp"

namespace karcher::app {
namespace {

using nlohmann::json;
using testing::content;
using testing::Outcome;
using testing::strip;
using testing::summary;
using testing::Workshop;

const std::string line = R"toml(
[mesh]
generate = "interval"
cells = 4
[fields.u]
manifold = "S2"
order = 1
initial = ["sin(3.141592653589793*x)*turn", 0, "x < 0.6 ? 1 : -1"]
[[energies]]
type = "harmonic"
field = "u"
[[dirichlet]]
field = "u"
on = "boundary"
value = "initial"
[parameters]
turn = 0
)toml";

/// A plane map of the unit disc's surroundings: the whole sphere is covered `turns` times.
const std::string map = R"toml(
[parameters]
turns = 1
[mesh]
generate = "rectangle"
lower = [-1, -1]
size = [2, 2]
cells = [12, 12]
[fields.n]
manifold = "S2"
order = 2
initial = ["sin(f)*cos(turns*p)", "sin(f)*sin(turns*p)", "-cos(f)"]
[[energies]]
type = "harmonic"
field = "n"
[[dirichlet]]
field = "n"
on = "boundary"
value = "initial"
[solver]
max_iterations = 1
)toml";

TEST(Doubt, OppositeValuesInACellAreNoMinimumOnAnyNumberOfRanks) {
  for (const char* ranks : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("line.toml", line);
    const Outcome o = shop.karcher(std::string("run line.toml") + ranks);
    EXPECT_EQ(o.code, 0) << o.err;
    const std::string cell = "the values of the field \"u\" differ by 180 of at most 180 degrees within the cell around (0.625, 0, 0)";
    EXPECT_NE(o.err.find("initially " + cell), std::string::npos) << o.err;
    EXPECT_NE(o.out.find("warning: " + cell), std::string::npos) << o.out;
    const json step = summary(shop, "line")["load_steps"][0];
    EXPECT_EQ(step["reason"].get<std::string>().find("minimum;"), std::string::npos);
    EXPECT_NE(step["reason"].get<std::string>().find("whether the point is a minimum cannot be told: " + cell), std::string::npos) << step;
    EXPECT_EQ(step["warnings"].size(), 1u);
    EXPECT_EQ(summary(shop, "line")["warnings"].size(), 1u);
  }
}

TEST(Doubt, ALineThatTurnsHalfwayRoundSlowlyIsAMinimumWithoutAWarning) {
  const Workshop shop;
  shop.write("line.toml", line);
  const Outcome o = shop.karcher("run line.toml --set parameters.turn=1 --set 'fields.u.initial.2=\"cos(3.141592653589793*x)\"'");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.err, "");
  const json step = summary(shop, "line")["load_steps"][0];
  EXPECT_NEAR(step["energy"].get<double>(), 0.5 * std::numbers::pi * std::numbers::pi, 0.011);
  EXPECT_TRUE(step["warnings"].empty());
}

TEST(Doubt, AUnitErrorIsToldByTheLargestStrainAndItsPlace) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome good = shop.karcher("run strip.toml --set output.report=false");
  EXPECT_EQ(good.out.find("made for strains"), std::string::npos) << good.out;
  const json small = summary(shop, "strip")["load_steps"].back()["largest_strain"];
  EXPECT_EQ(small["energy"], "cosserat-shell");
  EXPECT_GT(small["value"].get<double>(), 1e-6);
  EXPECT_LT(small["value"].get<double>(), 0.05);
  EXPECT_LT(small["place"][0].get<double>(), 0.6);  // a cantilever bends most where it is clamped

  const Outcome wrong = shop.karcher("run strip.toml --set output.report=false --set parameters.load=0.1");
  EXPECT_NE(wrong.out.find("warning: cosserat-shell is made for strains up to about 0.2, but around ("), std::string::npos) << wrong.out;
  const json large = summary(shop, "strip")["load_steps"].back();
  EXPECT_GT(large["largest_strain"]["value"].get<double>(), 0.2);
  EXPECT_EQ(large["warnings"].back().get<std::string>().substr(0, 45), "cosserat-shell is made for strains up to abou");
}

TEST(Doubt, TheLargestStrainIsTheSameOnTwoRanks) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  json strains[2];
  for (int ranks : {1, 2}) {
    EXPECT_EQ(shop.karcher("run strip.toml --set output.report=false -n " + std::to_string(ranks)).code, 0);
    strains[ranks - 1] = summary(shop, "strip")["load_steps"].back()["largest_strain"];
  }
  EXPECT_NEAR(strains[0]["value"].get<double>(), strains[1]["value"].get<double>(), 1e-8 * strains[0]["value"].get<double>());
  EXPECT_NEAR(strains[0]["place"][0].get<double>(), strains[1]["place"][0].get<double>(), 1e-12);
}

TEST(Doubt, TheTopologicalChargeOfAMapThatCoversTheSphereIsAWholeNumber) {
  const Workshop shop;
  // f = pi at the middle of the square falls to 0 at r = 1: every direction is met once.
  const std::string f = "min(1, sqrt(x^2 + y^2))";
  std::string text = map;
  for (std::size_t at; (at = text.find("(f)")) != std::string::npos;) text.replace(at, 3, "(3.141592653589793*(1 - " + f + "))");
  for (std::size_t at; (at = text.find("*p)")) != std::string::npos;) text.replace(at, 3, "*atan2(y, x + 1e-300))");
  shop.write("map.toml", text);
  for (const int turns : {1, -1, 2}) {
    const Outcome o = shop.karcher("run map.toml --set output.report=false --set parameters.turns=" + std::to_string(turns));
    ASSERT_LE(o.code, 1) << o.err;
    const double charge = summary(shop, "map")["load_steps"].back()["topological_charge"]["n"];
    EXPECT_NEAR(std::abs(charge), std::abs(turns), 1e-9) << turns;
    EXPECT_EQ(charge > 0, turns > 0);
  }
}

}  // namespace
}  // namespace karcher::app
