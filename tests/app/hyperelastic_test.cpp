// Hyperelastic solids through the program.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::app {
namespace {

using nlohmann::json;
using testing::refusal;
using testing::run;
using testing::Workshop;

constexpr double mu = 1.3, lambda = 0.9;
const std::string moduli = "mu = 1.3\nlambda = 0.9\n", rivlin = "a = 0.5\nb = 0.15\nc = 0.075\nnormalised = true\n";

/// The material with constants that are mu and lambda for small strains.
std::string material(const std::string& name) {
  return "[[energies]]\ntype = \"hyperelastic\"\ndeformation = \"m\"\nmaterial = \"" + name + "\"\n" +
         (name == "mooney-rivlin" ? rivlin
          : name == "exp-hencky"  ? moduli + "k = 0.5\nk_hat = 0.3\nnormalised = true\n"
                                  : moduli);
}

/// A block of 2 x 1 x 1 in symmetry planes x = 0, y = 0, z = 0; loads and energies follow.
const std::string block = R"toml([mesh]
generate = "box"
size = [2, 1, 1]
cells = [2, 1, 1]
shape = "hexahedron"
[fields.m]
manifold = "R3"
order = 2
[[dirichlet]]
on = "left"
symmetry = "x"
[[dirichlet]]
on = "bottom"
symmetry = "y"
[[dirichlet]]
on = "front"
symmetry = "z"
[[probes]]
name = "end"
field = "m"
at = [2, 1, 1]
quantity = "displacement"
[solver]
gradient_tolerance = 1e-11
)toml";
std::string pulled(double traction) {
  return "[[loads]]\ntype = \"traction\"\nfield = \"m\"\non = \"right\"\nvalue = [\"t*" + std::to_string(traction) + "\", 0, 0]\n";
}
std::vector<double> end(const json& summary) { return summary["load_steps"].back()["probes"]["end"].get<std::vector<double>>(); }

TEST(Hyperelastic, FollowsTheClosedCurveOfAPulledNeoHookeanBlock) {
  const Workshop shop;
  for (const double s : {0.85, 1.5}) {
    // No stress across: mu (t^2 - 1) + lambda ln(s t^2) = 0; then P = mu (s - 1/s) + lambda ln(J)/s.
    double t = 1;
    for (int i = 0; i < 50; ++i) t -= (mu * (t * t - 1) + lambda * std::log(s * t * t)) / (2 * mu * t + 2 * lambda / t);
    const double stress = mu * (s - 1 / s) + lambda * std::log(s * t * t) / s;
    std::string load = pulled(1);
    load.replace(load.find("1.000000"), 8, json(stress).dump());
    const std::vector<double> u = end(run(shop, block + load + material("neo-hooke")));
    EXPECT_NEAR(u[0], 2 * (s - 1), 1e-8);
    EXPECT_NEAR(u[1], t - 1, 1e-8);
    EXPECT_NEAR(u[2], t - 1, 1e-8);
  }
}

TEST(Hyperelastic, IsLinearForSmallLoadsWhateverTheMaterial) {
  const Workshop shop;
  const double young = mu * (3 * lambda + 2 * mu) / (lambda + mu), poisson = lambda / (2 * (lambda + mu));
  const std::string held = "[[dirichlet]]\nfield = \"m\"\non = \"boundary\"\nvalue = [\"free\", \"y\", \"z\"]\n";
  const std::string weight = "[[loads]]\ntype = \"volume\"\nfield = \"m\"\nvalue = [\"1e-6*t\", 0, 0]\n";
  for (const char* name : {"saint-venant-kirchhoff", "mooney-rivlin", "exp-hencky"}) {
    const std::vector<double> u = end(run(shop, block + pulled(1e-6) + material(name)));
    EXPECT_NEAR(u[0] * young / 2e-6, 1, 1e-5) << name;
    EXPECT_NEAR(u[1] * young / (-1e-6 * poisson), 1, 1e-5) << name;
  }
  // A column of length 2 under its weight: u = f (2 x - x^2/2)/(lambda + 2 mu).
  for (const char* name : {"neo-hooke", "hencky"})
    EXPECT_NEAR(end(run(shop, block + held + weight + material(name)))[0] * (lambda + 2 * mu) / 2e-6, 1, 1e-5) << name;
}

/// A sheet of 2 x 1 in plane strain, pulled to the stretch 1.5.
const std::string sheet = R"toml([mesh]
generate = "rectangle"
size = [2, 1]
cells = [2, 1]
[fields.m]
manifold = "R2"
order = 2
[[dirichlet]]
on = "left"
symmetry = "x"
[[dirichlet]]
on = "bottom"
symmetry = "y"
[[dirichlet]]
field = "m"
on = "right"
value = ["x + t", "free"]
[[probes]]
name = "end"
field = "m"
at = [2, 1, 0]
quantity = "displacement"
)toml";

