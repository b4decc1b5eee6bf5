// The program as a user meets it: results, resolved problems, load steps, ranks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/judge.hpp"
#include "karcher/io/directory_lock.hpp"
#include "karcher/version.hpp"
#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

TEST(Run, LeavesEverythingThatResultsPromise) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("run strip.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  for (const char* file : {"strip/summary.json", "strip/iterations.csv", "strip/solution.pvd", "strip/solution_0000.vtu", "strip/solution_0001.vtu",
                           "strip/solution_0002.vtu", "strip/problem.resolved.toml", "strip/checkpoint.bin", "strip/report.html"})
    EXPECT_TRUE(shop.files().contains(file)) << file;
  const json s = summary(shop, "strip");
  EXPECT_EQ(s["title"], "A strip");
  EXPECT_EQ(s["version"], version_string);
  EXPECT_EQ(s["status"], "converged");
  EXPECT_EQ(s["mesh"]["cells"], 16);
  EXPECT_EQ(s["unknowns"], 3 * 45 + 3 * 15);
  ASSERT_EQ(s["load_steps"].size(), 2u);
  EXPECT_EQ(s["load_steps"][0]["t"], 0.5);
  EXPECT_EQ(s["load_steps"][1]["t"], 1.0);
  EXPECT_EQ(s["load_steps"][1]["negative_eigenvalues"], 0);
  EXPECT_DOUBLE_EQ(s["energy"].get<double>(), s["energies"]["cosserat-shell"].get<double>() + s["energies"]["traction-load"].get<double>());
  EXPECT_EQ(s["energy"], s["load_steps"][1]["energy"]);
  // A small load: the beam, w = P l^3 / (3 B) with B = E h^3 / 12 + h mu L_c^2 (b1 + b2) per unit width; four cells along are a little too stiff.
  const double w = s["load_steps"][1]["probes"]["tip"][2];
  const double beam = 2e-6 * 8 / (3 * (1.2 * 1e-3 / 12 + 0.1 * 0.6 * 1e-4 * 2));
  EXPECT_NEAR(w / beam, 0.98, 0.02);
  EXPECT_LT(s["load_steps"][1]["probes"]["turn"][1].get<double>(), 0);  // the end turns up: about -e2
  EXPECT_NE(o.out.find("converged"), std::string::npos);
  EXPECT_NE(o.out.find("factorisation"), std::string::npos);
  EXPECT_EQ(o.out.find('\r'), std::string::npos) << "no transient line where there is no terminal";
}

TEST(Run, VtkReadsTheFilesOfAnyNumberOfRanks) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  std::vector<json> all;
  for (const char* ranks : {"", " -n 2"}) {
    ASSERT_EQ(shop.karcher(std::string("run strip.toml -q") + ranks).code, 0);
    const json entries = judge({shop.directory() / "strip/solution.pvd"}, true)[0]["entries"];
    ASSERT_EQ(entries.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const json& vtu = entries[k]["vtu"];
      EXPECT_EQ(entries[k]["timestep"], 0.5 * static_cast<double>(k));
      EXPECT_EQ(vtu["time"], json({0.5 * static_cast<double>(k)}));
      EXPECT_EQ(vtu["points"], 45);
      EXPECT_EQ(vtu["cells"], json({{"69", {{"count", 16}, {"nodes", {6}}}}}));
      EXPECT_EQ(
          vtu["point_data"],
          json({{"m", 3}, {"displacement", 3}, {"reference", 3}, {"Q", 4}, {"director1", 3}, {"director2", 3}, {"director3", 3}, {"normal", 3}}));
      for (const char* name : {"energy_density.cosserat-shell", "energy_density.cosserat-shell.membrane", "energy_density.cosserat-shell.bending",
                               "energy_density.cosserat-shell.curvature"})
        EXPECT_EQ(vtu["cell_data"].value(name, 0), 1) << name;
    }
    EXPECT_NEAR(entries[0]["vtu"]["measure"]["2"].get<double>(), 2, 1e-14);
    EXPECT_NEAR(entries[0]["vtu"]["integrals"]["reference"][0].get<double>(), 2, 1e-14);  // of x over the strip
    EXPECT_NEAR(entries[0]["vtu"]["integrals"]["director3"][2].get<double>(), 2, 1e-14);
    // The load hardly stretches the strip, so that the energy per area adds up to the energy.
    const double energy = summary(shop, "strip")["energies"]["cosserat-shell"];
    EXPECT_NEAR(entries[2]["vtu"]["integrals"]["energy_density.cosserat-shell"][0].get<double>(), energy, 1e-4 * energy);
    all.push_back(entries[2]["vtu"]["values"]["displacement"]);
  }
  ASSERT_EQ(all[0].size(), all[1].size());
  for (std::size_t i = 0; i < all[0].size(); ++i) EXPECT_NEAR(all[0][i].get<double>(), all[1][i].get<double>(), 1e-6);
}

