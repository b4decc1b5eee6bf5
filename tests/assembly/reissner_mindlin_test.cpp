#include "karcher/energy/reissner_mindlin.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/body_problem.hpp"
#include "assembly/large_stack.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using testing::BodyProblem;
using testing::Dense;
using Point3 = Vec3<double>;

constexpr double h = 0.2, mu = 1.3, lambda = 0.9, k_s = 0.8, plane = 2 * lambda * mu / (lambda + 2 * mu);

BodyProblem shell(std::shared_ptr<const Mesh> mesh, Rule rule, int order) {
  BodyProblem b(std::move(mesh), manifold_ops<Sphere<2>>(), rule, order);
  b.input.parameters = {{"thickness", h}, {"mu", mu}, {"lambda", lambda}, {"shear_correction", k_s}, {"prestretch[0]", 1.0}, {"prestretch[1]", 1.0}};
  b.input.parameters["thickness"].function = [](const Point3& x, double) { return h + 0.03 * x[0]; };
  return b;
}
std::shared_ptr<const Mesh> surface(const std::string& name, int order, const std::string& shape = "triangle") {
  GeneratorOptions options{name, {{"order", {static_cast<double>(order)}}}, {}};
  if (name == "cylinder") options.numbers["angle"] = {1.5}, options.numbers["cells"] = {3, 2};
  if (name == "sphere") options.numbers["cells"] = {2};
  if (name == "torus") options.numbers["cells"] = {6, 4};
  if (name == "rectangle") options.numbers["cells"] = {2, 2}, options.numbers["size"] = {3, 3};
  if (name != "sphere") options.words["shape"] = shape;
  return std::make_shared<Mesh>(generate(options));
}
/// With the directors that it has without stress.
BodyProblem at_rest(const std::string& name, Rule rule, int order, const std::string& shape = "triangle") {
  BodyProblem b = shell(surface(name, order, shape), rule, order);
  b.make("reissner-mindlin");
  b.u.values[1] = b.term().stress_free(1);
  return b;
}

TEST(ReissnerMindlin, HasNoEnergyAndNoForcesInItsReference) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const char* name : {"rectangle", "cylinder", "sphere", "torus"})
      for (const int order : {1, 2, 3}) {
        const BodyProblem b = at_rest(name, rule, order);
        EXPECT_LT(std::fabs(b.energy()), 1e-27) << name << order;
        EXPECT_LT(b.largest_force(), 1e-14) << name << order;
      }
}

TEST(ReissnerMindlin, HasTheNormalAsDirectorOfItsReferenceOnOneSide) {
  const BodyProblem b = at_rest("sphere", Rule::projection, 3);
  double sides = 0;
  for (int i = 0; i < b.field(1).space->node_count(); ++i) {
    const double side = dot(manifold_detail::read<3>(b.u.at(1, i, 3)), b.field(1).space->position(i));
    EXPECT_NEAR(std::fabs(side), 1, 1e-3);  // of the cubic interpolant
    sides += side > 0 ? 1 : -1;
  }
  EXPECT_EQ(std::fabs(sides), b.field(1).space->node_count());
}

TEST(ReissnerMindlin, DoesNotCareWhichWayRoundItsCellsAre) {
  auto mesh = std::make_shared<Mesh>(*surface("cylinder", 1));
  for (std::size_t c = 1; c < mesh->cells.size(); c += 2) std::swap(mesh->cells[c].nodes[1], mesh->cells[c].nodes[2]);
  for (Region* region : {&mesh->regions.at("all")})
    for (std::size_t c = 1; c < region->cells.size(); c += 2) std::swap(region->cells[c].nodes[1], region->cells[c].nodes[2]);
  BodyProblem b = shell(mesh, Rule::projection, 1), same = at_rest("cylinder", Rule::projection, 1);
  b.make("reissner-mindlin");
  for (BodyProblem* p : {&b, &same}) p->set_other([](const Point3& x) { return Point3{{x[0], x[1], 0.3}}; });
  for (BodyProblem* p : {&b, &same})
    for (double& x : p->u.values[1]) x /= std::sqrt(1.09);
  EXPECT_NEAR(b.energy() / same.energy(), 1, 1e-13);
}

TEST(ReissnerMindlin, ObeysTheLawsOfAnEnergy) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const auto& [name, order] : {std::pair("cylinder", 1), {"cylinder", 2}, {"rectangle", 2}, {"torus", 1}}) {
      BodyProblem b = at_rest(name, rule, order, rule == Rule::geodesic ? "quadrilateral" : "triangle");
      b.perturb(0.03, 0.2);
      for (const std::string& broken : energy_laws(*b.functional, b.u)) ADD_FAILURE() << broken << name << order;
    }
}

/// The same density, of which nobody knows that it is one of director strains.
template <class P>
struct PlainShell {
  ReissnerMindlin<P> shell;
  static PlainShell of(std::span<const P> p) { return {ReissnerMindlin<P>::of(p)}; }
  template <class M, class D>
  auto operator()(const M& m, const D& d) const {
    return shell(m, d);
  }
};