TEST(Hyperelastic, OfPlaneStrainHasTheClosedStretchAcrossAndStaysInThePlane) {
  const Workshop shop;
  const json summary = run(shop, sheet + material("neo-hooke"));
  double t = 1;
  for (int i = 0; i < 50; ++i) t -= (mu * (t * t - 1) + lambda * std::log(1.5 * t)) / (2 * mu * t + lambda / t);
  EXPECT_NEAR(end(summary)[1], t - 1, 1e-8);
  const double log_j = std::log(1.5 * t);
  EXPECT_NEAR(summary["energy"].get<double>(), 2 * (0.5 * mu * (1.5 * 1.5 + t * t - 2 - 2 * log_j) + 0.5 * lambda * log_j * log_j), 1e-9);
  // Nothing but the plane's own motions is missing.
  shop.write("free.toml", sheet.substr(0, sheet.find("[[dirichlet]]")) + material("hencky"));
  const std::string warnings = shop.karcher("check free.toml").out;
  EXPECT_NE(warnings.find("the body can move in all directions perpendicular to z and turn about the axis through"), std::string::npos) << warnings;
}

TEST(Hyperelastic, StartsWhereNoCellIsTurnedOverAndSaysWhichIs) {
  std::string folded = block + material("neo-hooke");
  folded.replace(folded.find("order = 2"), 9, "order = 2\ninitial = [\"x < 1.1 ? x : 2.4 - x\", \"y\", \"z\"]");
  const std::string where = refusal(folded);
  EXPECT_NE(where.find("hyperelastic in the cell around (1.5, 0.5, 0.5): the energy density is infinite there"), std::string::npos) << where;
}

TEST(Hyperelastic, RefusesWhatDoesNotGoWithItsMaterial) {
  const auto says = [](const std::string& energy, const std::string& sentence) {
    const std::string text = refusal(block + energy);
    EXPECT_NE(text.find(sentence), std::string::npos) << text;
  };
  says(material("neo-hook"), "Did you mean \"neo-hooke\"");
  says(material("neo-hooke") + "k = 1\n",
       "energies.0.k goes with material = \"exp-hencky\", not with \"neo-hooke\", with which go: mu, lambda, material.");
  says(material("hencky") + "normalised = true\n",
       "energies.0.normalised goes with material = \"mooney-rivlin\" or \"exp-hencky\", not with \"hencky\"");
  says(material("hencky") + "volumetric = \"ciarlet\"\n", "energies.0.volumetric goes with material = \"mooney-rivlin\"");
  says(material("mooney-rivlin") + "young = 1\npoisson = 0.3\n", "energies.0.young goes with material = ");
  says(material("mooney-rivlin") + "volumetric = \"simo\"\n", "ciarlet");
  says(material("neo-hooke") + "young = 1\npoisson = 0.3\n", "give one pair or the other");
  std::string negative = material("exp-hencky");
  negative.replace(negative.find("k = 0.5"), 7, "k = 0");
  says(negative, "energies.0.k is 0; it must be greater than 0.");
  std::string lacking = material("exp-hencky");
  lacking.replace(lacking.find("k_hat = 0.3\n"), 12, "");
  says(lacking, "k_hat");
  std::string soft = material("neo-hooke");
  soft.replace(soft.find("lambda = 0.9"), 12, "lambda = -0.1");
  says(soft, "lambda is -0.1; it (and Poisson's ratio) must be at least 0 for the material \"neo-hooke\"");
  std::string in_space = sheet + material("neo-hooke");
  in_space.replace(in_space.find("\"R2\""), 4, "\"R3\"");
  in_space.replace(in_space.find("\"free\"]"), 7, "\"free\", \"free\"]");
  const std::string text = refusal(in_space);
  EXPECT_NE(text.find("has values in R3, but the region \"all\" has dimension 2"), std::string::npos) << text;
}

TEST(Hyperelastic, IsNotSaidToBeStrainedWhereItsConstantIsKept) {
  const Workshop shop;
  std::string kept = block + pulled(0.1) + material("mooney-rivlin");
  kept.replace(kept.find("normalised = true"), 17, "normalised = false");
  shop.write("kept.toml", kept);
  const std::string text = shop.karcher("check kept.toml").out;
  EXPECT_EQ(text.find("stress-free configuration"), std::string::npos) << text;
}

}  // namespace
}  // namespace karcher::app
