// Shells that do not lock, through the program.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

std::string shell(const std::string& type, const std::string& shape, int order, double thickness, const std::string& integration) {
  const std::string p = std::to_string(order);
  const bool director = type == "reissner-mindlin";
  return "[mesh]\ngenerate = \"cylinder\"\nradius = 10\nangle = \"pi/2\"\nheight = 1\norder = " + p + "\nshape = \"" + shape +
         "\"\n[fields.m]\nmanifold = \"R3\"\norder = " + p + "\n[fields.d]\nmanifold = \"" + (director ? "S2" : "SO3") + "\"\norder = " + p +
         "\n[[energies]]\ntype = \"" + type + "\"\ndeformation = \"m\"\n" +
         (director ? "director = \"d\"\n" : "rotation = \"d\"\nmu_c = 6e5\nL_c = 1e-6\n") +
         "young = 1.2e6\npoisson = 0\nthickness = " + std::to_string(thickness) + "\nintegration = \"" + integration + "\"\n";
}

/// How far the free end of a quarter of a circle moves inwards under a small force, by the thin curved beam: pi F R^3/(4 E I).
double relative_tip(const std::string& type, const std::string& shape, int cells, const std::string& integration) {
  const Workshop shop;
  const double h = 0.02, force = 1e-6, inertia = h * h * h / 12;
  std::string problem = shell(type, shape, 2, h, integration);
  problem.insert(problem.find("[fields.m]"), "cells = [" + std::to_string(cells) + ", 1]\n");
  const json s =
      run(shop,
          problem +
              "[[dirichlet]]\non = \"start\"\nsupport = \"clamped\"\n[[loads]]\ntype = \"traction\"\nfield = \"m\"\non = \"end\"\nvalue = [0, -1e-6, "
              "0]\n[[probes]]\nname = \"tip\"\nfield = \"m\"\nat = [0, 10, 0.5]\nquantity = \"displacement\"\n");
  EXPECT_EQ(s["load_steps"].back()["negative_eigenvalues"], 0);
  return -s["load_steps"].back()["probes"]["tip"][1].get<double>() / (std::numbers::pi * force * 1000 / (4 * 1.2e6 * inertia));
}

TEST(SelectiveIntegration, BendsAThinRingThatLocksOtherwise) {
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"}) {
    EXPECT_LT(relative_tip(type, "quadrilateral", 6, "full"), 0.05) << type;
    EXPECT_NEAR(relative_tip(type, "quadrilateral", 6, "selective"), 1, 0.01) << type;
    EXPECT_LT(relative_tip(type, "triangle", 12, "full"), 0.3) << type;
    EXPECT_GT(relative_tip(type, "triangle", 12, "selective"), 0.75) << type;
  }
}

TEST(SelectiveIntegration, LeavesNoMotionFreeButTheRigidOnes) {
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"})
    for (const std::string shape : {"triangle", "quadrilateral"})
      for (const int order : {1, 2, 3}) {
        const Workshop shop;
        std::string problem = shell(type, shape, order, 0.02, "selective");
        problem.insert(problem.find("[fields.m]"), "cells = [2, 1]\n");
        const json step = run(shop, problem)["load_steps"].back();
        EXPECT_EQ(step["negative_eigenvalues"], 0) << type << shape << order;
        EXPECT_EQ(step["neutral_eigenvalues"], 6) << type << shape << order;
      }
}

}  // namespace
}  // namespace karcher::testing
