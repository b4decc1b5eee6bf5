// Meshes whose sides are joined by $Periodic.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// The unit square of n x n squares, each cut into two triangles or not, as Gmsh writes it; left and right, bottom and top joined in pairs. `turned` joins two
/// nodes of the right with each other's partners.
std::string square(int n, int version, bool triangles = false, bool turned = false) {
  const auto tag = [&](int i, int j) { return 100 + 3 * (j * (n + 1) + i); };
  std::string nodes, cells, pairs;
  int count = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      if (version == 2) nodes += fmt::format("{} {} {} 0\n", tag(i, j), double(i) / n, double(j) / n);
  if (version == 4) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) nodes += fmt::format("{}\n", tag(i, j));
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) nodes += fmt::format("{} {} 0\n", double(i) / n, double(j) / n);
  }
  const auto cell = [&](std::initializer_list<int> corners) {
    cells += version == 2 ? fmt::format("{} {} 2 0 1", ++count, triangles ? 2 : 3) : fmt::format("{}", ++count);
    for (const int c : corners) cells += fmt::format(" {}", c);
    cells += "\n";
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (triangles) {
        cell({tag(i, j), tag(i + 1, j), tag(i + 1, j + 1)});
        cell({tag(i, j), tag(i + 1, j + 1), tag(i, j + 1)});
      } else {
        cell({tag(i, j), tag(i + 1, j), tag(i + 1, j + 1), tag(i, j + 1)});
      }
    }
  const std::string affine = version == 2 ? "Affine 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n" : "16 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n";
  pairs += fmt::format("2\n1 2 4\n{}{}\n", affine, n + 1);
  for (int j = 0; j <= n; ++j) pairs += fmt::format("{} {}\n", tag(n, j), tag(0, turned && (j == 1 || j == 2) ? 3 - j : j));
  pairs += fmt::format("1 3 1\n{}{}\n", version == 2 ? "" : "0\n", n + 1);
  for (int i = 0; i <= n; ++i) pairs += fmt::format("{} {}\n", tag(i, n), tag(i, 0));
  const int all = (n + 1) * (n + 1);
  if (version == 2)
    return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n$Periodic\n{}$EndPeriodic\n",
                       all, nodes, count, cells, pairs);
  return fmt::format(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {} 1 100000\n2 1 0 {}\n{}$EndNodes\n$Elements\n1 {} 1 {}\n2 1 {} {}\n{}$EndElements\n"
      "$Periodic\n{}$EndPeriodic\n",
      all, all, nodes, count, count, triangles ? 2 : 3, count, cells, pairs);
}

/// The unit cube of n x n x n cubes in the format 2.2, whose faces across x and across y are joined.
std::string cube(int n) {
  const auto tag = [&](int i, int j, int k) { return 7 + (k * (n + 1) + j) * (n + 1) + i; };
  std::string nodes, cells, first, second;
  int count = 0;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) nodes += fmt::format("{} {} {} {}\n", tag(i, j, k), double(i) / n, double(j) / n, double(k) / n);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        cells += fmt::format("{} 5 2 0 1", ++count);
        for (const int upper : {k, k + 1})
          cells += fmt::format(" {} {} {} {}", tag(i, j, upper), tag(i + 1, j, upper), tag(i + 1, j + 1, upper), tag(i, j + 1, upper));
        cells += "\n";
      }
  for (int k = 0; k <= n; ++k)
    for (int l = 0; l <= n; ++l) {
      first += fmt::format("{} {}\n", tag(n, l, k), tag(0, l, k));
      second += fmt::format("{} {}\n", tag(l, n, k), tag(l, 0, k));
    }
  const int sides = (n + 1) * (n + 1);
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n$Periodic\n2\n2 2 1\nAffine 1 0 0 1 0 1 0 0 0 0 "
      "1 0 0 "
      "0 0 1\n{}\n{}2 4 3\nAffine 1 0 0 0 0 1 0 1 0 0 1 0 0 0 0 1\n{}\n{}$EndPeriodic\n",
      sides * (n + 1), nodes, count, cells, sides, first, sides, second);
}

