#include "karcher/energy/cosserat_plate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/body_problem.hpp"
#include "assembly/large_stack.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using testing::BodyProblem;
using testing::Dense;
using Point3 = Vec3<double>;

constexpr double h = 0.4, mu = 1.3, lambda = 0.9, mu_c = 0.5, L_c = 0.3, plane = mu * lambda / (2 * mu + lambda);

std::shared_ptr<const Mesh> sheet(const std::string& shape = "triangle") {
  return testing::moved_mesh("rectangle", {{"cells", {2, 2}}, {"size", {3, 3}}, {"order", {1}}}, shape, 0.1, 2);
}

BodyProblem plate(Rule rule, int order, double p = 1, const std::string& shape = "triangle") {
  BodyProblem b(sheet(shape), manifold_ops<Rotation>(), rule, order);
  b.input.parameters = {{"thickness", h}, {"mu", mu}, {"lambda", lambda}, {"mu_c", mu_c}, {"L_c", L_c}, {"p", p}};
  b.input.parameters["thickness"].function = [](const Point3& x, double) { return h + 0.03 * x[0]; };
  return b;
}

/// The density at homogeneous strains.
double density(const Point3& v1, const Point3& v2, const Point3& u1, const Point3& u2, double p = 1) {
  BodyStrains<2, double> e;
  e.v = {v1, v2};
  e.u = {u1, u2};
  double w = 0;
  CosseratPlate<double>{h, mu, lambda, mu_c, L_c, p}.add_energy(w, e);
  return w;
}
const Point3 e1{{1, 0, 0}}, e2{{0, 1, 0}};

TEST(CosseratPlate, HasTheClosedFormsOfStretchAndShear) {
  const double a = 1.3, b = 0.8, det = a * b;
  EXPECT_NEAR(density(a * e1, b * e2, {}, {}), h * (mu * (0.3 * 0.3 + 0.2 * 0.2) + plane * 0.5 * (std::pow(det - 1, 2) + std::pow(1 / det - 1, 2))),
              1e-15);
  // d_2 m = e_2 + s e_1: sym and skew have s/2 off the diagonal.
  EXPECT_NEAR(density(e1, e2 + 0.6 * e1, {}, {}), h * (mu + mu_c) * 0.5 * 0.36, 1e-15);
  EXPECT_NEAR(density(e1 + Point3{{0, 0, 0.6}}, e2, {}, {}), h * (mu + mu_c) * 0.5 * 0.36, 1e-15);
}

TEST(CosseratPlate, RollsToACylinderAtTheCostOfItsBendingAndOfItsCurvatureOnTopOfIt) {
  // m = (sin kx/k, y, (1 - cos kx)/k), R about -e_2 by kx: [h^3/12 (mu + mu lambda/(lambda + 2 mu)) + 2 h mu L_c^2] k^2 for p = 1; |K|^2 = 2 k^2 for all p.
  const double k = 0.7;
  for (const double p : {1.0, 1.5, 2.0, 3.0})
    EXPECT_NEAR(density(e1, e2, -k * e2, {}, p), h * h * h / 12 * (mu + plane) * k * k + h * mu * std::pow(L_c * std::sqrt(2) * k, 1 + p), 1e-15)
        << p;
  // Twist: sym K_b alone.
  EXPECT_NEAR(density(e1, e2, k * e1, -k * e2), h * h * h / 12 * 2 * mu * k * k + h * mu * L_c * L_c * 4 * k * k, 1e-15);
  // Drilling turns no normal.
  EXPECT_NEAR(density(e1, e2, Point3{{0, 0, k}}, {}), h * mu * L_c * L_c * 2 * k * k, 1e-15);
}

TEST(CosseratPlate, ObeysTheLawsOfAnEnergyForEveryPower) {
  for (const double p : {1.0, 1.4, 2.0, 3.0}) {
    BodyProblem b = plate(p == 1.4 ? Rule::geodesic : Rule::projection, p == 1 ? 1 : 2, p, p == 2 ? "quadrilateral" : "triangle");
    b.make("cosserat-plate");
    b.perturb(0.05, 0.3);
    for (const std::string& broken : energy_laws(*b.functional, b.u)) ADD_FAILURE() << broken << " p = " << p;
  }
}

TEST(CosseratPlate, IsSmoothAndWithoutForcesAtTheReferenceForEveryPower) {
  for (const double p : {1.0, 1.4, 2.0}) {
    BodyProblem b = plate(Rule::projection, 2, p);
    b.make("cosserat-plate");
    const Dense d(b);
    EXPECT_LT(std::fabs(d.evaluation.energy), 1e-28);
    for (const double g : d.gradient) EXPECT_LT(std::fabs(g), 1e-14);
    for (const auto& row : d.hessian)
      for (const double x : row) EXPECT_TRUE(std::isfinite(x));
  }
}

