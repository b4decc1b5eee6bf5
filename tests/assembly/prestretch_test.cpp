// Shells that are larger or smaller than their reference.

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/body_problem.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using testing::BodyProblem;
using Point3 = Vec3<double>;

constexpr double h = 0.1, mu = 1.3, lambda = 0.9, mu_c = 0.7, k_s = 0.8, plane = 2 * lambda * mu / (lambda + 2 * mu);

/// \param type  "cosserat-shell" or "reissner-mindlin"
BodyProblem shell(const std::string& type, const std::string& surface, int order, double e1, double e2) {
  GeneratorOptions options{surface, {{"order", {static_cast<double>(order)}}}, {}};
  if (surface == "cylinder") options.numbers["angle"] = {1.5}, options.numbers["cells"] = {3, 2};
  if (surface == "rectangle") options.numbers["cells"] = {3, 2}, options.numbers["size"] = {3, 2};
  if (surface == "sphere") options.numbers["cells"] = {2};
  BodyProblem b(std::make_shared<Mesh>(generate(options)), type == "cosserat-shell" ? manifold_ops<Rotation>() : manifold_ops<Sphere<2>>(),
                Rule::projection, order);
  b.input.parameters = {{"thickness", h}, {"mu", mu}, {"lambda", lambda}, {"prestretch[0]", e1}, {"prestretch[1]", e2}};
  if (type == "cosserat-shell")
    for (const auto& [key, value] : {std::pair("mu_c", mu_c), {"L_c", 0.02}, {"b[0]", 1.2}, {"b[1]", 0.7}, {"b[2]", 0.4}})
      b.input.parameters[key] = value;
  else
    b.input.parameters["shear_correction"] = k_s;
  b.make(type);
  if (type == "reissner-mindlin") b.u.values[1] = b.term().stress_free(1);
  return b;
}
const auto models = {std::string("cosserat-shell"), std::string("reissner-mindlin")};

TEST(Prestretch, LeavesNoEnergyAndNoForceWhereTheShellHasItsSize) {
  for (const std::string& type : models)
    for (const int order : {1, 2, 3}) {
      BodyProblem flat = shell(type, "rectangle", order, 1.3, 0.8);
      EXPECT_GT(flat.energy(), 1e-3);
      flat.set_deformation([](const Point3& x) { return Point3{{1.3 * x[0], 0.8 * x[1], x[2]}}; });
      EXPECT_LT(std::fabs(flat.energy()), 1e-27) << type << order;
      EXPECT_LT(flat.largest_force(), 1e-14) << type << order;
      // t1 goes around a cylinder, t2 along its axis: the stress-free one has 1.3 times the radius, and the same normals.
      BodyProblem cylinder = shell(type, "cylinder", order, 1.3, 0.8);
      EXPECT_GT(cylinder.energy(), 1e-3);
      cylinder.set_deformation([](const Point3& x) { return Point3{{1.3 * x[0], 1.3 * x[1], 0.8 * x[2]}}; });
      EXPECT_LT(std::fabs(cylinder.energy()), 1e-26) << type << order;
      EXPECT_LT(cylinder.largest_force(), 1e-13) << type << order;
      BodyProblem sphere = shell(type, "sphere", order, 0.9, 0.9);
      sphere.set_deformation([](const Point3& x) { return 0.9 * x; });
      EXPECT_LT(std::fabs(sphere.energy()), 1e-26) << type << order;
    }
}

TEST(Prestretch, HasTheDensityOfTheStrainsPerAreaOfTheStressFreeShell) {
  const double e1 = 1.2, e2 = 0.9, area = 3 * 2 * e1 * e2;
  const double first = 1 / e1 - 1, second = 1 / e2 - 1;  // stretches of the reference as the shell sees it
  EXPECT_NEAR(shell("cosserat-shell", "rectangle", 1, e1, e2).energy(),
              area * h * (mu * (first * first + second * second) + 0.5 * plane * (first + second) * (first + second)), 1e-13);
  const double green1 = 0.5 * (1 / (e1 * e1) - 1), green2 = 0.5 * (1 / (e2 * e2) - 1);
  EXPECT_NEAR(shell("reissner-mindlin", "rectangle", 1, e1, e2).energy(),
              area * 0.5 * h * (2 * mu * (green1 * green1 + green2 * green2) + plane * (green1 + green2) * (green1 + green2)), 1e-13);
}

TEST(Prestretch, ObeysTheLawsOfAnEnergy) {
  for (const std::string& type : models)
    for (const std::string surface : {"rectangle", "cylinder"}) {
      BodyProblem b = shell(type, surface, 2, 1.2, 0.9);
      b.perturb(0.03, 0.2);
      for (const std::string& broken : energy_laws(*b.functional, b.u)) ADD_FAILURE() << broken << type << surface;
    }
}

TEST(Prestretch, GrowsWithTheLoadParameter) {
  for (const std::string& type : models) {
    BodyProblem b = shell(type, "cylinder", 2, 1, 1);
    for (const char* key : {"prestretch[0]", "prestretch[1]"}) {
      ParameterValue& e = b.input.parameters[key];
      e.function = [](const Point3& x, double t) { return 1 + t * (1 + 0.2 * x[2]); };
      e.depends_on_t = true;
    }
    b.make(type);
    EXPECT_LT(std::fabs(b.energy()), 1e-26);
    b.functional->set_load_parameter(0.1);
    const double grown = b.energy();
    b.input.t = 0.1;
    b.make(type);
    EXPECT_GT(grown, 1e-4);
    EXPECT_NEAR(b.energy() / grown, 1, 1e-14);
  }
}

TEST(Prestretch, MustBePositive) {
  BodyProblem b = shell("cosserat-shell", "rectangle", 1, 1, 1);
  b.input.parameters["prestretch[1]"].function = [](const Point3& x, double) { return x[0] - 1; };
  EXPECT_THROW(b.make("cosserat-shell"), InputError);
}

}  // namespace
}  // namespace karcher