TEST(Run, AResolvedProblemGivesTheSameAnswer) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml --quiet --set parameters.load=3e-6 --set 'fields.Q.order=2' -o first").code, 0);
  const Outcome o = shop.karcher("run first/problem.resolved.toml --quiet -o second");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_EQ(summary(shop, "first")["energy"], summary(shop, "second")["energy"]);
  EXPECT_EQ(summary(shop, "first")["load_steps"][1]["probes"], summary(shop, "second")["load_steps"][1]["probes"]);
  // Resolving is idempotent, up to the directory of results.
  const auto without_directory = [](std::string text) {
    return text.erase(text.find("directory = "), text.find('\n', text.find("directory = ")) - text.find("directory = "));
  };
  EXPECT_EQ(without_directory(content(shop.directory() / "first/problem.resolved.toml")),
            without_directory(content(shop.directory() / "second/problem.resolved.toml")));
}

TEST(Run, AParameterMayBeOverriddenByItsNameAlone) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml -q --set load=1e-6 -o a").code, 0);
  ASSERT_EQ(shop.karcher("run strip.toml -q --set parameters.load=2e-6/2 -o b").code, 0);
  EXPECT_EQ(summary(shop, "a")["energy"], summary(shop, "b")["energy"]);
}

TEST(Run, RanksAgree) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml -q -o one").code, 0);
  const json one = summary(shop, "one");
  for (const int ranks : {2, 3}) {
    const std::string directory = "ranks" + std::to_string(ranks);
    const Outcome o = shop.karcher("run strip.toml -n " + std::to_string(ranks) + " -o " + directory);
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err, "");
    const json many = summary(shop, directory);
    EXPECT_EQ(many["ranks"], ranks);
    EXPECT_EQ(many["unknowns"], one["unknowns"]);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(many["load_steps"][k]["status"], one["load_steps"][k]["status"]);
      EXPECT_NEAR(many["load_steps"][k]["energy"].get<double>() / one["load_steps"][k]["energy"].get<double>(), 1, 1e-10);
    }
    EXPECT_EQ(o.out.find("Load step 1 of 2"), o.out.rfind("Load step 1 of 2")) << "the table is printed once";
  }
}

TEST(Run, NotConvergedIsAResultWithExitCodeOne) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  for (const char* ranks : {"", " -n 2"}) {
    const Outcome o = shop.karcher(std::string("run strip.toml -q --set solver.max_iterations=0 -o stopped") + ranks);
    EXPECT_EQ(o.code, 1) << o.err;
    EXPECT_EQ(summary(shop, "stopped")["status"], "not-converged");
    EXPECT_EQ(summary(shop, "stopped")["load_steps"].size(), 1u);
  }
}

TEST(Run, ALoadStepThatFailsNamesTheCellAndKeepsTheResultsOfThoseBefore) {
  const std::string file = arc("pi*t") + "steps = 2\n";
  for (const char* ranks : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("arc.toml", file);
    const Outcome o = shop.karcher(std::string("run arc.toml -q") + ranks);
    EXPECT_EQ(o.code, 1) << o.err;
    const json s = summary(shop, "arc");
    EXPECT_EQ(s["status"], "failed");
    ASSERT_EQ(s["load_steps"].size(), 2u);
    // 1/2 int |u'|^2 of a quarter of a great circle over a unit interval
    EXPECT_NEAR(s["load_steps"][0]["energy"].get<double>(), M_PI * M_PI / 8, 1e-12);
    EXPECT_EQ(s["load_steps"][1]["status"], "failed");
    EXPECT_NE(s["load_steps"][1]["reason"].get<std::string>().find("harmonic in the cell around (0.5, 0, 0)"), std::string::npos);
    EXPECT_TRUE(s["energy"].is_null()) << "not a sum over some of the cells";
    EXPECT_TRUE(s["energies"]["harmonic"].is_null());
    EXPECT_TRUE(shop.files().contains("arc/solution_0001.vtu"));
  }
}

