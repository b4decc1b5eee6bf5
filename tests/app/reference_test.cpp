// A deformation whose order is not the mesh's: the stress-free configuration is what it can take.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program_runner.hpp"

namespace karcher::app {
namespace {

using nlohmann::json;
using testing::content;
using testing::Outcome;
using testing::Workshop;

/// A quarter of a cylinder, clamped below, under its weight.
const std::string roof = R"toml(
[mesh]
generate = "cylinder"
angle = 1.5
height = 1
cells = [4, 2]
order = 2
[fields.m]
manifold = "R3"
[fields.Q]
manifold = "SO3"
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
value = ["-1e-6*t", 0, 0]
[[dirichlet]]
field = "m"
on = "bottom"
value = "initial"
[[dirichlet]]
field = "Q"
on = "bottom"
value = "initial"
[[probes]]
name = "rim"
field = "m"
at = [1, 0, 1]
quantity = "displacement"
)toml";

double energy(const Workshop& shop, const std::string& options) {
  const Outcome o = shop.karcher("evaluate roof.toml --json" + options);
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.err, "") << options;
  return json::parse(o.out)["energies"]["cosserat-shell"].get<double>();
}

TEST(Reference, IsStressFreeForEveryOrderOfMeshAndDeformation) {
  const Workshop shop;
  shop.write("roof.toml", roof);
  for (const int mesh : {1, 2, 3})
    for (const int deformation : {1, 2, 3})
      for (const int rotation : {1, 3}) {
        const std::string options = " --set mesh.order=" + std::to_string(mesh) + " --set fields.m.order=" + std::to_string(deformation) +
                                    " --set fields.Q.order=" + std::to_string(rotation);
        // A strain of 1 % has the energy 7e-6.
        EXPECT_LT(std::abs(energy(shop, options)), 1e-28) << options;
        EXPECT_LT(std::abs(energy(shop, options + " --set mesh.shape=quadrilateral")), 1e-28) << options;
      }
}

TEST(Reference, TheOrderOfAFieldIsThatOfTheMeshUnlessItIsGiven) {
  const Workshop shop;
  shop.write("roof.toml", roof);
  for (const int order : {1, 2, 3}) {
    const std::string mesh = " --set mesh.order=" + std::to_string(order);
    const Outcome o = shop.karcher("check roof.toml" + mesh);
    EXPECT_NE(o.out.find("R3 of order " + std::to_string(order)), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("energy at the reference: "), std::string::npos) << o.out;
    ASSERT_EQ(shop.karcher("run roof.toml -q -o " + std::to_string(order) + mesh).code, 0);
    const std::string resolved = content(shop.directory() / std::to_string(order) / "problem.resolved.toml");
    EXPECT_NE(resolved.find("[fields.m]\nmanifold = \"R3\"\norder = " + std::to_string(order)), std::string::npos) << resolved;
  }
  // Without an order the roof moved up, against its load, from a reference of order 2 that it could not take.
  for (const std::string orders : {"", " --set fields.m.order=1", " --set fields.m.order=1 --set fields.Q.order=1"}) {
    ASSERT_EQ(shop.karcher("run roof.toml -q -o rim" + orders).code, 0);
    const json rim = json::parse(content(shop.directory() / "rim/summary.json"))["load_steps"][0]["probes"]["rim"];
    EXPECT_LT(rim[0].get<double>(), -1e-7) << orders;
    EXPECT_GT(rim[0].get<double>(), -1e-3) << orders;
  }
}

TEST(Reference, OfAMeshFileTheOrderIsThatOfItsCells) {
  const Workshop shop;
  shop.write("parabola.msh",
             "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0.5\n3 0 1 0\n4 0.5 0 0.125\n5 0.5 0.5 0.125\n6 0 0.5 0\n$EndNodes\n"
             "$Elements\n1\n1 9 2 1 1 1 2 3 4 5 6\n$EndElements\n");
  shop.write("map.toml", "[mesh]\nfile = \"parabola.msh\"\n[fields.u]\nmanifold = \"R1\"\n[[energies]]\ntype = \"harmonic\"\nfield = \"u\"\n");
  const Outcome o = shop.karcher("check map.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("R1 of order 2 on all: 6 nodes"), std::string::npos) << o.out;
}

TEST(Reference, AnOrderThatTheDeformationCannotTakeIsWarnedOf) {
  const Workshop shop;
  shop.write("roof.toml", roof + "[reference]\nposition = [\"x\", \"y\", \"z\"]\n");
  EXPECT_LT(energy(shop, " --set fields.m.order=1"), 1e-28);
  for (const std::string verb : {"check", "run", "evaluate"}) {
    const Outcome o = shop.karcher(verb + " roof.toml --set fields.m.order=1 --set reference.order=2");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE((verb == "check" ? o.out : o.err).find("the field \"m\" of order 1 cannot take the reference of order 2; give both the same order"),
              std::string::npos)
        << o.out << o.err;
  }
}

}  // namespace
}  // namespace karcher::app
