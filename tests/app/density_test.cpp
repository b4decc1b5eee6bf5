// Densities that are formulas of a problem file against the same densities compiled, on plane and curved meshes, and by Taylor's theorem.

#include "app/density.hpp"

#include <gtest/gtest.h>

#include "assembly/body_problem.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using app::Density;
using testing::BodyProblem;
using testing::Dense;
using testing::largest_difference;
using testing::MapProblem;
using testing::moved_mesh;

const std::vector<std::string> curl{"c0 = u[2].y - u[1].z", "c1 = u[0].z - u[2].x", "c2 = u[1].x - u[0].y"};
const std::string frank_oseen =
    "1.2/2*(u[0].x + u[1].y + u[2].z)^2 + 0.7/2*(u[0]*c0 + u[1]*c1 + u[2]*c2)^2"
    "+ 1.9/2*((u[1]*c2 - u[2]*c1)^2 + (u[2]*c0 - u[0]*c2)^2 + (u[0]*c1 - u[1]*c0)^2) - 0.8/2*(0.3*u[0] - 1.1*u[1] + 0.6*u[2])^2";

/// Half the squared gradient in ambient coordinates.
std::string dirichlet(int ambient) {
  std::string s;
  for (int i = 0; i < ambient; ++i)
    for (const char axis : {'x', 'y', 'z'}) s += (s.empty() ? "u[" : " + u[") + std::to_string(i) + "]." + axis + "^2";
  return "(" + s + ")/2";
}

std::shared_ptr<const DensityFormula> formula(const TermInput& input, const std::vector<std::string>& let, const std::string& density,
                                              const app::Scope& scope = {}) {
  std::vector<Density::Field> fields;
  for (std::size_t f = 0; f < input.fields.size(); ++f) fields.push_back({input.field(f).name, input.field(f).manifold});
  std::vector<Density::Text> definitions;
  for (const std::string& d : let) definitions.push_back({"let", app::Value::of(d)});
  const Density written(scope, fields, {}, definitions, {"density", app::Value::of(density)});
  return std::make_shared<const DensityFormula>(written.formula(input.region.dim));
}

/// The same problem with another term.
template <class Problem>
double difference(Problem& p, const std::string& type, const std::vector<std::string>& let, const std::string& density) {
  p.make(type);
  const Dense compiled(p);
  p.input.formula = formula(p.input, let, density);
  p.make("expression");
  const Dense written(p);
  EXPECT_FALSE(compiled.evaluation.failure || written.evaluation.failure);
  EXPECT_NEAR(p.functional->energy(p.u).energy, compiled.evaluation.energy, 1e-12 * std::fabs(compiled.evaluation.energy));
  return largest_difference(written, compiled);
}

std::shared_ptr<const Mesh> mesh(const std::string& where) {
  if (where == "plane") return moved_mesh("rectangle", {{"cells", {3, 2}}}, "triangle", 0.05, 2);
  if (where == "sphere") return moved_mesh("sphere", {{"cells", {2}}, {"order", {2}}}, "");
  return moved_mesh("box", {{"cells", {2, 1, 1}}}, "hexahedron", 0.05, 3);
}

MapProblem map_problem(const std::string& where, const ManifoldOps& manifold, Rule rule, const std::vector<double>& origin, int order = 2) {
  MapProblem p(mesh(where), manifold, rule, order);
  p.set_random(origin, 0.3);
  p.input.parameters = {{"scale", 1.0}, {"kappa", 0.7}, {"h", 1.3},    {"K1", 1.2},    {"K2", 0.7},
                        {"K3", 1.9},    {"chi", 0.8},   {"H[0]", 0.3}, {"H[1]", -1.1}, {"H[2]", 0.6}};
  return p;
}

TEST(Density, IsTheCompiledOneOfMapsIntoTheSphere) {
  for (const std::string where : {"plane", "sphere", "solid"})
    for (const Rule rule : {Rule::projection, Rule::geodesic}) {
      MapProblem p = map_problem(where, manifold_ops<Sphere<2>>(), rule, {0, 0, 1});
      EXPECT_LT(difference(p, "harmonic", {}, dirichlet(3)), 1e-12) << where;
      EXPECT_LT(difference(p, "frank-oseen", curl, frank_oseen), 1e-12) << where;
      if (where == "solid") continue;
      const std::string skyrmion = dirichlet(3) + "+ 0.7*(u[0]*c0 + u[1]*c1 + u[2]*c2) + 1.3/2*(u[0]^2 + u[1]^2 + (u[2] - 1)^2)";
      EXPECT_LT(difference(p, "chiral-skyrmion", curl, skyrmion), 1e-12) << where;
    }
}

