#include <gtest/gtest.h>

#include "interpolation_laws.hpp"

namespace karcher {
namespace {

using testing::expect_exact_derivatives;
using testing::expect_exact_variations;

template <class M>
Point<M> origin() {
  Point<M> p;
  p[0] = 1;
  return p;
}

template <class M, template <class, int, class> class Rule>
void expect_exact(double spread, double tolerance) {
  expect_exact_derivatives<Rule<M, 2, double>>(origin<M>(), spread);
  expect_exact_variations<Rule<M, 1, double>, 1>(origin<M>(), spread, tolerance);
  expect_exact_variations<Rule<M, 2, double>, 2>(origin<M>(), spread, tolerance);
  expect_exact_variations<Rule<M, 3, double>, 3>(origin<M>(), spread, tolerance);
}
template <class M, int D, class T>
using ImplicitProjection = WeightedMean<M, ChordFunction, D, T>;

TEST(ProjectionInterpolation, HasExactFirstAndSecondVariations) {
  expect_exact<Euclidean<3>, ProjectionInterpolation>(0.4, 1e-10);
  expect_exact<Sphere<1>, ProjectionInterpolation>(0.4, 1e-9);
  expect_exact<Sphere<2>, ProjectionInterpolation>(0.4, 1e-9);
  expect_exact<Sphere<3>, ProjectionInterpolation>(0.4, 1e-9);
}
TEST(GeodesicInterpolation, HasExactFirstAndSecondVariations) {
  expect_exact<Sphere<1>, GeodesicInterpolation>(0.4, 1e-9);
  expect_exact<Sphere<2>, GeodesicInterpolation>(0.4, 1e-9);
  expect_exact<Sphere<3>, GeodesicInterpolation>(0.4, 1e-9);
}
TEST(WeightedMean, OfTheChordFunctionIsTheProjectionWithTheSameVariations) { expect_exact<Sphere<2>, ImplicitProjection>(0.4, 1e-9); }

TEST(Interpolation, OnTheSphereHasTheTabulatedValues) {
  const std::vector<Point<Sphere<2>>> nodes{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  const std::vector<double> l{.5, .3, .2};
  const Weights<0, double> weights{3, l.data(), nullptr};
  GeodesicInterpolation<Sphere<2>, 0, double> geodesic;
  ASSERT_TRUE(geodesic.begin_cell(nodes.data(), 3));
  ASSERT_TRUE(geodesic.evaluate(nodes.data(), weights));
  ProjectionInterpolation<Sphere<2>, 0, double> projection;
  ASSERT_TRUE(projection.evaluate(nodes.data(), weights));
  const Vec3<double> g{{0.774245752809689, 0.515343944168288, 0.367374650003549}}, p{{0.811107105653813, 0.486664263392288, 0.324442842261525}};
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(geodesic.jet().value[c], g[c], 1e-12);
    EXPECT_NEAR(projection.jet().value[c], p[c], 1e-12);
  }
}

}  // namespace
}  // namespace karcher
