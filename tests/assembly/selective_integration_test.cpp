#include "karcher/assembly/selective_integration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/body_problem.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using testing::BodyProblem;
using Point3 = Vec3<double>;

/// A shell without stress. \param type  "cosserat-shell" or "reissner-mindlin"
BodyProblem shell(const std::string& type, const std::string& surface, const std::string& shape, int order, double thickness, bool selective = true) {
  GeneratorOptions options{surface, {{"cells", {2, 2}}, {"order", {static_cast<double>(order)}}}, {{"shape", shape}}};
  if (surface == "cylinder") options.numbers["angle"] = {1.5};
  BodyProblem b(std::make_shared<Mesh>(generate(options)), type == "cosserat-shell" ? manifold_ops<Rotation>() : manifold_ops<Sphere<2>>(),
                Rule::projection, order);
  b.input.parameters = {{"thickness", thickness}, {"mu", 1.3}, {"lambda", 0.9}, {"prestretch[0]", 1.0}, {"prestretch[1]", 1.0}};
  if (type == "cosserat-shell")
    for (const auto& [key, value] : {std::pair("mu_c", 0.7), {"L_c", 0.02}, {"b[0]", 1.2}, {"b[1]", 0.7}, {"b[2]", 0.4}})
      b.input.parameters[key] = value;
  else
    b.input.parameters["shear_correction"] = 0.8;
  b.input.choices["integration"] = selective ? "selective" : "full";
  b.make(type);
  if (type == "reissner-mindlin") b.u.values[1] = b.term().stress_free(1);
  return b;
}

template <class F>
void for_all(F f) {
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"})
    for (const std::string shape : {"triangle", "quadrilateral"})
      for (const int order : {1, 2, 3}) f(type, shape, order);
}

TEST(SelectiveIntegration, LeavesTheReferenceWithoutEnergyAndForces) {
  for_all([](const auto& type, const auto& shape, int order) {
    const BodyProblem b = shell(type, "cylinder", shape, order, 0.05);
    EXPECT_LT(std::fabs(b.energy()), 1e-26) << type << shape << order;
    EXPECT_LT(b.largest_force(), 1e-13) << type << shape << order;
  });
}

TEST(SelectiveIntegration, ObeysTheLawsOfAnEnergy) {
  for_all([](const auto& type, const auto& shape, int order) {
    BodyProblem b = shell(type, "cylinder", shape, order, 0.05);
    b.perturb(0.02, 0.1);
    for (const std::string& broken : energy_laws(*b.functional, b.u)) ADD_FAILURE() << broken << type << shape << order;
    if (type == "cosserat-shell") {
      EXPECT_LT(testing::change_by_rigid_motions(b), 1e-12) << shape << order;
    }
  });
}

TEST(SelectiveIntegration, IsFullWhereTheShellIsAsThickAsItsCellsAreLong) {
  for_all([](const auto& type, const auto& shape, int order) {
    BodyProblem selective = shell(type, "rectangle", shape, order, 2), full = shell(type, "rectangle", shape, order, 2, false);
    for (BodyProblem* b : {&selective, &full}) b->perturb(0.03, 0.2);
    EXPECT_NEAR(selective.energy() / full.energy(), 1, 1e-13) << type << shape << order;
  });
}

TEST(SelectiveIntegration, HasTheEnergyOfHomogeneousStretchAndShear) {
  for_all([](const auto& type, const auto& shape, int order) {
    BodyProblem selective = shell(type, "rectangle", shape, order, 0.01), full = shell(type, "rectangle", shape, order, 0.01, false);
    for (BodyProblem* b : {&selective, &full})
      b->set_deformation([](const Point3& x) { return Point3{{1.1 * x[0], x[1] + 0.1 * x[0], 0.2 * x[0]}}; });
    EXPECT_NEAR(selective.energy() / full.energy(), 1, 1e-13) << type << shape << order;
    const auto parts = selective.term().part_energies(selective.u), whole = full.term().part_energies(full.u);
    for (std::size_t p = 0; p < parts.size(); ++p) EXPECT_NEAR(parts[p], whole[p], 1e-15) << type << p;
  });
}

TEST(SelectiveIntegration, CountsTheThicknessOfTheLoadParameter) {
  for (const std::string type : {"cosserat-shell", "reissner-mindlin"}) {
    BodyProblem b = shell(type, "cylinder", "triangle", 2, 0.05);
    b.perturb(0.03, 0.2);
    ParameterValue& h = b.input.parameters["thickness"];
    h.function = [](const Point3&, double t) { return 0.05 + t; };
    h.depends_on_t = true;
    b.make(type);
    b.functional->set_load_parameter(0.02);
    const double energy = b.energy();
    b.input.parameters["thickness"] = 0.07;
    b.make(type);
    EXPECT_NEAR(b.energy() / energy, 1, 1e-14) << type;
  }
}

}  // namespace
}  // namespace karcher
