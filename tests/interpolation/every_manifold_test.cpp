// Both rules on every manifold: exact variations, and the reference values of means that have a closed form.
#include "karcher/manifold/every_manifold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "interpolation_laws.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"

namespace karcher {
namespace {

template <class M, template <class, int, class> class Rule>
void expect_exact(double spread, double tolerance) {
  testing::expect_exact_derivatives<Rule<M, 2, double>>(M::origin(), spread);
  testing::expect_exact_variations<Rule<M, 2, double>, 2>(M::origin(), spread, tolerance);
}

template <class M>
Point<M> mean(const std::vector<Point<M>>& nodes, const std::vector<double>& l) {
  GeodesicInterpolation<M, 0, double> rule;
  const Weights<0, double> weights{static_cast<int>(l.size()), l.data(), nullptr};
  EXPECT_TRUE(rule.begin_cell(nodes.data(), weights.count));
  EXPECT_TRUE(rule.evaluate(nodes.data(), weights));
  return rule.jet().value;
}

}  // namespace

TEST(EveryManifold, GeodesicInterpolationHasExactVariations) {
  expect_exact<Rotation, GeodesicInterpolation>(0.4, 1e-9);
  expect_exact<Unitary, GeodesicInterpolation>(0.4, 1e-9);
  expect_exact<Hyperbolic<2>, GeodesicInterpolation>(0.4, 1e-8);
  expect_exact<Hyperbolic<3>, GeodesicInterpolation>(0.4, 1e-8);
  expect_exact<Spd<2>, GeodesicInterpolation>(0.4, 1e-8);
  expect_exact<Spd<3>, GeodesicInterpolation>(0.4, 1e-8);
  expect_exact<Product<Sphere<2>, Euclidean<1>>, GeodesicInterpolation>(0.4, 1e-9);
}

TEST(EveryManifold, ProjectionInterpolationHasExactVariations) {
  expect_exact<Rotation, ProjectionInterpolation>(0.4, 1e-9);
  expect_exact<Unitary, ProjectionInterpolation>(0.4, 1e-9);
  expect_exact<Product<Sphere<2>, Euclidean<1>>, ProjectionInterpolation>(0.4, 1e-9);
}

TEST(EveryManifold, MeansOfThreeRotationsHaveTheReferenceValues) {
  std::vector<Point<Rotation>> nodes(3);
  for (int k = 0; k < 3; ++k) {
    Vec3<double> v;
    v[k] = 1;
    nodes[static_cast<std::size_t>(k)] = Rotation::from_rotation_vector(v);
  }
  const std::vector<double> l{.5, .3, .2};
  const auto v = Rotation::to_rotation_vector(mean<Rotation>(nodes, l));
  const double geodesic[3] = {0.521812268808113, 0.31830013131652, 0.214035120468485};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(v[k], geodesic[k], 1e-12);
  ProjectionInterpolation<Rotation, 0, double> projection;
  ASSERT_TRUE(projection.begin_cell(nodes.data(), 3));
  ASSERT_TRUE(projection.evaluate(nodes.data(), {3, l.data(), nullptr}));
  const auto q = Rotation::to_rotation_vector(projection.jet().value);
  const double polar[3] = {0.545266034909888, 0.308112668562855, 0.199598226963173};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(q[k], polar[k], 1e-12);
}

TEST(EveryManifold, TheDeterminantOfAMeanIsTheMeanOfTheDeterminants) {
  // log det is linear along geodesics of the affine-invariant metric: det(mean) = product of det^weight, for weights of any sign.
  testing::Random random(5);
  const auto nodes = testing::random_nodes<Spd<3>>(random, Spd<3>::origin(), 4, 0.5);
  const std::vector<double> l{0.6, -0.2, 0.5, 0.1};
  double expected = 0;
  for (std::size_t i = 0; i < 4; ++i) expected += l[i] * std::log(determinant(Spd<3>::matrix(nodes[i])));
  EXPECT_NEAR(std::log(determinant(Spd<3>::matrix(mean<Spd<3>>(nodes, l)))), expected, 1e-12);
}

TEST(EveryManifold, TheMeanOfTwoMatricesIsTheirGeometricMean) {
  testing::Random random(6);
  const auto nodes = testing::random_nodes<Spd<3>>(random, Spd<3>::origin(), 2, 0.6);
  const auto a = Spd<3>::matrix(nodes[0]), b = Spd<3>::matrix(nodes[1]), m = Spd<3>::matrix(mean<Spd<3>>(nodes, {0.5, 0.5}));
  EXPECT_LT(std::sqrt(norm2(m * inverse(a) * m - b)), 1e-12);
}

TEST(EveryManifold, MeansOfMatricesAreEquivariantUnderCongruence) {
  testing::Random random(7);
  auto nodes = testing::random_nodes<Spd<2>>(random, Spd<2>::origin(), 3, 0.5);
  const std::vector<double> l{0.7, 0.5, -0.2};
  const auto before = Spd<2>::matrix(mean<Spd<2>>(nodes, l));
  Mat<double, 2, 2> g;
  g(0, 0) = 1.3, g(0, 1) = -0.4, g(1, 0) = 0.7, g(1, 1) = 0.9;
  for (auto& p : nodes) p = Spd<2>::point(sym(g * Spd<2>::matrix(p) * transpose(g)));
  EXPECT_LT(std::sqrt(norm2(Spd<2>::matrix(mean<Spd<2>>(nodes, l)) - g * before * transpose(g))), 1e-12);
}

}  // namespace karcher
