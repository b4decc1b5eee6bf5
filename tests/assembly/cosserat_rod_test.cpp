#include "karcher/energy/cosserat_rod.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assembly/body_problem.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using testing::BodyProblem;
using testing::Dense;
using Point3 = Vec3<double>;

constexpr double radius = 2, pitch = 0.7;

/// An arc length of s on a helix, and a section that turns about it.
Point3 helix(double s) {
  const double c = std::hypot(radius, pitch), a = s / c;
  return {{radius * std::cos(a), radius * std::sin(a), pitch * a}};
}
Quaternion<double> helix_frame(double s) {
  const double c = std::hypot(radius, pitch), a = s / c;
  const Point3 tangent{{-radius / c * std::sin(a), radius / c * std::cos(a), pitch / c}}, normal{{-std::cos(a), -std::sin(a), 0}};
  const Point3 binormal = cross(tangent, normal);
  Mat3<double> r;
  for (int i = 0; i < 3; ++i) r(i, 0) = normal[i], r(i, 1) = binormal[i], r(i, 2) = tangent[i];
  return quaternion_product(Rotation::from_matrix(r), quaternion_of_rotation_vector(Point3{{0, 0, 0.4 * s}}));
}

std::shared_ptr<const Mesh> interval(int cells, int order, double length = 3) {
  return testing::moved_mesh("interval", {{"cells", {static_cast<double>(cells)}}, {"order", {static_cast<double>(order)}}, {"length", {length}}},
                             "");
}

void set_stiffnesses(TermInput& input) {
  input.parameters = {{"A[0]", 3.0}, {"A[1]", 2.0}, {"A[2]", 7.0}, {"K[0]", 0.5}, {"K[1]", 0.8}, {"K[2]", 0.3}};
  input.parameters["A[1]"].function = [](const Point3& x, double) { return 2 + 0.1 * x[0]; };
}

/// A rod wound to a helix, its start.
BodyProblem wound(Rule rule, int order, int cells = 5) {
  BodyProblem p(interval(cells, order), manifold_ops<Rotation>(), rule, order);
  p.input.reference_position = [](const Point3& x) { return helix(x[0]); };
  p.input.reference_order = order;
  p.set_deformation([](const Point3& x) { return helix(x[0]); });
  p.set_other([](const Point3& x) { return helix_frame(x[0]); });
  set_stiffnesses(p.input);
  p.start_here();
  p.make("cosserat-rod");
  return p;
}

TEST(CosseratRod, IsFreeOfStressWhereItStartsHoweverItIsCurvedAndTwisted) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const int order : {1, 2, 3}) {
      BodyProblem p = wound(rule, order);
      EXPECT_LT(p.energy(), 1e-28) << order;
      EXPECT_LT(p.largest_force(), 1e-13) << order;
      EXPECT_EQ(p.term().stress_free(1), p.u.values[1]);
    }
}

TEST(CosseratRod, ObeysTheLawsOfAnEnergy) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const int order : {1, 2, 3}) {
      BodyProblem p = wound(rule, order);
      p.perturb(0.1, 0.3);
      for (const std::string& broken : energy_laws(*p.functional, p.u)) ADD_FAILURE() << broken << " Order " << order;
    }
}

/// The same density, of which nobody knows that it is one of body strains.
template <class P>
struct Plain {
  CosseratRod<P> rod;
  static Plain of(std::span<const P> p) { return {CosseratRod<P>::of(p)}; }
  template <class M, class Q>
  auto operator()(const M& m, const Q& q) const {
    return rod(m, q);
  }
};

TEST(CosseratRod, HasTheDerivativesThatJetsInTheCoordinatesOfItsFieldsGive) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const int order : {1, 2, 3}) {
      BodyProblem p(interval(3, order), manifold_ops<Rotation>(), rule, order);
      p.input.parameters = {{"A[0]", 3.0}, {"A[1]", 2.0}, {"A[2]", 7.0}, {"K[0]", 0.5}, {"K[1]", 0.8}, {"K[2]", 0.3}};
      std::vector<std::string> keys;
      for (const char* name : {"A", "K", "v0", "u0"})
        for (int i = 0; i < 3; ++i) {
          keys.push_back(std::string(name) + "[" + std::to_string(i) + "]");
          p.input.parameters.try_emplace(keys.back(), 0.1 * (i + 1));
        }
      p.perturb(0.2, 0.5);
      const auto dense = [&]<template <class> class Density>() {
        using M = LinearInterpolation<Euclidean<3>, 1, NativeScalar>;
        p.make(with_rule<Rotation, 1>(p.field(1), [&]<class I>() -> std::unique_ptr<Term> {
          return std::make_unique<DensityTerm<VaryingDensity<Density>, 1, M, I>>(TermInfo{"rod", {}, {}, false, {}}, p.input,
                                                                                 VaryingDensity<Density>{}, keys);
        }));
        return Dense(p);
      };
      EXPECT_LT(largest_difference(dense.template operator()<CosseratRod>(), dense.template operator()<Plain>()), 1e-12) << order;
    }
}

TEST(CosseratRod, IsTheSameAfterARigidMotion) {
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    BodyProblem p = wound(rule, 2);
    p.perturb(0.1, 0.3);
    EXPECT_LT(testing::change_by_rigid_motions(p), 1e-12);
  }
}

