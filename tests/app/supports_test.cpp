// Rigid motions that nothing holds, parts that are not connected, nodes at one place: what check and run say of them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program_runner.hpp"

namespace karcher::app {
namespace {

using testing::Outcome;
using testing::Workshop;

const std::string plate = R"toml(
[mesh]
generate = "rectangle"
size = [2, 1]
cells = [4, 2]
shape = "quadrilateral"
[regions.a]
dim = 0
where = "x < 1e-9 && y < 1e-9"
[regions.b]
dim = 0
where = "x > 2 - 1e-9 && y < 1e-9"
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 2
initial = [0.3, -0.2, 0.5]
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.05
mu = 1
lambda = 1
mu_c = 1
L_c = 1e-3
[[loads]]
type = "volume"
field = "m"
value = [0, 0, "2*t"]
)toml";

std::string fix(const std::string& field, const std::string& on, const std::string& value = "\"initial\"") {
  return "[[dirichlet]]\nfield = \"" + field + "\"\non = \"" + on + "\"\nvalue = " + value + "\n";
}

/// The warnings of check; those of run, on one rank and on two, must be the same.
std::string warnings(const std::string& problem, bool run = false) {
  const Workshop shop;
  shop.write("plate.toml", problem);
  const auto of = [](const std::string& text) {
    std::string found;
    for (std::size_t at = text.find("warning: "); at != std::string::npos; at = text.find("warning: ", at + 1))
      found += text.substr(at, text.find('\n', at) + 1 - at);
    return found;
  };
  const Outcome o = shop.karcher("check plate.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  const std::string checked = of(o.out);
  if (run) {
    for (const std::string ranks : {"", " -n 2"})
      EXPECT_EQ(of(shop.karcher("run plate.toml --set solver.max_iterations=1" + ranks).err), checked) << ranks;
  }
  return checked;
}

TEST(Supports, AHeldBodyIsNotWarnedOf) {
  EXPECT_EQ(warnings(plate + fix("m", "left") + fix("Q", "left")), "");
  EXPECT_EQ(warnings(plate + fix("m", "left") + fix("m", "bottom", "[\"free\", \"free\", 0]")), "");
  // One place and the rotation there are enough.
  EXPECT_EQ(warnings(plate + fix("m", "a") + fix("Q", "a")), "");
  // A spring holds, too.
  EXPECT_EQ(warnings(plate + "[[energies]]\ntype = \"l2-distance\"\nfield = \"m\"\ntarget = [\"x\", \"y\", \"z\"]\n"), "");
}

TEST(Supports, EveryMotionThatNothingHoldsIsNamed) {
  const std::string nothing = "nothing holds the field \"m\" completely: the body can ", push = ", and the loads at t = 1 push it that way.";
  const auto expect = [&](const std::string& supports, const std::string& motions, bool pushed, const std::string& file = plate) {
    const std::string text = warnings(file + supports, supports.empty());
    EXPECT_NE(text.find(nothing + motions + (pushed ? push : ".")), std::string::npos) << motions << "\n" << text;
    EXPECT_EQ(text.find("warning: ", 1), std::string::npos) << text;
  };
  expect("", "move and turn freely", true);
  // The plate swings about the line between two corners, and its weight swings it.
  expect(fix("m", "a") + fix("m", "b", "[\"free\", \"initial\", \"initial\"]"), "turn about the axis through (1, 0, 0) along x", true);
  expect(fix("m", "a") + fix("m", "b", "[\"free\", \"initial\", \"initial\"]"), "turn about the axis through (1, 0, 0) along x", false,
         plate + "[[loads]]\ntype = \"volume\"\nfield = \"m\"\nvalue = [0, 0, \"-2*t\"]\n");
  expect(fix("m", "left"), "turn about the axis through (0, 0.5, 0) along y", true);
  expect(fix("m", "a"), "turn about every axis through (0, 0, 0)", true);
  expect(fix("Q", "a"), "move in all directions", true);
  expect(fix("m", "left", "[0, \"free\", \"free\"]") + fix("Q", "left"), "move in all directions perpendicular to x", true);
  expect(fix("m", "left", "[0, \"free\", 0]") + fix("Q", "left"), "move along y", false);
  expect(fix("m", "left", "[0, \"free\", 0]"), "move along y and turn about the axis through (0, 0.5, 0) along y", true);
  // The director d_3 = Q e_3 is held; about it, and only about it, the body may turn. Q e_3 of a turn about e_2 by 0.6435: (0.6, 0, 0.8).
  std::string tilted = plate;
  tilted.replace(tilted.find("[0.3, -0.2, 0.5]"), 16, "[0, 0.643501108793, 0]");
  expect(fix("m", "a") + fix("Q", "a", "{axis-free = \"e3\"}"), "turn about the axis through (0.36, 0, 0.48) along (0.6, 0, 0.8)", true, tilted);
}

TEST(Supports, PartsAndNodesAtOnePlaceAreCounted) {
  // Two squares side by side, the nodes of the edge between them double; the left one is clamped.
  const Workshop shop;
  shop.write("seam.msh",
             "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1 1 0\n$EndNodes\n"
             "$Elements\n2\n1 3 2 1 1 1 2 3 4\n2 3 2 1 1 5 6 7 8\n$EndElements\n");
  std::string problem = plate.substr(0, plate.find("[regions.b]")) + plate.substr(plate.find("[fields.m]"));
  problem.replace(problem.find("[mesh]"), problem.find("[regions.a]") - problem.find("[mesh]"), "[mesh]\nfile = \"seam.msh\"\n");
  problem.replace(problem.find("dim = 0"), 39, "dim = 1\nwhere = \"x < 1e-9\"\n");
  shop.write("plate.toml", problem + fix("m", "a") + fix("Q", "a"));
  const Outcome o = shop.karcher("check plate.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  for (const char* sentence : {"warning: the mesh is of 2 parts that are not connected: 1 cell around (0.5, 0.5, 0), 1 cell around (1.5, 0.5, 0).\n",
                               "warning: 2 pairs of nodes of the mesh lie at the same place, the first at (1, 0, 0): fields are not joined there",
                               "nothing holds the field \"m\" completely: the part of 1 cell around (1.5, 0.5, 0) can move and turn freely, and the "
                               "loads at t = 1 push it that "
                               "way.\n"})
    EXPECT_NE(o.out.find(sentence), std::string::npos) << sentence << o.out;
}

TEST(Supports, ThatAreMissingEndTheRunWhereTheBodyWouldFlyAwayAndLeaveItThere) {
  const Workshop shop;
  shop.write("plate.toml", plate + "[[probes]]\nname = \"tip\"\nfield = \"m\"\nat = [2, 1, 0]\nquantity = \"displacement\"\n");
  const Outcome o = shop.karcher("run plate.toml -q");
  EXPECT_EQ(o.code, 1) << o.err;
  const auto summary = nlohmann::json::parse(testing::content(shop.directory() / "plate/summary.json"));
  const std::string reason = summary["reason"];
  EXPECT_NE(reason.find("of its diameters, so it stays where it was: a support is missing"), std::string::npos) << reason;
  EXPECT_LT(summary["load_steps"][0]["iterations"].get<int>(), 30);
  EXPECT_EQ(summary["load_steps"][0]["probes"]["tip"], std::vector<double>({0, 0, 0}));
}

TEST(Supports, ALoadOfAnySizeIsFollowedByALinearBody) {
  const Workshop shop;
  shop.write("string.toml", R"toml(
[mesh]
generate = "interval"
cells = 4
[fields.u]
manifold = "R1"
initial = 0
[[energies]]
type = "harmonic"
field = "u"
[[loads]]
type = "volume"
field = "u"
value = "1e80*t"
[[dirichlet]]
field = "u"
on = "boundary"
value = 0
)toml");
  const Outcome o = shop.karcher("run string.toml -q");
  EXPECT_EQ(o.code, 0) << o.err;
  const auto summary = nlohmann::json::parse(testing::content(shop.directory() / "string/summary.json"));
  EXPECT_LT(summary["load_steps"][0]["iterations"].get<int>(), 30);
}

}  // namespace
}  // namespace karcher::app
