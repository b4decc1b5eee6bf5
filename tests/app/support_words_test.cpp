// Supports in a word: clamped, pinned, symmetry, diaphragm.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

std::string shell(const std::string& mesh, const std::string& more) {
  return "[mesh]\ngenerate = \"rectangle\"\nshape = \"quadrilateral\"\n" + mesh + R"toml(
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 2
[output]
report = false
vtu = false
[solver]
gradient_tolerance = 1e-13
)toml" + more;
}

const std::string thin = R"toml(
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.05
young = 1
poisson = 0.3
mu_c = 0.4
L_c = 1e-3
)toml";

std::string support(const std::string& on, const std::string& line) { return "[[dirichlet]]\non = \"" + on + "\"\n" + line + "\n"; }
std::string probe(const std::string& field, const std::string& at, const std::string& quantity) {
  return "[[probes]]\nname = \"" + field + "\"\nfield = \"" + field + "\"\nat = " + at + "\nquantity = \"" + quantity + "\"\n";
}

json run(const std::string& problem, const std::string& arguments = "") { return testing::run(Workshop(), problem, arguments); }

const std::string push = "[[loads]]\ntype = \"volume\"\nfield = \"m\"\nvalue = [0, 0, \"2e-4*t\"]\n";
const std::string small = "size = [2, 1]\ncells = [4, 2]\n";

TEST(SupportWords, AQuarterWithPlanesOfSymmetryIsTheWholePlate) {
  const std::string rim = "[regions.rim]\ndim = 1\nboundary = true\nwhere = \"abs(x) > 2 - 1e-9 || abs(y) > 1 - 1e-9\"\n";
  const std::string there = thin + push + rim + support("rim", "support = \"clamped\"") + probe("m", "[0, 0, 0]", "displacement");
  const json whole = run(shell("lower = [-2, -1]\nsize = [4, 2]\ncells = [8, 4]\n", there));
  const json quarter =
      run(shell("size = [2, 1]\ncells = [4, 2]\n", there + support("left", "symmetry = \"x\"") + support("bottom", "symmetry = \"y\"")));
  const double w = whole["load_steps"][0]["probes"]["m"][2];
  EXPECT_GT(w, 0.04) << "of the order of the thickness: the problem is not linear";
  EXPECT_NEAR(quarter["load_steps"][0]["probes"]["m"][2].get<double>(), w, 1e-9 * w);
  EXPECT_NEAR(4 * quarter["energy"].get<double>(), whole["energy"].get<double>(), 1e-9 * std::abs(whole["energy"].get<double>()));
  // Without the rotations the mirror plane is a hinge.
  const std::string hinge = "value = [\"free\", 0, \"free\"]\nfield = \"m\"";
  const json other = run(shell("size = [2, 1]\ncells = [4, 2]\n", there + support("left", "symmetry = \"x\"") + support("bottom", hinge)));
  EXPECT_GT(std::abs(other["energy"].get<double>() - quarter["energy"].get<double>()), 1e-3 * std::abs(quarter["energy"].get<double>()));
}

TEST(SupportWords, ClampedAndPinnedAreTheConditionsThatTheyStandFor) {
  const std::string initial_m = "field = \"m\"\nvalue = \"initial\"", initial_Q = "field = \"Q\"\nvalue = \"initial\"";
  const auto energy = [&](const std::string& supports) { return run(shell(small, thin + push + supports))["energy"].get<double>(); };
  const double clamped = energy(support("left", "support = \"clamped\"")),
               pinned = energy(support("left", "support = \"pinned\"") + support("right", "support = \"pinned\""));
  EXPECT_EQ(clamped, energy(support("left", initial_m) + support("left", initial_Q)));
  EXPECT_EQ(pinned, energy(support("left", initial_m) + support("right", initial_m)));
  EXPECT_NE(clamped, pinned);
}

