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

TEST(Spd, LogAroundIsTheLogarithmInAMovedFrame) {
  // theta(w, v) = 0 where p(v) = q(w); everywhere its length is the distance, with all derivatives up to the orders that a mean needs.
  Random random(3);
  using M = Spd<3>;
  using J = Jet<double, 12>;
  const auto check = [&](double r) {
    const auto q = retract<M>(M::origin(), random.direction<6>()), p = retract<M>(q, r * random.direction<6>());
    const auto e = M::frame(q), f = M::frame(p);
    Vec<J, 6> w, v;
    for (int i = 0; i < 6; ++i) {
      w[i] = J::variable(0, i);
      v[i] = J::variable(0, 6 + i);
    }
    const auto theta = M::LogAround<J, double>(q, e, w).theta(p, f, v);
    const J squared = norm2(theta);
    const auto a = M::exp(cast<J>(q), cast<J>(e) * w), b = M::exp(cast<J>(p), cast<J>(f) * v), log = M::log(a, b);
    const J expected = M::inner(a, log, log);
    EXPECT_NEAR(squared.v, expected.v, 1e-13);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(squared.g[i], expected.g[i], 1e-12);
    for (std::size_t i = 0; i < J::pairs; ++i) EXPECT_NEAR(squared.h[i], expected.h[i], 1e-11);
  };
  check(0);
  check(1e-6);
  check(0.3);
  check(2);
}

TEST(Spd, LogAroundTakesLargePacksApartWithoutADifference) {
  Random random(4);
  using M = Spd<2>;
  using P = Pack<8>;
  const auto scaled_variable = [](auto one, int i) {
    using S = decltype(one);
    using J = std::decay_t<decltype(S{}.v)>;
    S s = J::variable(Base<S>(0.0), i);
    for (auto& d : s.d) d = J(0.3 + 0.1 * i);
    return s;
  };
  using Large = Dual<Jet<P, 18>, 2>;
  using One = Dual<Jet<double, 18>, 2>;
  static_assert(sizeof(Large) > 8192);
  Point<M, P> q, p;
  std::array<Point<M>, 8> qs, ps;
  for (int l = 0; l < 8; ++l) {
    const auto i = static_cast<std::size_t>(l);
    qs[i] = retract<M>(M::origin(), 0.7 * random.direction<3>());
    ps[i] = retract<M>(qs[i], 0.2 * random.direction<3>());
    set_lane(q, l, qs[i]);
    set_lane(p, l, ps[i]);
  }
  Vec<Large, 3> w, v;
  Vec<One, 3> w1, v1;
  for (int i = 0; i < 3; ++i) {
    w[i] = scaled_variable(Large{}, i);
    v[i] = scaled_variable(Large{}, 3 + i);
    w1[i] = scaled_variable(One{}, i);
    v1[i] = scaled_variable(One{}, 3 + i);
  }
  const auto theta = M::LogAround<Large, P>(q, M::frame(q), w).theta(p, M::frame(p), v);
  for (int l = 0; l < 8; ++l) {
    const auto i = static_cast<std::size_t>(l);
    const auto one = M::LogAround<One, double>(qs[i], M::frame(qs[i]), w1).theta(ps[i], M::frame(ps[i]), v1);
    for (int c = 0; c < 3; ++c) {
      const One x = lane(theta[c], l) - one[c];
      EXPECT_NEAR(x.v.v, 0, 1e-14);
      for (std::size_t h = 0; h < x.d[1].h.size(); ++h) EXPECT_NEAR(x.d[1].h[h], 0, 1e-12);
    }
  }
}

TEST(Spd, DefectTellsMatricesFromPoints) {
  EXPECT_EQ(Spd<2>::defect({{2, 1, 1, 2}}), 0);
  EXPECT_NEAR(Spd<2>::defect({{2, 1.1, 1, 2}}), 0.05, 1e-15);
  EXPECT_GT(Spd<2>::defect({{1, 2, 2, 1}}), 1e300);
}
