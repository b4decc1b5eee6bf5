// What `karcher check` measures: derivatives and objectivity, term by term.

#include <gtest/gtest.h>

#include <string>

#include "problems.hpp"

namespace karcher::testing {
namespace {

Outcome check(const std::string& problem, const std::string& arguments) {
  const Workshop shop;
  shop.write("problem.toml", problem);
  return shop.karcher("check problem.toml " + arguments);
}
bool has(const Outcome& o, const std::string& text) { return o.out.find(text) != std::string::npos; }

/// A deformation and a director on a square, with a density of one's own.
std::string own(const std::string& density, const std::string& rest = "") {
  return R"toml([mesh]
generate = "rectangle"
cells = [2, 2]
[fields.m]
manifold = "R3"
order = 2
[fields.d]
manifold = "S2"
initial = [0, 0, 1]
[[energies]]
type = "expression"
fields = ["m", "d"]
)toml" + rest +
         "density = \"" + density + "\"\n";
}
const std::string shear = "(m[0].x*d[0] + m[1].x*d[1] + m[2].x*d[2])^2 + (m[0].x^2 + m[1].x^2 + m[2].x^2 - 1)^2";

TEST(CheckObjectivity, HoldsForShellsAndLeavesTheirLoadsOut) {
  const Outcome o = check(strip, "--objectivity");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_TRUE(has(o, "no energy changes")) << o.out;
  EXPECT_TRUE(has(o, "not tested: a load")) << o.out;
}

TEST(CheckObjectivity, HoldsInThePlane) {
  const Outcome o = check(
      "[mesh]\ngenerate = \"rectangle\"\n[fields.m]\nmanifold = \"R2\"\n[[energies]]\ntype = \"hyperelastic\"\ndeformation = \"m\"\n"
      "material = \"neo-hooke\"\nmu = 1\nlambda = 2\n",
      "--objectivity");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_TRUE(has(o, "no energy changes")) << o.out;
}

TEST(CheckObjectivity, TellsAFormulaThatARigidMotionChanges) {
  const std::string moves = "moves = \"m\"\n";
  const Outcome right = check(own(shear, moves), "--objectivity");
  EXPECT_EQ(right.code, 0) << right.out << right.err;
  EXPECT_TRUE(has(right, "no energy changes")) << right.out;

  for (const std::string wrong :
       {"(m[0].x - 1)^2 + m[1].x^2 + d[0]^2", "(m[0].x*d[0] + m[1].x*d[1] - m[2].x*d[2])^2", "m[2]*(d[0]^2 + d[1]^2 + d[2]^2)"}) {
    const Outcome o = check(own(wrong, moves), "--objectivity");
    EXPECT_EQ(o.code, 1) << wrong << o.out << o.err;
    EXPECT_TRUE(has(o, "a rigid motion changes expression")) << o.out;
  }
}

TEST(CheckObjectivity, SaysWhyItDoesNotTest) {
  const Outcome values = check(own(shear), "--objectivity");
  EXPECT_EQ(values.code, 0);
  EXPECT_TRUE(has(values, "not tested: \"m\" holds neither positions nor rotations; moves = \"m\" says that it does")) << values.out;
  const Outcome map = check(
      "[mesh]\ngenerate = \"rectangle\"\n[fields.u]\nmanifold = \"S2\"\ninitial = [0, 0, 1]\n[[energies]]\ntype = \"harmonic\"\nfield = \"u\"\n",
      "--objectivity");
  EXPECT_TRUE(has(map, "not tested: without positions and rotations")) << map.out;
}

TEST(CheckDerivatives, ListsEveryTermWithItsErrors) {
  const Outcome o = check(strip, "--derivatives");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_TRUE(has(o, "cosserat-shell")) << o.out;
  EXPECT_TRUE(has(o, "traction-load")) << o.out;
  EXPECT_FALSE(has(o, "wrong")) << o.out;
}

TEST(CheckDerivatives, AreOfOneRank) {
  const Workshop shop;
  shop.write("problem.toml", strip);
  for (const std::string what : {"derivatives", "objectivity"}) {
    const Outcome o =
        shop.karcher("check problem.toml --" + what, "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpiexec --oversubscribe -n 2");
    EXPECT_EQ(o.code, 2) << o.out << o.err;
    EXPECT_NE(o.err.find("check --" + what + " runs on one rank."), std::string::npos) << o.err;
  }
}

}  // namespace
}  // namespace karcher::testing