TEST(SupportWords, APinnedStripTurnsAboutItsHingesAndAClampedOneDoesNot) {
  for (const std::string word : {"pinned", "clamped"}) {
    const json s = run(shell(small, thin + push + support("left", "support = \"" + word + "\"") + support("right", "support = \"" + word + "\"") +
                                        probe("Q", "[0, 0.5, 0]", "rotation-vector")));
    const double turn = std::abs(s["load_steps"][0]["probes"]["Q"][1].get<double>());
    if (word == "pinned")
      EXPECT_GT(turn, 0.01);
    else
      EXPECT_EQ(turn, 0);
  }
}

// Scordelis and Lo (1964): a roof of radius 25, length 50, half angle 40 degrees on two rigid diaphragms under its weight of 90 for each area. The middle of the
// free edge sinks by 0.3024 in the linear theory of shallow shells and by 0.3006 in that of deep ones (Simo, Fox, Rifai 1989), by 1e-3 of that under 1e-3 of the
// weight.
TEST(SupportWords, TheScordelisLoRoofStandsOnDiaphragms) {
  const std::string roof = R"toml(
[reference]
position = ["25*sin(x)", "y", "25*cos(x)"]
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.25
young = 4.32e8
poisson = 0
mu_c = 2.16e8
L_c = 1e-4
[[loads]]
type = "volume"
field = "m"
value = [0, 0, "-90e-3"]
)toml";
  const std::string mesh = "size = [\"40*pi/180\", 25]\ncells = [8, 8]\n";
  const std::string supports = support("left", "symmetry = \"x\"") + support("bottom", "symmetry = \"y\"") + support("top", "diaphragm = \"y\"");
  const json s =
      run(shell(mesh, roof + supports + probe("m", "[\"40*pi/180\", 0, 0]", "displacement")), "--set fields.m.order=3 --set fields.Q.order=3");
  EXPECT_NEAR(s["load_steps"][0]["probes"]["m"][2].get<double>(), -0.3006e-3, 0.003 * 0.3006e-3);
}

/// A cap of a sphere, or a quarter of it, under its weight, by a Reissner-Mindlin shell.
std::string cap(const std::string& mesh, const std::string& supports) {
  return "[mesh]\ngenerate = \"rectangle\"\nshape = \"quadrilateral\"\n" + mesh + R"toml(
[reference]
position = ["x", "y", "sqrt(16 - x^2 - y^2)"]
[fields.m]
manifold = "R3"
order = 2
[fields.d]
manifold = "S2"
order = 2
[[energies]]
type = "reissner-mindlin"
deformation = "m"
director = "d"
thickness = 0.1
young = 1
poisson = 0.3
[[loads]]
type = "volume"
field = "m"
value = [0, 0, "-1e-4*t"]
[output]
report = false
vtu = false
[solver]
gradient_tolerance = 1e-12
)toml" + supports +
         probe("m", "[0, 0, 0]", "displacement");
}

TEST(SupportWords, DirectorsStayInPlanesOfSymmetry) {
  const std::string rim =
      "[regions.rim]\ndim = 1\nboundary = true\nwhere = \"abs(x) > 2 - 1e-9 || abs(y) > 1 - 1e-9\"\n" + support("rim", "support = \"pinned\"");
  const json whole = run(cap("lower = [-2, -1]\nsize = [4, 2]\ncells = [8, 4]\n", rim));
  const std::string quarter =
      cap("size = [2, 1]\ncells = [4, 2]\n", rim + support("left", "symmetry = \"x\"") + support("bottom", "symmetry = \"y\""));
  const json part = run(quarter);
  const double w = whole["load_steps"][0]["probes"]["m"][2];
  EXPECT_LT(w, -1e-5);
  EXPECT_NEAR(part["load_steps"][0]["probes"]["m"][2].get<double>(), w, 1e-9 * std::fabs(w));
  EXPECT_NEAR(part["energy"].get<double>(), whole["energy"].get<double>() / 4, 1e-9 * std::fabs(whole["energy"].get<double>()));
  EXPECT_TRUE(part["warnings"].empty()) << part["warnings"];

  std::string out_of_plane = quarter;
  out_of_plane.insert(out_of_plane.find("[[energies]]"), "initial = [0.6, 0, 0.8]\n");
  const std::string said = refusal(out_of_plane);
  EXPECT_NE(said.find("the initial value of the field \"d\" must lie in the plane of symmetry, normal to x; at (0, 0, 0) it is (0.6, 0, 0.8)."),
            std::string::npos)
      << said;
  std::string across_z = cap(small, "[regions.foot]\nnear = [2, 1, 0]\n" + support("foot", "field = \"d\"\nsymmetry = \"z\""));
  across_z.insert(across_z.find("[[energies]]"), "initial = [0.6, 0.8, 0]\n");
  const std::string turned = refusal(across_z);
  EXPECT_NE(turned.find("\"d\" cannot be held in a plane normal to z at (2, 1, 0); turn the body"), std::string::npos) << turned;
}