/// A map of the square into the circle that winds once around along x; `angle` / 2 pi is where it starts.
std::string winding(const std::string& angle, int order, const std::string& more = "") {
  return fmt::format(R"toml([parameters]
angle = "{}"
[mesh]
file = "square.msh"
[fields.u]
manifold = "S1"
order = {}
interpolation = "geodesic"
initial = ["cos(2*pi*angle)", "sin(2*pi*angle)"]
[[energies]]
type = "harmonic"
field = "u"
[solver]
gradient_tolerance = 1e-12
[output]
report = false
)toml",
                     angle, order) +
         more;
}

// 1/2 int |grad u|^2 of u = (cos 2 pi x, sin 2 pi x) is 2 pi^2; geodesic interpolation has that map exactly.
TEST(Periodic, AMapThatWindsOnceAroundTheSquareHasTheEnergyTwoPiSquared) {
  for (const int version : {2, 4})
    for (const bool triangles : {false, true})
      for (const int order : {1, 2, 3}) {
        const Workshop shop;
        shop.write("square.msh", square(4, version, triangles));
        const json s = run(shop, winding("x", order));
        EXPECT_NEAR(s["energy"].get<double>(), 2 * pi * pi, 1e-12) << version << triangles << order;
        EXPECT_EQ(s["unknowns"], 16 * order * order) << "one node for each pair of copies";
      }
}

TEST(Periodic, ACircleInTheSphereHasThatEnergyToo) {
  const Workshop shop;
  shop.write("square.msh", square(4, 4));
  std::string problem = winding("x", 2);
  problem.replace(problem.find("S1"), 2, "S2");
  problem.replace(problem.find("sin(2*pi*angle)\"]"), 17, "sin(2*pi*angle)\", 0]");
  shop.write("problem.toml", problem);
  const Outcome o = shop.karcher("evaluate problem.toml --json");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NEAR(json::parse(o.out)["energy"].get<double>(), 2 * pi * pi, 1e-12);
}

TEST(Periodic, TheLeastEnergyOfMapsThatWindOnceAroundIsTwoPiSquaredAndZeroWhereTheSidesAreApart) {
  for (const int order : {1, 2}) {
    const Workshop shop;
    shop.write("square.msh", square(4, 4));
    const std::string wavy = winding("x + 0.05*sin(2*pi*x)*cos(2*pi*y) + 0.04*sin(2*pi*y)", order);
    EXPECT_NEAR(run(shop, wavy)["energy"].get<double>(), 2 * pi * pi, 1e-10);
    EXPECT_NEAR(run(shop, wavy, "--set mesh.periodic=false")["energy"].get<double>(), 0, 1e-10) << "an open arc unwinds";
  }
}

TEST(Periodic, OneTwoAndThreeRanksAgree) {
  const Workshop shop;
  shop.write("square.msh", square(5, 2, true));
  const std::string fixed =
      "[regions.corner]\ndim = 0\nwhere = \"x > 1 - 1e-9 && y > 1 - 1e-9\"\n[[dirichlet]]\nfield = \"u\"\non = \"corner\"\nvalue = [1, 0]\n";
  const std::string pulled =
      "[[energies]]\ntype = \"l2-distance\"\nfield = \"u\"\ntarget = [\"cos(2*pi*x + 0.5*sin(2*pi*y))\", \"sin(2*pi*x + 0.5*sin(2*pi*y))\"]\nweight "
      "= 30\n";
  for (const int order : {1, 2, 3}) {
    const json one = run(shop, winding("x", order, fixed + pulled));
    EXPECT_GT(one["energy"].get<double>(), 2 * pi * pi + 0.1);
    for (const std::string ranks : {"-n 2", "-n 3"})
      EXPECT_NEAR(run(shop, winding("x", order, fixed + pulled), ranks)["energy"].get<double>(), one["energy"].get<double>(), 1e-10);
  }
}

TEST(Periodic, ABoxWhoseFacesAreJoinedHasTheEnergyOfTheSquareOnAnyNumberOfRanks) {
  const Workshop shop;
  shop.write("square.msh", cube(3));
  for (const int order : {1, 2, 3}) {
    const std::string wavy = winding("x + 0.03*sin(2*pi*y) + 0.02*z", order);
    const json one = run(shop, wavy);
    EXPECT_NEAR(one["energy"].get<double>(), 2 * pi * pi, 1e-10) << order;
    EXPECT_EQ(one["unknowns"], 9 * order * order * (3 * order + 1)) << "one node for each pair of copies";
    EXPECT_NEAR(run(shop, wavy, "-n 2")["energy"].get<double>(), 2 * pi * pi, 1e-10) << order;
  }
}

