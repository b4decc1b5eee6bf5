// The Cosserat plate through the program.

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

/// The cantilever of Sze, Liu and Lo (2004), section 3.1; the energy's type follows.
const std::string cantilever = R"toml([mesh]
generate = "rectangle"
size = [10, 1]
cells = [10, 1]
shape = "quadrilateral"
[fields.m]
manifold = "R3"
order = 3
[fields.Q]
manifold = "SO3"
order = 3
[[loads]]
type = "traction"
field = "m"
on = "right"
value = [0, 0, "4*t"]
[[dirichlet]]
on = "left"
support = "clamped"
[[probes]]
name = "tip"
field = "m"
at = [10, 0.5, 0]
quantity = "displacement"
[[energies]]
deformation = "m"
rotation = "Q"
thickness = 0.1
young = 1.2e6
poisson = 0
mu_c = 0.6e6
L_c = 1e-5
)toml";

TEST(CosseratPlate, BendsAsTheCurvedShellDoesOnAFlatReference) {
  const Workshop shop;
  const json plate = run(shop, cantilever + "type = \"cosserat-plate\"\n"), shell = run(shop, cantilever + "type = \"cosserat-shell\"\n");
  for (const std::size_t i : {0U, 2U})
    EXPECT_NEAR(plate["load_steps"][0]["probes"]["tip"][i].get<double>() / shell["load_steps"][0]["probes"]["tip"][i].get<double>(), 1, 1e-5);
  EXPECT_NEAR(plate["load_steps"][0]["probes"]["tip"][2].get<double>(), 6.6999751436, 1e-3);  // exact solution of the strip with mu_c = mu
}

TEST(CosseratPlate, RefusesACurvedReferenceAndPowersBelowOne) {
  const std::string curved = refusal(cantilever + "type = \"cosserat-plate\"\n[reference]\nposition = [\"x\", \"y\", \"0.1*x^2\"]\n");
  EXPECT_NE(curved.find("must lie in the plane z = 0, but has the point (10, "), std::string::npos) << curved;
  EXPECT_NE(refusal(cantilever + "type = \"cosserat-plate\"\np = 0.5\n").find("energies.0.p is 0.5; it must be at least 1"), std::string::npos);
  std::string soft = cantilever + "type = \"cosserat-plate\"\n";
  soft.replace(soft.find("poisson = 0"), 11, "poisson = -0.2");
  EXPECT_NE(refusal(soft).find("lambda is -"), std::string::npos);
}

}  // namespace
}  // namespace karcher::app