/// The same density, of which nobody knows that it is one of body strains.
template <class P>
struct PlainPlate {
  CosseratPlate<P> plate;
  static PlainPlate of(std::span<const P> p) { return {CosseratPlate<P>::of(p)}; }
  template <class M, class Q>
  auto operator()(const M& m, const Q& q) const {
    return plate(m, q);
  }
};

TEST(CosseratPlate, HasTheDerivativesThatJetsInTheCoordinatesOfItsFieldsGive) {
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    BodyProblem b = plate(rule, 2, 1.6);
    b.perturb(0.05, 0.4);
    const auto dense = [&]<template <class> class Density>() {
      using M = LinearInterpolation<Euclidean<3>, 2, NativeScalar>;
      b.make(with_rule<Rotation, 2>(b.field(1), [&]<class I>() -> std::unique_ptr<Term> {
        return std::make_unique<DensityTerm<VaryingDensity<Density>, 2, M, I>>(
            TermInfo{"plate", {}, {}, false, {}}, b.input, VaryingDensity<Density>{},
            std::vector<std::string>{"thickness", "mu", "lambda", "mu_c", "L_c", "p"});
      }));
      std::unique_ptr<Dense> d;
      testing::with_large_stack([&] { d = std::make_unique<Dense>(b); });
      return *d;
    };
    EXPECT_LT(largest_difference(dense.template operator()<CosseratPlate>(), dense.template operator()<PlainPlate>()), 1e-11);
  }
}

TEST(CosseratPlate, HasTheStiffnessOfTheCurvedShellOnAFlatSheet) {
  // b = (2, 2, 2/3) gives the shell 2 |K|^2 = |R^T grad R|^2, as the plate has it.
  BodyProblem b = plate(Rule::projection, 2);
  b.make("cosserat-plate");
  const Dense flat(b);
  b.input.parameters.insert({{"b[0]", 2.0}, {"b[1]", 2.0}, {"b[2]", 2.0 / 3}});
  b.input.choices = {{"coupling", "default"}};
  for (const CellKind kind : {CellKind::triangle, CellKind::quadrilateral}) b.input.quadrature_degree[kind] = 8;
  b.make("cosserat-shell");
  const Dense curved(b);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < flat.gradient.size(); ++i)
    for (std::size_t j = 0; j < flat.gradient.size(); ++j) {
      largest = std::max(largest, std::fabs(curved.hessian[i][j]));
      difference = std::max(difference, std::fabs(curved.hessian[i][j] - flat.hessian[i][j]));
    }
  EXPECT_LT(difference, 1e-12 * largest);
}

TEST(CosseratPlate, IsTheSameAfterARigidMotion) {
  BodyProblem b = plate(Rule::geodesic, 2, 2);
  b.make("cosserat-plate");
  b.perturb(0.05, 0.3);
  EXPECT_LT(testing::change_by_rigid_motions(b), 1e-12);
}

TEST(CosseratPlate, IsInfiniteWhereTheAreaVanishesOrTurnsOverAndNamesTheCell) {
  for (const double width : {0.0, -0.5})
    for (const double l : {lambda, 0.0}) {
      BodyProblem b = plate(Rule::projection, 1);
      b.input.parameters["lambda"] = l;
      b.make("cosserat-plate");
      b.set_deformation([&](const Point3& x) { return Point3{{width * x[0], x[1], 0}}; });
      std::vector<double> g(b.dofs());
      BlockMatrix hessian = b.functional->make_matrix();
      for (const Evaluation& e : {b.functional->energy(b.u), b.functional->gradient(b.u, g), b.functional->hessian(b.u, g, hessian)}) {
        ASSERT_TRUE(e.failure);
        EXPECT_EQ(e.failure->trouble, Trouble::infinite_energy);
        EXPECT_NE(e.failure->sentence().find("cell"), std::string::npos) << e.failure->sentence();
      }
    }
}

TEST(CosseratPlate, TakesAFlatReferenceInThePlaneAndNoNegativeLambda) {
  const auto refusal = [](BodyProblem b) -> std::string {
    try {
      b.make("cosserat-plate");
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  };
  BodyProblem curved = plate(Rule::projection, 2);
  curved.input.reference_position = [](const Point3& x) { return Point3{{x[0], x[1], 0.1 * x[0] * x[0]}}; };
  EXPECT_NE(refusal(std::move(curved)).find("must lie in the plane z = 0, but has the point ("), std::string::npos);
  BodyProblem negative = plate(Rule::projection, 2);
  negative.input.parameters["lambda"] = -0.1;
  EXPECT_NE(refusal(std::move(negative)).find("lambda is -0.1"), std::string::npos);
}

TEST(CosseratPlate, TellsTheSizeOfItsStrains) {
  BodyProblem b = plate(Rule::projection, 1);
  b.make("cosserat-plate");
  b.set_deformation([](const Point3& x) { return Point3{{1.3 * x[0], x[1], 0}}; });
  EXPECT_NEAR(b.term().batch_quantities(b.u, 0)[0][0], 0.3, 1e-14);
  EXPECT_EQ(b.term().info().quantities[0].small_up_to, 0.2);
}

}  // namespace
}  // namespace karcher