TEST(SupportWords, SolidsHaveSymmetryWithoutRotations) {
  const Workshop shop;
  shop.write("problem.toml", shell(small, thin + support("left", "field = \"m\"\nsymmetry = \"x\"")));
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("135 unknowns, 5 fixed"), std::string::npos) << o.out << "m_x at the 5 nodes of the edge, and nothing of Q";
}

TEST(SupportWords, ThatCannotBeMeantAreRefused) {
  const auto with = [](const std::string& lines, const std::string& on = "left") { return shell(small, thin + support(on, lines)); };
  const auto says = [](const std::string& problem, const std::string& text) {
    const std::string sentence = refusal(problem);
    EXPECT_NE(sentence.find(text), std::string::npos) << sentence;
  };
  says(with("support = \"clampt\""), "dirichlet.0.support cannot be \"clampt\". Did you mean \"clamped\"?");
  says(with("symetry = \"x\""), "Did you mean \"symmetry\"?");
  says(with("field = \"m\"\nvalue = \"curent\""), "dirichlet.0.value cannot be \"curent\". Did you mean \"current\"?");
  says(with("symmetry = \"w\""), "dirichlet.0.symmetry cannot be \"w\"");
  says(with("symmetry = \"x\"\nsupport = \"pinned\""), "both \"support\" and \"symmetry\"");
  says(with(""), "lacks the key \"value\" (or one of support, symmetry, diaphragm)");
  says(with("value = \"initial\""), "lacks the key \"field\"");
  says(with("symmetry = \"y\""), "the region \"left\" lies in no plane normal to y");
  says(with("diaphragm = \"x\"", "top"), "the region \"top\" lies in no plane normal to x");
  says(with("symmetry = \"x\"\nfrom = 0.5"), "a plane of symmetry cannot set in");
  says(with("support = \"pinned\"\nfield = \"Q\""), "a pinned support leaves the field \"Q\" free");
  std::string turned = with("symmetry = \"x\"");
  turned.replace(turned.find("manifold = \"SO3\""), 16, "manifold = \"SO3\"\ninitial = [0.1, 0.2, 0.3]");
  says(turned, "the field \"Q\" can be left free to turn about x alone only where one of the axes of its initial rotation lies along x");
}

TEST(Supports, HaveNamesThatCheckLists) {
  const Workshop shop;
  const std::string named = "[[dirichlet]]\nname = \"wall\"\nfield = \"m\"\non = \"left\"\nvalue = [0, \"free\", \"2*t\"]\nto = 0.5\n";
  const std::string body = "[mesh]\ngenerate = \"rectangle\"\ncells = [2, 1]\n" + soft_shell;
  shop.write("problem.toml", body + named + support("left", "symmetry = \"x\"") + support("right", "support = \"clamped\""));
  const Outcome o = shop.karcher("check problem.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  for (const std::string line :
       {"wall                 m on left: value, free, value, t <= 0.5\n", "left.symmetry        Q on left: turns only about x\n",
        "right.clamped        m on right: initial\n", "right.clamped        Q on right: initial\n"})
    EXPECT_NE(o.out.find(line), std::string::npos) << line << o.out;
  const std::string twice = refusal(body + named + named);
  EXPECT_NE(twice.find("dirichlet.1.name: dirichlet.0 (problem.toml:"), std::string::npos) << twice;
  EXPECT_NE(twice.find("has the name \"wall\", too."), std::string::npos) << twice;
}

}  // namespace
}  // namespace karcher::testing