TEST(ReissnerMindlin, HasTheDerivativesThatJetsInTheCoordinatesOfItsFieldsGive) {
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    BodyProblem b = shell(surface("rectangle", 1), rule, 2);
    std::vector<std::string> keys{"thickness", "mu", "lambda", "shear_correction", "prestretch[0]", "prestretch[1]"};
    b.input.parameters["prestretch[0]"] = 1.1;
    b.input.parameters["prestretch[1]"] = 0.8;
    for (int i = 0; i < 6; ++i) {
      keys.push_back("strain" + std::to_string(i));
      b.input.parameters[keys.back()] = 0.1 * (i + 1);
    }
    for (const auto& [key, value] : {std::pair("diameter2", 0.3),
                                     {"membrane_constant", 1.0},
                                     {"membrane_slope", -1.0},
                                     {"shear_constant", 0.0},
                                     {"shear_slope", 1.0},
                                     {"rest", 0.5}}) {
      keys.emplace_back(key);
      b.input.parameters[key] = value;
    }
    b.perturb(0.1, 0.4);
    const auto dense = [&]<template <class> class Density>() {
      using M = LinearInterpolation<Euclidean<3>, 2, NativeScalar>;
      b.make(with_rule<Sphere<2>, 2>(b.field(1), [&]<class I>() -> std::unique_ptr<Term> {
        return std::make_unique<DensityTerm<VaryingDensity<Density>, 2, M, I>>(TermInfo{"shell", {}, {}, false, {}}, b.input,
                                                                               VaryingDensity<Density>{}, keys);
      }));
      std::unique_ptr<Dense> d;
      testing::with_large_stack([&] { d = std::make_unique<Dense>(b); });
      return *d;
    };
    EXPECT_LT(largest_difference(dense.template operator()<ReissnerMindlin>(), dense.template operator()<PlainShell>()), 1e-11);
  }
}

TEST(ReissnerMindlin, IsTheSameAfterARigidMotion) {
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    BodyProblem b = at_rest("cylinder", rule, 2);
    b.perturb(0.05, 0.3);
    const double before = b.energy();
    const Mat3<double> a = rotation_matrix(quaternion_of_rotation_vector(Point3{{0.9, -1.4, 2.3}}));
    for (std::size_t f = 0; f < 2; ++f)
      for (int i = 0; i < b.field(f).space->node_count(); ++i) {
        double* x = b.u.at(static_cast<int>(f), i, 3);
        const Point3 moved = a * manifold_detail::read<3>(x) + (f == 0 ? Point3{{3, -1, 2}} : Point3{});
        std::copy(moved.e.begin(), moved.e.end(), x);
      }
    EXPECT_NEAR(b.energy() / before, 1, 1e-12);
  }
}

TEST(ReissnerMindlin, HasTheClosedFormsOfStretchBendingAndShear) {
  /// Density at homogeneous strains of a flat sheet.
  const auto parts = [](const Point3& m1, const Point3& m2, const Point3& d, const Point3& d1, const Point3& d2) {
    FieldJet<Euclidean<3>, 2, double> m;
    m.d = {m1, m2};
    FieldJet<Sphere<2>, 2, double> n;
    n.value = d;
    n.d = {d1, d2};
    return ReissnerMindlin<double>{h, mu, lambda, k_s, {1, 1}, {}, {}}.parts(m, n);
  };
  const Point3 e1{{1, 0, 0}}, e2{{0, 1, 0}}, e3{{0, 0, 1}};
  const double s = 1.2, green = 0.5 * (s * s - 1);
  EXPECT_NEAR(parts(s * e1, e2, e3, {}, {})[0], 0.5 * h * (plane + 2 * mu) * green * green, 1e-15);
  EXPECT_NEAR(parts(e1, e2 + 0.3 * e1, e3, {}, {})[0], 0.5 * h * (plane * 0.045 * 0.045 + 2 * mu * (0.045 * 0.045 + 2 * 0.15 * 0.15)), 1e-15);
  // A cylinder of curvature k: d_1 d = -k m_1.
  const double k = 0.7;
  EXPECT_NEAR(parts(e1, e2, e3, -k * e1, {})[1], h * h * h / 24 * (plane + 2 * mu) * k * k, 1e-15);
  EXPECT_NEAR(parts(e1, e2, e3, k * e2, k * e1)[1], h * h * h / 24 * 2 * mu * 2 * k * k, 1e-15);
  const double angle = 0.4;
  EXPECT_NEAR(parts(e1, e2, std::cos(angle) * e3 + std::sin(angle) * e1, {}, {})[2], 0.5 * h * k_s * mu * std::pow(std::sin(angle), 2), 1e-15);
}

TEST(ReissnerMindlin, TakesTheInitialDirectorsAsStressFreeIfItIsTold) {
  BodyProblem b = shell(surface("cylinder", 2), Rule::geodesic, 2);
  b.perturb(0, 0.3);
  b.start_here();
  b.make("reissner-mindlin");
  EXPECT_GT(b.energy(), 1e-3);
  b.input.choices = {{"reference_director", "initial"}};
  b.make("reissner-mindlin");
  EXPECT_LT(b.energy(), 1e-28);
}

TEST(ReissnerMindlin, RefusesSurfacesWithOneSide) {
  try {
    shell(surface("moebius", 2), Rule::projection, 2).make("reissner-mindlin");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("has one side only"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace karcher