TEST(Run, WithoutConvergenceTheInertiaIsToldAllTheSame) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  // The unloaded strip is stable; one step under a large load leads where it is not.
  for (const int iterations : {0, 1}) {
    const Outcome o = shop.karcher("run strip.toml -q --set load=3e-3 --set solver.max_iterations=" + std::to_string(iterations));
    EXPECT_EQ(o.code, 1) << o.err;
    const json step = summary(shop, "strip")["load_steps"][0];
    EXPECT_EQ(step["status"], "not-converged");
    EXPECT_EQ(step["negative_eigenvalues"].get<int>() > 0, iterations == 1);
  }
}

TEST(Run, ExpressionsAreFunctionsOfTheMeshPointWhereverTheReferencePutsIt) {
  const Workshop shop;
  // The strip [0, 1] x [0, 1] of the mesh stands for [0, 2] x [0, 1]. Flat and stretched alike in all directions, its energy is proportional to the mean
  // thickness, 0.15 for 0.1 (1 + x) on the mesh; the load on R^1 is - int x u = - 2 int_0^1 x dx for u = 1.
  shop.write("two.toml", R"toml(
[mesh]
generate = "rectangle"
cells = [2, 2]
[reference]
position = ["2*x", "y", "z"]
[fields.m]
manifold = "R3"
order = 2
initial = ["2.2*x", "1.1*y", "z"]
[fields.Q]
manifold = "SO3"
[fields.u]
manifold = "R1"
initial = 1
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = "0.1*(1 + x)"
mu = 1
lambda = 1
mu_c = 1
L_c = 0.1
[[energies]]
type = "harmonic"
field = "u"
[[loads]]
type = "volume"
field = "u"
value = ["x"]
)toml");
  const json varying = json::parse(shop.karcher("evaluate two.toml --json").out)["energies"];
  const json constant = json::parse(shop.karcher("evaluate two.toml --json --set energies.0.thickness=0.1").out)["energies"];
  EXPECT_NEAR(varying["cosserat-shell"].get<double>() / constant["cosserat-shell"].get<double>(), 1.5, 1e-12);
  EXPECT_NEAR(varying["volume-load"].get<double>(), -1, 1e-12);
}

TEST(Evaluate, GivesTheClosedFormOfABentStrip) {
  const Workshop shop;
  // Flat strip bent to a cylinder of curvature k: [h^3/12 M + h mu L_c^2 (b1 + b2)/2] k^2 per area, M = mu + mu lambda/(lambda + 2 mu); docs/models.md.
  shop.write("bent.toml", R"toml(
[parameters]
k = 0.8
[mesh]
generate = "rectangle"
size = [1, 0.5]
cells = [8, 2]
shape = "quadrilateral"
[fields.m]
manifold = "R3"
order = 3
initial = ["sin(k*x)/k", "y", "(1 - cos(k*x))/k"]
[fields.Q]
manifold = "SO3"
order = 3
initial = [0, "-k*x", 0]
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.1
mu = 2
lambda = 3
mu_c = 1
L_c = 0.05
b = [1, 2, 3]
)toml");
  const Outcome o = shop.karcher("evaluate bent.toml --json");
  ASSERT_EQ(o.code, 0) << o.err;
  const json e = json::parse(o.out);
  const double h = 0.1, m = 2 + 2.0 * 3 / (3 + 4), c = 2 * 0.05 * 0.05 * 3 / 2;
  EXPECT_NEAR(e["energy"].get<double>() / ((h * h * h / 12 * m + h * c) * 0.64 * 0.5), 1, 1e-6);
  EXPECT_EQ(e["energies"]["cosserat-shell"], e["energy"]);
  EXPECT_EQ(shop.files().size(), 1u) << "evaluate writes nothing";
}

const std::string harmonic = R"toml(
[parameters]
r2 = "x^2 + y^2"
[mesh]
generate = "rectangle"
lower = [-1, -1]
size = [2, 2]
cells = [8, 8]
shape = "quadrilateral"
[fields.u]
manifold = "S2"
order = 1
initial = "exact"
[[energies]]
type = "harmonic"
field = "u"
[[dirichlet]]
field = "u"
on = "boundary"
value = "exact"
[exact.u]
value = ["2*x/(r2 + 1)", "2*y/(r2 + 1)", "(r2 - 1)/(r2 + 1)"]
[quadrature]
degree = 12
)toml";

