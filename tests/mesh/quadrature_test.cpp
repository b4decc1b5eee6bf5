#include "karcher/mesh/quadrature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "karcher/error.hpp"
#include "mesh/cells.hpp"

namespace karcher {
namespace {

/// Integral of x^a y^b z^c over the reference cell: a! b! c! / (a + b + c + dim)! on simplices, 1 / ((a + 1) (b + 1) (c + 1)) on cubes.
double exact(CellKind kind, const std::array<int, 3>& e) {
  if (!is_simplex(kind)) return 1.0 / ((e[0] + 1) * (e[1] + 1) * (e[2] + 1));
  const auto log_factorial = [](int n) { return std::lgamma(static_cast<double>(n) + 1); };
  return std::exp(log_factorial(e[0]) + log_factorial(e[1]) + log_factorial(e[2]) - log_factorial(e[0] + e[1] + e[2] + dimension(kind)));
}

double integral(const Quadrature& rule, const std::array<int, 3>& e) {
  double sum = 0;
  for (std::size_t i = 0; i < rule.weights.size(); ++i)
    sum += rule.weights[i] * std::pow(rule.points[i][0], e[0]) * std::pow(rule.points[i][1], e[1]) * std::pow(rule.points[i][2], e[2]);
  return sum;
}

TEST(Quadrature, IntegratesEveryMonomialOfItsDegreeExactly) {
  for (CellKind kind : all_kinds)
    for (int degree = 0; degree <= 16; ++degree) {
      const Quadrature& rule = quadrature(kind, degree);
      for (const auto& e : exponents(kind, degree)) EXPECT_NEAR(integral(rule, e), exact(kind, e), 1e-14) << name(kind) << " degree " << degree;
    }
}

TEST(Quadrature, DoesNotIntegrateOneDegreeMoreOnAPlainGaussRule) {
  const Quadrature& rule = quadrature(CellKind::line, 5);  // three points
  EXPECT_EQ(rule.size(), 3);
  EXPECT_GT(std::abs(integral(rule, {6, 0, 0}) - 1.0 / 7), 1e-5);
}

TEST(Quadrature, HasPositiveWeightsAndInteriorPoints) {
  for (CellKind kind : all_kinds)
    for (int degree = 0; degree <= 40; ++degree) {
      const Quadrature& rule = quadrature(kind, degree);
      EXPECT_NEAR(std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0), reference_measure(kind), 2e-14);
      for (int i = 0; i < rule.size(); ++i) {
        const Vec3<double>& x = rule.points[static_cast<std::size_t>(i)];
        EXPECT_GT(rule.weights[static_cast<std::size_t>(i)], 0);
        double sum = 0;
        for (int a = 0; a < dimension(kind); ++a) {
          EXPECT_GT(x[a], 0);
          EXPECT_LT(x[a], 1);
          sum += x[a];
        }
        EXPECT_LT(sum, is_simplex(kind) ? 1 : 3);
      }
    }
}

TEST(Quadrature, ProductRulesHaveTheNumberOfPointsOfTheContract) {
  for (int degree = 0; degree <= 20; ++degree) {
    const int n = std::max(1, (degree + 2) / 2);  // ceil((d + 1) / 2)
    EXPECT_EQ(quadrature(CellKind::line, degree).size(), n);
    EXPECT_EQ(quadrature(CellKind::quadrilateral, degree).size(), n * n);
    EXPECT_EQ(quadrature(CellKind::hexahedron, degree).size(), n * n * n);
  }
}

TEST(Quadrature, DegreesOneAndTwoOnTheTriangleAreThoseOfTheContract) {
  const Quadrature& one = quadrature(CellKind::triangle, 1);
  ASSERT_EQ(one.size(), 1);
  EXPECT_LT(norm2(one.points[0] - Vec3<double>{{1. / 3, 1. / 3, 0}}), 1e-32);
  const Quadrature& two = quadrature(CellKind::triangle, 2);
  ASSERT_EQ(two.size(), 3);
  for (const Vec3<double>& expected : {Vec3<double>{{1. / 6, 1. / 6, 0}}, Vec3<double>{{2. / 3, 1. / 6, 0}}, Vec3<double>{{1. / 6, 2. / 3, 0}}})
    EXPECT_TRUE(std::any_of(two.points.begin(), two.points.end(), [&](const Vec3<double>& x) { return norm2(x - expected) < 1e-32; }));
}

TEST(Quadrature, SimplexRulesHaveTheNumbersOfPointsOfWitherdenAndVincent) {
  // Computers and Mathematics with Applications 69 (2015), tables 1 and 2; degrees without a rule of their own take the next one.
  const std::vector<int> triangle = {1, 1, 3, 6, 6, 7, 12, 15, 16, 19, 25, 28, 33, 37, 42}, tetrahedron = {1, 1, 4, 8, 14, 14, 24, 35, 46};
  for (std::size_t d = 0; d < triangle.size(); ++d) EXPECT_EQ(quadrature(CellKind::triangle, static_cast<int>(d)).size(), triangle[d]);
  for (std::size_t d = 0; d < tetrahedron.size(); ++d) EXPECT_EQ(quadrature(CellKind::tetrahedron, static_cast<int>(d)).size(), tetrahedron[d]);
}

TEST(Quadrature, SimplexRulesAreSymmetricUnderAllPermutationsOfTheVertices) {
  for (CellKind kind : {CellKind::triangle, CellKind::tetrahedron})
    for (int degree = 0; degree <= (kind == CellKind::triangle ? 14 : 8); ++degree) {
      const Quadrature& rule = quadrature(kind, degree);
      const int dim = dimension(kind);
      for (std::size_t i = 0; i < rule.points.size(); ++i) {
        std::array<double, 4> b{};
        b[0] = 1;
        for (int a = 0; a < dim; ++a) {
          b[static_cast<std::size_t>(a + 1)] = rule.points[i][a];
          b[0] -= rule.points[i][a];
        }
        for (int swap = 0; swap < dim; ++swap) {  // neighbouring swaps generate all permutations
          std::array<double, 4> c = b;
          std::swap(c[static_cast<std::size_t>(swap)], c[static_cast<std::size_t>(swap + 1)]);
          bool found = false;
          for (std::size_t j = 0; j < rule.points.size() && !found; ++j) {
            const Vec3<double> d = rule.points[j] - Vec3<double>{{c[1], c[2], dim > 2 ? c[3] : 0.0}};
            found = norm2(d) < 1e-28 && rule.weights[j] == rule.weights[i];
          }
          EXPECT_TRUE(found) << name(kind) << " degree " << degree;
        }
      }
    }
}

TEST(Quadrature, RefusesDegreesThatItDoesNotHave) {
  EXPECT_THROW(quadrature(CellKind::triangle, -1), InputError);
  EXPECT_THROW(quadrature(CellKind::line, 41), InputError);
}

}  // namespace
}  // namespace karcher