TEST(Periodic, RefinedSidesStayJoined) {
  const Workshop shop;
  shop.write("square.msh", square(3, 4, true));
  const json s = run(shop, winding("x", 2), "--set mesh.refine=2");
  EXPECT_NEAR(s["energy"].get<double>(), 2 * pi * pi, 1e-12);
  EXPECT_EQ(s["unknowns"], 24 * 24);
}

TEST(Periodic, FilesShowBothCopies) {
  const Workshop shop;
  shop.write("square.msh", square(4, 4));
  run(shop, winding("x", 2));
  bool found = false;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shop.directory() / "out"))
    if (entry.path().extension() == ".vtu") {
      found = true;
      EXPECT_NE(content(entry.path()).find("NumberOfPoints=\"81\""), std::string::npos) << entry.path();
    }
  EXPECT_TRUE(found);
}

TEST(Periodic, AConditionOnOneSideHoldsOnBothAndTakesItsOwnPlace) {
  const Workshop shop;
  shop.write("square.msh", square(4, 4));
  const auto problem = [](const std::string& where, const std::string& value) {
    return "[mesh]\nfile = \"square.msh\"\n[regions.side]\ndim = 1\nboundary = true\nwhere = \"" + where +
           "\"\n[fields.u]\nmanifold = \"R1\"\n[[energies]]\ntype = \"harmonic\"\nfield = \"u\"\n[[dirichlet]]\nfield = \"u\"\non = \"side\"\nvalue "
           "= [\"" +
           value + "\"]\n[[probes]]\nname = \"u\"\nfield = \"u\"\nat = [0, 0.5, 0]\n[output]\nreport = false\n";
  };
  const json s = run(shop, problem("x > 1 - 1e-9", "7*x"));
  EXPECT_NEAR(s["load_steps"][0]["probes"]["u"].front().get<double>(), 7, 1e-12);
  shop.write("problem.toml", problem("x < 1e-9 || x > 1 - 1e-9", "7*x"));
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("which are one node of the periodic mesh"), std::string::npos) << o.err;
}

TEST(Periodic, WhatDoesNotFitTogetherIsRefused) {
  const Workshop shop;
  const auto says = [&](const std::string& mesh, const std::string& problem, const std::string& text) {
    shop.write("square.msh", mesh);
    shop.write("problem.toml", problem);
    const Outcome o = shop.karcher("check problem.toml");
    EXPECT_EQ(o.code, 2) << text;
    EXPECT_NE(o.err.find(text), std::string::npos) << o.err;
  };
  says(square(4, 4), winding("0.5*x", 1), "the initial values of \"u\" differ at (0, 0, 0) and (1, 0, 0), which are one node of the periodic mesh.");
  says(square(2, 4), winding("x", 1), "section $Periodic: ");
  says(square(2, 2), winding("x", 1), "a periodic mesh needs at least three cells around.");
  says(square(4, 2, false, true), winding("x", 1), "the periodic sides do not match");
  const std::string shell =
      "[mesh]\nfile = \"square.msh\"\n[fields.m]\nmanifold = \"R3\"\n[fields.Q]\nmanifold = \"SO3\"\n[[energies]]\ntype = "
      "\"cosserat-shell\"\ndeformation = "
      "\"m\"\nrotation = \"Q\"\nthickness = 0.1\nmu = 1\nlambda = 1\nmu_c = 1\nL_c = 1e-3\n";
  says(square(4, 4), shell, "the field \"m\" has positions as values, which differ at the two sides of a periodic mesh");
  EXPECT_EQ(shop.karcher("check problem.toml --set mesh.periodic=false").code, 0);
  std::string unknown = square(4, 2);
  unknown.replace(unknown.find("112 100\n"), 8, "9999 100\n");
  says(unknown, winding("x", 1), "it names node 9999, which is not in the file.");
}

}  // namespace
}  // namespace karcher::testing