TEST(Converge, GivesTheKnownMinimisersAndOptimalOrders) {
  const Workshop shop;
  shop.write("map.toml", harmonic);
  // Q1 minimisers of the projection rule on 8 x 8 and 16 x 16, Q2 on 8 x 8 (known from an independent program).
  const Outcome o = shop.karcher("converge map.toml --levels 2 --json -o out");
  ASSERT_EQ(o.code, 0) << o.err;
  const json levels = json::parse(o.out)["levels"];
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_NEAR(levels[0]["energy"].get<double>(), 7.0171138772, 1e-9);
  EXPECT_NEAR(levels[1]["energy"].get<double>(), 6.9768307949, 1e-9);
  EXPECT_NEAR(levels[0]["errors"]["u"]["l2"].get<double>(), 9.511377e-3, 1e-8);
  EXPECT_NEAR(levels[0]["errors"]["u"]["h1"].get<double>(), 2.248390e-1, 1e-6);
  EXPECT_NEAR(levels[2]["orders"]["u"]["l2"].get<double>(), 2, 0.05);
  EXPECT_NEAR(levels[2]["orders"]["u"]["h1"].get<double>(), 1, 0.05);
  EXPECT_EQ(json::parse(content(shop.directory() / "out/convergence.json"))["levels"], levels);
  EXPECT_EQ(
      content(shop.directory() / "out/convergence.csv").find("level,cells,unknowns,energy,status,l2_u,h1_u,order_l2_u,order_h1_u\n0,64,162,7.01711"),
      0u);
}

TEST(Converge, StartsAreEquivalentAndTheFinestLevelStandsInForTheExactSolution) {
  const Workshop shop;
  shop.write("map.toml", harmonic);
  std::string unknown = harmonic;
  unknown.erase(unknown.find("[exact.u]"), unknown.find("[quadrature]") - unknown.find("[exact.u]"));
  for (const char* key : {"initial = ", "value = "})
    unknown.replace(unknown.find(std::string(key) + "\"exact\""), std::string(key).size() + 7, std::string(key) + "[\"2*x\", \"2*y\", \"r2 - 1\"]");
  shop.write("unknown.toml", unknown);
  const json prolonged = json::parse(shop.karcher("converge map.toml --set fields.u.order=2 --levels 2 --json").out)["levels"];
  const json initial = json::parse(shop.karcher("converge map.toml --set fields.u.order=2 --levels 2 --start initial --json").out)["levels"];
  const Outcome o = shop.karcher("converge unknown.toml --set fields.u.order=2 --levels 3 --json");
  ASSERT_EQ(o.code, 0) << o.err;
  const json finest = json::parse(o.out)["levels"];
  EXPECT_NEAR(prolonged[0]["energy"].get<double>(), 6.9639263964, 1e-9);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(prolonged[k]["energy"].get<double>(), initial[k]["energy"].get<double>(), 1e-11);
    EXPECT_NEAR(prolonged[k]["energy"].get<double>(), finest[k]["energy"].get<double>(), 1e-11);
  }
  EXPECT_NEAR(finest[0]["errors"]["u"]["h1"].get<double>() / prolonged[0]["errors"]["u"]["h1"].get<double>(), 1, 0.01);
  EXPECT_NEAR(finest[1]["errors"]["u"]["l2"].get<double>() / prolonged[1]["errors"]["u"]["l2"].get<double>(), 1, 0.02);
  EXPECT_TRUE(finest[3]["errors"].empty());
}

TEST(Converge, WithoutEnergiesMeasuresInterpolation) {
  const Workshop shop;
  shop.write("interpolation.toml", R"toml(
[mesh]
generate = "rectangle"
cells = [4, 4]
[fields.Q]
manifold = "SO3"
order = 2
interpolation = "geodesic"
initial = ["sin(x + y)", "x*y", "cos(2*x)"]
[exact.Q]
value = ["sin(x + y)", "x*y", "cos(2*x)"]
)toml");
  const Outcome o = shop.karcher("converge interpolation.toml --levels 3 --json");
  ASSERT_EQ(o.code, 0) << o.err;
  const json levels = json::parse(o.out)["levels"];
  EXPECT_EQ(levels[3]["status"], "interpolated");
  EXPECT_NEAR(levels[3]["orders"]["Q"]["l2"].get<double>(), 3, 0.1);
  EXPECT_NEAR(levels[3]["orders"]["Q"]["h1"].get<double>(), 2, 0.1);
}

