// What a run says of its end: that the start is the answer, and how many eigenvalues are negative or neutral.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program_runner.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

/// A plate of 2 by 1, to which the tests add supports and loads.
const std::string plate = R"toml([mesh]
generate = "rectangle"
lower = [0.0, 0.0]
size = [2.0, 1.0]
cells = [8, 4]
shape = "quadrilateral"
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 2
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.05
young = 1e6
poisson = 0.3
mu_c = 4e5
L_c = 1e-4
b = [1.0, 1.0, 1.0]
[output]
vtu = false
report = false
)toml";
const std::string clamp = R"toml([[dirichlet]]
field = "m"
on = "left"
value = "initial"
[[dirichlet]]
field = "Q"
on = "left"
value = "initial"
)toml";
const std::string pull = R"toml([[loads]]
type = "traction"
field = "m"
on = "right"
value = [0, 0, "2*t"]
[[probes]]
name = "tip"
field = "m"
at = [2.0, 0.5, 0.0]
quantity = "displacement"
)toml";
const std::string hinges = R"toml([regions.a]
dim = 0
where = "x < 1e-9 && y < 1e-9"
[regions.b]
dim = 0
where = "x > 2 - 1e-9 && y < 1e-9"
[[dirichlet]]
field = "m"
on = "a"
value = "initial"
[[dirichlet]]
field = "m"
on = "b"
value = ["free", "initial", "initial"]
)toml";
const std::string waves = " --set 'fields.Q.initial=[0.01, \"0.02*sin(3*x)\", 0]'";

json last_step(const std::string& problem, const std::string& arguments, int code = 0) {
  const Workshop shop;
  shop.write("plate.toml", problem);
  const Outcome o = shop.karcher("run plate.toml -q " + arguments);
  EXPECT_EQ(o.code, code) << o.out << o.err;
  return json::parse(content(shop.directory() / "plate/summary.json"))["load_steps"].back();
}

TEST(Certificate, OfAFreePlateHasSixNeutralEigenvaluesWhateverItsThicknessAndTheRanks) {
  for (const std::string thin : {"", " --set energies.0.thickness=0.001 --set energies.0.L_c=0.1"}) {
    for (const std::string& start : {std::string(), std::string(" -n 2"), std::string(" -n 3"), waves}) {
      const json step = last_step(plate, start + thin);
      EXPECT_EQ(step["status"], "converged");
      EXPECT_EQ(step["negative_eigenvalues"], 0) << start << thin;
      EXPECT_EQ(step["neutral_eigenvalues"], 6) << start << thin;
    }
  }
}

TEST(Certificate, OfAPlateThatCanSwingHasOneNeutralEigenvalue) {
  const json step = last_step(plate + hinges, waves);
  EXPECT_EQ(step["negative_eigenvalues"], 0);
  EXPECT_EQ(step["neutral_eigenvalues"], 1);
}

TEST(Certificate, OfTwoFreeHalvesHasTwelveNeutralEigenvalues) {
  // Squares of 2 x 2 cells that touch along x = 1, where the nodes are double.
  std::string nodes, cells;
  for (int half = 0; half < 2; ++half)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const int n = 9 * half + 3 * j + i + 1;
        nodes += fmt::format("{} {} {} 0\n", n, half + 0.5 * i, 0.5 * j);
        if (i < 2 && j < 2) cells += fmt::format("{} 3 0 {} {} {} {}\n", n, n, n + 1, n + 4, n + 3);
      }
  const std::string mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n18\n" + nodes + "$EndNodes\n$Elements\n8\n" + cells + "$EndElements\n";
  const std::string halves = "[mesh]\nfile = \"halves.msh\"\n" + plate.substr(plate.find("[fields.m]"));
  for (const std::string start : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("halves.msh", mesh);
    shop.write("halves.toml", halves);
    const Outcome o = shop.karcher("run halves.toml -q" + start);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    const json step = json::parse(content(shop.directory() / "halves/summary.json"))["load_steps"].back();
    EXPECT_EQ(step["negative_eigenvalues"], 0);
    EXPECT_EQ(step["neutral_eigenvalues"], 12);
  }
}

TEST(Certificate, OfAPlateWithoutLoadNeedsNoIteration) {
  for (const std::string lower : {"", " --set mesh.lower=[1000,1000]"}) {
    const json step = last_step(plate + clamp, lower);
    EXPECT_EQ(step["status"], "converged");
    EXPECT_EQ(step["iterations"], 0) << step["reason"];
    EXPECT_EQ(step["negative_eigenvalues"], 0);
    EXPECT_EQ(step["neutral_eigenvalues"], 0);
  }
}

TEST(Certificate, APlateFarFromTheOriginBendsAsFarAsOneThatIsThere) {
  const json near = last_step(plate + clamp + pull, ""),
             far = last_step(plate + clamp + pull, "--set mesh.lower=[1000,1000] --set probes.0.at=[1002,1000.5,0]");
  EXPECT_NEAR(near["probes"]["tip"][2].get<double>(), 0.456329154, 1e-9);
  EXPECT_NEAR(far["probes"]["tip"][2].get<double>(), 0.456329154, 1e-8);
  EXPECT_NEAR(near["iterations"].get<int>(), far["iterations"].get<int>(), 1);
}

}  // namespace
}  // namespace karcher::testing