TEST(CosseratRod, TellsShearStretchBendingAndTwistApart) {
  auto mesh = std::make_shared<Mesh>(generate({"interval", {{"cells", {4}}, {"length", {1.5}}}, {{"axis", "z"}}}));
  const auto parts = [&](const auto& deformation, const auto& rotation) {
    BodyProblem q(mesh, manifold_ops<Rotation>(), Rule::geodesic, 1);
    q.input.parameters = {{"A[0]", 3.0}, {"A[1]", 2.0}, {"A[2]", 7.0}, {"K[0]", 0.5}, {"K[1]", 0.8}, {"K[2]", 0.3}};
    q.set_deformation(deformation);
    q.set_other([&](const Point3& x) { return quaternion_of_rotation_vector(Point3(rotation(x))); });
    q.make("cosserat-rod");
    return q.term().part_energies(q.u);
  };
  const double l = 1.5;
  const auto strained = parts([](const Point3& x) { return Point3{{0.2 * x[2], -0.1 * x[2], 1.3 * x[2]}}; }, [](const Point3&) { return Point3{}; });
  EXPECT_NEAR(strained[0], l * 0.5 * (3 * 0.04 + 2 * 0.01), 1e-14);
  EXPECT_NEAR(strained[1], l * 0.5 * 7 * 0.09, 1e-14);
  EXPECT_NEAR(strained[2] + strained[3], 0, 1e-28);
  const auto twisted = parts([](const Point3& x) { return x; }, [](const Point3& x) { return Point3{{0, 0, 0.7 * x[2]}}; });
  EXPECT_NEAR(twisted[3], l * 0.5 * 0.3 * 0.49, 1e-14);
  EXPECT_NEAR(twisted[0] + twisted[1] + twisted[2], 0, 1e-28);
  const auto bent = parts([](const Point3& x) { return x; }, [](const Point3& x) { return Point3{{0, 0.6 * x[2], 0}}; });
  EXPECT_NEAR(bent[2], l * 0.5 * 0.8 * 0.36, 1e-14);
  EXPECT_NEAR(bent[3], 0, 1e-28);
}

TEST(CosseratRod, HasTheStiffnessesOfItsSection) {
  auto mesh = std::make_shared<Mesh>(generate({"interval", {{"cells", {1}}, {"length", {1}}}, {{"axis", "z"}}}));
  const double young = 9, poisson = 0.25, shear = young / 2.5, k = 0.8;
  /// A_1, A_2, A_3, K_1, K_2, K_3
  const auto stiffnesses = [&](const std::string& section, ParameterValues numbers) {
    std::vector<double> found;
    numbers.insert({{"young", young}, {"poisson", poisson}, {"shear_correction", k}, {"torsion_correction", 1.0}});
    for (int i = 0; i < 6; ++i) {
      BodyProblem p(mesh, manifold_ops<Rotation>(), Rule::geodesic, 1);
      p.input.parameters = numbers;
      p.input.choices = {{"section", section}};
      Point3 strain, turn;
      (i < 3 ? strain : turn)[i % 3] = 1;
      p.set_deformation([&](const Point3& x) { return x + x[2] * strain; });
      p.set_other([&](const Point3& x) { return quaternion_of_rotation_vector(x[2] * turn); });
      if (i >= 3) p.set_deformation([](const Point3& x) { return x; });
      p.make("cosserat-rod");
      const auto parts = p.term().part_energies(p.u);
      found.push_back(2 * parts[static_cast<std::size_t>(i < 2 ? 0 : i == 2 ? 1 : i < 5 ? 2 : 3)]);
    }
    return found;
  };
  const auto expect = [](const std::vector<double>& found, const std::vector<double>& expected) {
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i] / expected[i], 1, 1e-13) << i;
  };
  const double w = 0.3, h = 0.2, r = 0.4, t = 0.1, i = r - t;
  const double wh3 = w * h * h * h / 12, w3h = w * w * w * h / 12;
  expect(stiffnesses("rectangle", {{"width", w}, {"height", h}}),
         {k * shear * w * h, k * shear * w * h, young * w * h, young * wh3, young * w3h, shear * (wh3 + w3h)});
  const double disc = pi * r * r, disc2 = pi * std::pow(r, 4) / 4, ring = pi * (r * r - i * i), ring2 = pi * (std::pow(r, 4) - std::pow(i, 4)) / 4;
  expect(stiffnesses("circle", {{"radius", r}}), {k * shear * disc, k * shear * disc, young * disc, young * disc2, young * disc2, shear * 2 * disc2});
  expect(stiffnesses("tube", {{"radius", r}, {"wall", t}}),
         {k * shear * ring, k * shear * ring, young * ring, young * ring2, young * ring2, shear * 2 * ring2});
}

TEST(CosseratRod, RefusesDirectorsAcrossTheRod) {
  BodyProblem p(interval(2, 1), manifold_ops<Rotation>(), Rule::projection, 1);
  set_stiffnesses(p.input);
  try {
    p.make("cosserat-rod");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("The third director of the initial rotation must be along the rod"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("90 degrees"), std::string::npos) << e.what();
  }
}

TEST(CosseratRod, TellsItsStrains) {
  BodyProblem p = wound(Rule::geodesic, 3, 2);
  ASSERT_EQ(p.term().info().quantities.size(), 2u);
  // Stretched by 1.1: v - v0 = 0.1 v0 = 0.1 e_3, up to the directors' interpolation.
  p.set_deformation([](const Point3& x) { return 1.1 * helix(x[0]); });
  const auto quantities = p.term().batch_quantities(p.u, 0);
  EXPECT_NEAR(quantities[2][0], 0.1, 1e-4);
  EXPECT_NEAR(quantities[0][0], 0, 1e-3);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(quantities[i][0], 0, 1e-13);
}

}  // namespace
}  // namespace karcher