TEST(Converge, TakesExactValuesHoweverDeepLongAndSharedTheyAre) {
  // All entries are x, in 8000 parentheses, as halves of halves 2^24 times shared, and through 39 parameters of 4000 terms each.
  std::string parameters = "h0 = \"x\"\ns0 = \"x\"\n", terms;
  for (int i = 0; i < 4000; ++i) terms += " + 0*y";
  for (int i = 1; i <= 24; ++i) parameters += fmt::format("h{0} = \"0.5*h{1} + 0.5*h{1}\"\n", i, i - 1);
  for (int i = 1; i <= 39; ++i) parameters += fmt::format("s{} = \"s{}{}\"\n", i, i - 1, terms);
  const Workshop shop;
  shop.write("deep.toml", "[parameters]\n" + parameters + R"toml(
[mesh]
generate = "rectangle"
cells = [2, 1]
[fields.u]
manifold = "R3"
initial = ["x", "x", "x"]
[exact.u]
value = [")toml" + std::string(8000, '(') +
                              "x" + std::string(8000, ')') + "\", \"h24\", \"s39\"]\n");
  const Outcome o = shop.karcher("converge deep.toml --levels 1 --json");
  ASSERT_EQ(o.code, 0) << o.err;
  const json level = json::parse(o.out)["levels"][0];
  EXPECT_NEAR(level["errors"]["u"]["l2"].get<double>(), 0, 1e-14);
  EXPECT_NEAR(level["errors"]["u"]["h1"].get<double>(), 0, 1e-14);
}

TEST(Check, FindsThatDerivativesAreRight) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("check strip.toml --derivatives");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("gradient and Hessian are right"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("16 cells"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("left                 2 entities of dimension 1"), std::string::npos) << o.out;
  EXPECT_EQ(shop.files().size(), 1u);
}

TEST(Catalogue, ListsAndExplains) {
  const Workshop shop;
  for (const char* what : {"manifolds", "energies", "meshes", "examples"}) {
    const Outcome o = shop.karcher(std::string("list ") + what);
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_GT(std::count(o.out.begin(), o.out.end(), '\n'), 3) << what;
  }
  EXPECT_NE(shop.karcher("list manifolds").out.find("SPD3"), std::string::npos);
  const std::string everything = shop.karcher("list").out;
  for (const char* entry : {"SPD3", "cosserat-shell", "traction", "klein-bottle", "curve-shortening"})
    EXPECT_NE(everything.find(entry), std::string::npos) << entry;
  EXPECT_NE(shop.karcher("list energies").out.find("cosserat-shell"), std::string::npos);
  EXPECT_NE(shop.karcher("doc energies.cosserat-shell").out.find("thickness"), std::string::npos);
  EXPECT_NE(shop.karcher("doc mesh.generate").out.find("klein-bottle"), std::string::npos);
  EXPECT_NE(shop.karcher("doc solver").out.find("gradient_tolerance (number, default: 1e-8)"), std::string::npos);
  EXPECT_EQ(shop.karcher("version").out, "karcher " + std::string(version_string) + "\n");
  EXPECT_EQ(shop.karcher("--version").out, std::string(version_string) + "\n");
}

TEST(New, MakesATemplateThatRuns) {
  const Workshop shop;
  ASSERT_EQ(shop.karcher("new mine").code, 0);
  EXPECT_NE(content(shop.directory() / "mine/problem.toml").find("# others: karcher list energies"), std::string::npos);
  const Outcome o = shop.karcher("run mine/problem.toml -q");
  EXPECT_EQ(o.code, 0) << o.err;
}

TEST(Run, LeavesALogOfWhatItSaysAlsoAQuietOne) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome loud = shop.karcher("run strip.toml -o loud");
  EXPECT_EQ(shop.karcher("run strip.toml -q -o quiet --set continuation.to=0.5 --set continuation.steps=1").code, 0);
  const std::string log = content(shop.directory() / "loud/run.log");
  EXPECT_TRUE(log.starts_with("karcher " + std::string(version_string) + ", 20"));
  // All that was printed but the times, the list of files and the last line.
  std::istringstream lines(loud.out);
  for (std::string line; std::getline(lines, line) && line.find(" results ") == std::string::npos;)
    EXPECT_NE(log.find(line), std::string::npos) << line;
  EXPECT_NE(log.find("peak memory"), std::string::npos);
  const std::string quiet = content(shop.directory() / "quiet/run.log");
  EXPECT_NE(quiet.find("Load step 1 of 1, t = 0.5"), std::string::npos);
  EXPECT_EQ(shop.karcher("run strip.toml -q -o quiet --resume").code, 0);
  const std::string resumed = content(shop.directory() / "quiet/run.log");
  EXPECT_TRUE(resumed.starts_with(quiet));
  EXPECT_NE(resumed.find("resumed after load step 1", quiet.size()), std::string::npos);
  EXPECT_EQ(shop.karcher("run strip.toml -q -o quiet").code, 0);
  EXPECT_EQ(content(shop.directory() / "quiet/run.log").find("resumed"), std::string::npos) << "a new run has a new log";
}

