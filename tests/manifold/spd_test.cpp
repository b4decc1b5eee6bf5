#include "karcher/manifold/spd.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/testing/manifold_laws.hpp"
#include "karcher/testing/random.hpp"

using namespace karcher;

namespace {

template <int N>
Mat<double, N, N> random_spd(Random& random, double spread) {
  Mat<double, N, N> a;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) a(i, j) = a(j, i) = spread * random.normal();
  return symmetric_exp(a);
}

template <int N>
Mat<double, N, N> inverse_spd(const Mat<double, N, N>& a) {
  return inverse(a);
}

template <int N>
double difference(const Mat<double, N, N>& a, const Mat<double, N, N>& b) {
  return std::sqrt(norm2(a - b) / norm2(b));
}

}  // namespace

TEST(Spd, TheMidpointIsTheGeometricMean) {
  // A#B is the only positive definite solution of X A^-1 X = B (Bhatia 2007, section 4.1).
  Random random(1);
  for (int i = 0; i < 30; ++i) {
    const auto a = random_spd<3>(random, 0.7), b = random_spd<3>(random, 0.7);
    const auto p = Spd<3>::point(a), q = Spd<3>::point(b);
    const auto mean = Spd<3>::matrix(Spd<3>::exp(p, 0.5 * Spd<3>::log(p, q)));
    EXPECT_LT(difference(mean * inverse_spd(a) * mean, b), 1e-12);
    // det(A#B)^2 = det A det B
    EXPECT_NEAR(determinant(mean) * determinant(mean) / (determinant(a) * determinant(b)), 1, 1e-12);
  }
}

TEST(Spd, TheMetricIsInvariantUnderCongruence) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const auto a = random_spd<2>(random, 0.8), b = random_spd<2>(random, 0.8);
    Mat<double, 2, 2> g;
    for (double& x : g.e) x = random.normal();
    if (std::abs(determinant(g)) < 0.1) continue;
    const auto moved = [&](const Mat<double, 2, 2>& x) { return Spd<2>::point(sym(g * x * transpose(g))); };
    EXPECT_NEAR(distance<Spd<2>>(moved(a), moved(b)), distance<Spd<2>>(Spd<2>::point(a), Spd<2>::point(b)), 1e-12);
    const auto log = Spd<2>::matrix(Spd<2>::log(Spd<2>::point(a), Spd<2>::point(b)));
    EXPECT_LT(difference(Spd<2>::matrix(Spd<2>::log(moved(a), moved(b))), g * log * transpose(g)), 1e-11);
  }
}

TEST(Spd, CommutingMatricesHaveTheDistanceOfTheirLogarithms) {
  const auto p = Spd<3>::point(diagonal(Vec<double, 3>{{1, 2, 5}})), q = Spd<3>::point(diagonal(Vec<double, 3>{{3, 2, 0.1}}));
  const double expected = std::hypot(std::log(3.0), std::log(50.0));
  EXPECT_NEAR(distance<Spd<3>>(p, q), expected, 1e-14);
}

TEST(Spd, FarPointsStayPositiveDefiniteAndAreFound) {
  const auto p = Spd<3>::point(identity<double, 3>());
  Vec<double, 6> v{{-20, 3, -8, 0.5, 0.2, -0.4}};
  const auto q = retract<Spd<3>>(p, v);
  EXPECT_LT(Spd<3>::defect(q), 1e-15);
  EXPECT_NEAR(distance<Spd<3>>(p, q), std::sqrt(norm2(v)), 1e-6);  // condition number e^23 takes ten digits of the smallest eigenvalue
}

TEST(Spd, ObeysTheLawsWhereEigenvaluesMeet) {
  // All points are multiples of the identity, up to nothing, 1e-9 or 1e-3: every log and exp is taken at (nearly) equal eigenvalues.
  const auto check = [](auto manifold) {
    using M = decltype(manifold);
    ManifoldLawOptions<M> options;
    options.point = [](Random& random) {
      Point<M> p = std::exp(0.5 * random.normal()) * M::origin();
      const double sizes[3] = {0, 1e-9, 1e-3};
      return retract<M>(p, sizes[static_cast<int>(3 * random.uniform())] * random.direction<M::dim>());
    };
    for (const auto& s : manifold_laws<M>(options)) ADD_FAILURE() << s;
  };
  check(Spd<2>{});
  check(Spd<3>{});
}

TEST(Spd, DefectTellsMatricesFromPoints) {
  EXPECT_EQ(Spd<2>::defect({{2, 1, 1, 2}}), 0);
  EXPECT_NEAR(Spd<2>::defect({{2, 1.1, 1, 2}}), 0.05, 1e-15);
  EXPECT_GT(Spd<2>::defect({{1, 2, 2, 1}}), 1e300);
}
