#include "app/point_value.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/manifold/rotation.hpp"

namespace karcher::app {
namespace {

Value array(std::vector<double> numbers) {
  std::vector<Value> items;
  for (const double d : numbers) items.push_back(Value::of(d));
  return Value::of(items);
}

std::vector<double> point(const char* manifold, const Value& value) {
  const ManifoldOps& m = manifold_by_name(manifold);
  std::vector<double> p(static_cast<std::size_t>(m.ambient));
  PointValue(value, "key", m, Scope()).evaluate({}, 0, p.data());
  return p;
}

std::vector<double> error_coordinates_of(const ManifoldOps& m, const std::vector<double>& p) {
  std::vector<double> x(static_cast<std::size_t>(m.error_size));
  m.error_coordinates(p.data(), x.data());
  return x;
}

TEST(PointValue, SpheresAreNormalised) {
  const std::vector<double> p = point("S2", array({0, 3, 4}));
  EXPECT_NEAR(p[0], 0, 1e-15);
  EXPECT_NEAR(p[1], 0.6, 1e-15);
  EXPECT_NEAR(p[2], 0.8, 1e-15);
}

TEST(PointValue, ARotationIsAVectorAMatrixOrAQuaternion) {
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  const std::vector<double> by_vector = point("SO3", array({0, 0, angle}));
  const std::vector<double> by_matrix = point("SO3", array({2 * c, -2 * s, 0, 2 * s, 2 * c, 0, 0, 0, 2}));
  const std::vector<double> by_quaternion = point("SO3", array({std::cos(angle / 2), 0, 0, std::sin(angle / 2)}));
  const ManifoldOps& m = manifold_by_name("SO3");
  EXPECT_LT(m.dist(by_vector.data(), by_matrix.data()), 1e-14);
  EXPECT_LT(m.dist(by_vector.data(), by_quaternion.data()), 1e-14);
  EXPECT_NEAR(by_vector[3], std::sin(angle / 2), 1e-15);
}

TEST(PointValue, IdentityIsThatOfTheGroup) {
  EXPECT_EQ(point("SO3", Value::of("identity")), (std::vector<double>{1, 0, 0, 0}));
  EXPECT_EQ(point("SPD2", Value::of("identity")), (std::vector<double>{1, 0, 0, 1}));
  EXPECT_THROW(point("S2", Value::of("identity")), InputError);
}

TEST(PointValue, WhatIsNoPointIsRefused) {
  EXPECT_THROW(point("S2", array({0, 0, 0})), InputError);
  EXPECT_THROW(point("S2", array({1, 0})), InputError);
  EXPECT_THROW(point("SPD2", array({1, 2, 2, 1})), InputError);
  EXPECT_THROW(point("SO3", array({1, 0, 0, 0, 1, 0, 0, 0, -1, 0})), InputError);
  EXPECT_THROW(point("R3", Value::of(1.0)), InputError);
}

TEST(PointValue, DerivativesOfARotationVectorAreThoseOfTheMatrix) {
  const ManifoldOps& m = manifold_by_name("SO3");
  std::vector<Value> items{Value::of("0.3*x"), Value::of("y^2"), Value::of("x*y")};
  const PointValue value(Value::of(items), "key", m, Scope());
  const Vec3<double> x{{0.4, 0.8, 0}};
  const auto exact = value.with_derivatives(x, 0);
  const double h = 1e-5;
  for (int k = 0; k < 2; ++k) {
    Vec3<double> high = x, low = x;
    high[k] += h;
    low[k] -= h;
    std::vector<double> p(4), q(4), middle(4);
    value.evaluate(high, 0, p.data());
    value.evaluate(low, 0, q.data());
    value.evaluate(x, 0, middle.data());
    std::vector<double> slope(4);
    for (std::size_t i = 0; i < 4; ++i) slope[i] = (p[i] - q[i]) / (2 * h);
    const std::vector<double> a = error_coordinates_of(m, middle);
    std::vector<double> b(9);
    m.error_derivative(middle.data(), slope.data(), b.data());
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(exact[i].v, a[i], 1e-14);
      EXPECT_NEAR(exact[i].d[static_cast<std::size_t>(k)], b[i], 1e-9);
    }
  }
}

TEST(PointValue, ErrorCoordinatesOfRotationsMeasureAngles) {
  const ManifoldOps& m = manifold_by_name("SO3");
  const std::vector<double> p = point("SO3", array({0.1, 0.2, 0.3})), q = point("SO3", array({0.1, 0.2, 0.3001}));
  const auto a = error_coordinates_of(m, p), b = error_coordinates_of(m, q);
  double d2 = 0;
  for (std::size_t i = 0; i < 9; ++i) d2 += (a[i] - b[i]) * (a[i] - b[i]);
  EXPECT_NEAR(std::sqrt(d2) / m.dist(p.data(), q.data()), 1, 1e-8);
}

}  // namespace
}  // namespace karcher::app