TEST(Converge, TabulatesProbes) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("converge strip.toml --levels 1 -o orders");
  ASSERT_EQ(o.code, 0) << o.err;
  const auto levels = nlohmann::json::parse(content(shop.directory() / "orders/convergence.json"))["levels"];
  const auto run_alone = shop.karcher("run strip.toml -q -o alone");
  EXPECT_EQ(levels[0]["probes"], summary(shop, "alone")["load_steps"][1]["probes"]);
  EXPECT_EQ(levels[1]["probes"]["tip"].size(), 3u);
  const std::string csv = content(shop.directory() / "orders/convergence.csv");
  EXPECT_NE(csv.find(",tip.0,tip.1,tip.2,turn.0,turn.1,turn.2\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find(fmt::format(",{}", levels[1]["probes"]["tip"][2].get<double>())), std::string::npos);
  EXPECT_NE(o.out.find("turn.2"), std::string::npos) << o.out;
}

TEST(New, CopiesAnExampleWithItsFilesAndOverwritesNothing) {
  const Workshop shop;
  Outcome o = shop.karcher("new mine --from curve-shortening");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(shop.karcher("check mine/problem.toml").code, 0) << "its mesh came along";
  EXPECT_TRUE(shop.files().contains("mine/README.md"));
  EXPECT_FALSE(shop.files().contains("mine/expected.toml"));
  shop.write("mine/problem.toml", "mine");
  o = shop.karcher("new mine --from cantilever");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("exists already"), std::string::npos) << o.err;
  EXPECT_EQ(content(shop.directory() / "mine/problem.toml"), "mine");
  o = shop.karcher("new other --from cantilevr");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("Did you mean \"cantilever\"?"), std::string::npos) << o.err;
  EXPECT_FALSE(std::filesystem::exists(shop.directory() / "other"));
}

TEST(Run, OneRunAtATimeHasTheDirectoryAndTheNextSaysWhatItReplaces) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  {
    const DirectoryLock lock(shop.directory() / "strip");
    const auto before = shop.files();
    for (const char* arguments : {"run strip.toml", "run strip.toml -n 2"}) {
      const Outcome o = shop.karcher(arguments);
      EXPECT_EQ(o.code, 2) << o.err;
      EXPECT_NE(o.err.find("(process " + std::to_string(::getpid()) + ", since "), std::string::npos) << o.err;
      EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
      EXPECT_EQ(shop.files(), before);
    }
  }
  ASSERT_EQ(shop.karcher("run strip.toml").code, 0);
  const auto first = shop.files();
  EXPECT_TRUE(first.contains("strip/solution_0002.vtu"));
  EXPECT_FALSE(first.contains("strip/.lock"));
  shop.write("strip/.solution_0002.vtu.77.part", "half");
  const Outcome again = shop.karcher("run strip.toml --set continuation.steps=1");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("replaces the results of an earlier run"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("converged, 2 load steps)"), std::string::npos) << again.out;
  auto expected = first;
  expected.erase("strip/solution_0002.vtu");
  EXPECT_EQ(shop.files(), expected);
}

TEST(Run, APageThatFailsIsAWarning) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  std::filesystem::create_directories(shop.directory() / "strip/report.html/in the way");
  const Outcome o = shop.karcher("run strip.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.err.find("warning: there is no page: "), std::string::npos) << o.err;
  EXPECT_EQ(summary(shop, "strip")["status"], "converged");
}

}  // namespace
}  // namespace karcher::testing