TEST(Density, IsTheCompiledOneOfMapsIntoOtherManifolds) {
  for (const std::string where : {"plane", "sphere"}) {
    MapProblem rotations = map_problem(where, manifold_ops<Rotation>(), Rule::geodesic, {1, 0, 0, 0}, 1);
    EXPECT_LT(difference(rotations, "harmonic", {}, "4*" + dirichlet(4)), 1e-12) << where;
    EXPECT_LT(difference(rotations, "harmonic", {}, "(u.k1[0]^2 + u.k1[1]^2 + u.k1[2]^2 + u.k2[0]^2 + u.k2[1]^2 + u.k2[2]^2)/2"), 1e-12) << where;
  }
  // The metric of H^2 is that of Minkowski's space, that of SPD(2) tr (p^-1 a p^-1 a), both in charts that are not closed forms.
  MapProblem plane = map_problem("plane", manifold_ops<Hyperbolic<2>>(), Rule::geodesic, {1, 0, 0}, 1);
  EXPECT_LT(difference(plane, "harmonic", {}, "(u[1].x^2 + u[1].y^2 + u[2].x^2 + u[2].y^2 - u[0].x^2 - u[0].y^2)/2"), 1e-12);
  MapProblem matrices = map_problem("plane", manifold_ops<Spd<2>>(), Rule::geodesic, {1, 0, 0, 1}, 1);
  std::vector<std::string> let{"d = u[0]*u[3] - u[1]*u[2]"};
  std::string density;
  for (const std::string axis : {"x", "y"}) {  // p^-1 a = m/d
    const std::string m = "m" + axis;
    let.push_back(m + "00 = u[3]*u[0]." + axis + " - u[1]*u[2]." + axis);
    let.push_back(m + "01 = u[3]*u[1]." + axis + " - u[1]*u[3]." + axis);
    let.push_back(m + "10 = u[0]*u[2]." + axis + " - u[2]*u[0]." + axis);
    let.push_back(m + "11 = u[0]*u[3]." + axis + " - u[2]*u[1]." + axis);
    density += (density.empty() ? "(" : " + ") + m + "00^2 + 2*" + m + "01*" + m + "10 + " + m + "11^2";
  }
  EXPECT_LT(difference(matrices, "harmonic", let, density + ")/(2*d^2)"), 1e-12);
}

TEST(Density, IsTheCompiledRod) {
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    BodyProblem p(moved_mesh("interval", {{"cells", {3}}, {"length", {2}}}, ""), manifold_ops<Rotation>(), rule, 2, 1);
    // The interval is along x, the third director too.
    p.set_other([](const Vec3<double>&) { return quaternion_of_rotation_vector(Vec3<double>{{0, std::numbers::pi / 2, 0}}); });
    p.start_here();
    p.input.quadrature_degree[CellKind::line] = 5;
    p.perturb(0.1, 0.3);
    p.input.parameters = {{"A[0]", 3.0}, {"A[1]", 2.0}, {"A[2]", 7.0}, {"K[0]", 0.5}, {"K[1]", 0.8}, {"K[2]", 0.3}};
    const auto along = [](const std::string& d) { return "m[0].x*q." + d + "[0] + m[1].x*q." + d + "[1] + m[2].x*q." + d + "[2]"; };
    EXPECT_LT(difference(p, "cosserat-rod", {"v1 = " + along("d1"), "v2 = " + along("d2"), "v3 = " + along("d3") + " - 1"},
                         "(3*v1^2 + 2*v2^2 + 7*v3^2 + 0.5*q.k1[0]^2 + 0.8*q.k1[1]^2 + 0.3*q.k1[2]^2)/2"),
              1e-12);
  }
}

TEST(Density, ObeysTheLawsOfAnEnergyAlsoWhereItIsChosenBetweenFormulas) {
  BodyProblem p(mesh("sphere"), manifold_ops<Rotation>(), Rule::geodesic, 2, 1);
  p.perturb(0.1, 0.3);
  p.input.t = 0.3;
  app::Scope scope;
  scope.define("stiffness", scope.compile("2 + x^2 + t", "stiffness", {}), {});
  p.input.formula = formula(
      p.input, {"s = sqrt(m[0].x + 4)", "root = sqrt(q.d3[2] - 0.2)"},
      "stiffness*s*(q.k1[0]^2 + exp(q.k2[1]/3)) + atan2(m[0], 5 + m[1]^2) + abs(m[2].z - 3)^2.5 + (q.d3[2] > 0.3 ? root^3 : q.d1[0]*m[0])", scope);
  p.make("expression");
  for (const std::string& broken : energy_laws(*p.functional, p.u)) ADD_FAILURE() << broken;
}

}  // namespace
}  // namespace karcher
