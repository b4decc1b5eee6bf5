// The hand-written logarithms in moving frames (M::LogAround) against exp and log through jets: lengths, and where they vanish, to all orders that a
// Riemannian mean differentiates.
#include <gtest/gtest.h>

#include <cmath>

#include "karcher/manifold/spd.hpp"
#include "karcher/testing/random.hpp"

using namespace karcher;

template <class M>
class LogAround : public testing::Test {};
using Manifolds = testing::Types<Spd<2>, Spd<3>>;
TYPED_TEST_SUITE(LogAround, Manifolds);

TYPED_TEST(LogAround, HasTheLengthOfLogWithItsFirstTwoDerivatives) {
  using M = TypeParam;
  constexpr int k = M::dim;
  using J = Jet<double, 2 * k>;
  Random random(3);
  for (double r : {0.0, 1e-8, 0.3, 1.2, 2.0}) {
    const auto q = retract<M>(M::origin(), random.direction<k>());
    const auto p = retract<M>(q, r * random.direction<k>());
    const auto e = M::frame(q), f = M::frame(p);
    Vec<J, k> w, v;
    for (int i = 0; i < k; ++i) {
      w[i] = J::variable(0, i);
      v[i] = J::variable(0, k + i);
    }
    const typename M::template LogAround<J, double> around(q, e, w);
    const auto a = M::exp(cast<J>(q), cast<J>(e) * w);
    const auto compare = [&](const Vec<J, k>& theta, const Point<M, J>& log) {
      const J squared = norm2(theta), expected = M::inner(a, log, log);
      EXPECT_NEAR(squared.v, expected.v, 1e-13);
      for (std::size_t i = 0; i < squared.g.size(); ++i) EXPECT_NEAR(squared.g[i], expected.g[i], 1e-12);
      for (std::size_t i = 0; i < squared.h.size(); ++i) EXPECT_NEAR(squared.h[i], expected.h[i], 1e-11);
    };
    compare(around.theta(p, f, v), M::log(a, M::exp(cast<J>(p), cast<J>(f) * v)));
    compare(around.theta(p), M::log(a, cast<J>(p)));
    // without motion it is log in the frame
    const auto there = around.theta(p);
    const auto here = coordinates<M>(q, e, M::log(q, p));
    for (int i = 0; i < k; ++i) EXPECT_NEAR(there[i].v, here[i], 1e-14);
  }
}

TYPED_TEST(LogAround, HasTheThirdDerivativesOfTheSquaredDistance) {
  using M = TypeParam;
  constexpr int k = M::dim;
  using J = Jet<double, 2 * k>;
  using D = Dual<J, 2>;
  Random random(4);
  const auto q = retract<M>(M::origin(), random.direction<k>()), p = retract<M>(q, 0.8 * random.direction<k>());
  const auto e = M::frame(q), f = M::frame(p);
  Vec<D, k> w, v;
  for (int i = 0; i < k; ++i) {
    w[i] = J::variable(0, i);
    v[i] = J::variable(0, k + i);
    for (auto& d : w[i].d) d = J(random.normal());
  }
  const auto theta = typename M::template LogAround<D, double>(q, e, w).theta(p, f, v);
  const auto a = M::exp(cast<D>(q), cast<D>(e) * w), log = M::log(a, M::exp(cast<D>(p), cast<D>(f) * v));
  const D squared = norm2(theta), expected = M::inner(a, log, log);
  for (std::size_t d = 0; d < 2; ++d) {
    EXPECT_NEAR(squared.d[d].v, expected.d[d].v, 1e-12);
    for (std::size_t i = 0; i < squared.v.g.size(); ++i) EXPECT_NEAR(squared.d[d].g[i], expected.d[d].g[i], 1e-11);
    for (std::size_t i = 0; i < squared.v.h.size(); ++i) EXPECT_NEAR(squared.d[d].h[i], expected.d[d].h[i], 1e-10);
  }
}

TYPED_TEST(LogAround, AgreesInPacks) {
  using M = TypeParam;
  constexpr int k = M::dim;
  using P = Pack<8>;
  using Large = Dual<Jet<P, 2 * k>, 2>;
  using One = OneLane<Large>;
  Random random(5);
  Point<M, P> q, p;
  std::array<Point<M>, 8> qs, ps;
  for (int l = 0; l < 8; ++l) {
    const auto i = static_cast<std::size_t>(l);
    qs[i] = retract<M>(M::origin(), 0.7 * random.direction<k>());
    ps[i] = retract<M>(qs[i], 0.2 * random.direction<k>());
    set_lane(q, l, qs[i]);
    set_lane(p, l, ps[i]);
  }
  Vec<Large, k> w, v;
  Vec<One, k> w1, v1;
  for (int i = 0; i < k; ++i) {
    const double direction[2] = {random.normal(), random.normal()};
    w1[i] = Jet<double, 2 * k>::variable(0, i);
    v1[i] = Jet<double, 2 * k>::variable(0, k + i);
    for (std::size_t d = 0; d < 2; ++d) w1[i].d[d] = Jet<double, 2 * k>(direction[d]);
    for (int l = 0; l < 8; ++l) {
      set_lane(w[i], l, w1[i]);
      set_lane(v[i], l, v1[i]);
    }
  }
  const auto theta = typename M::template LogAround<Large, P>(q, M::frame(q), w).theta(p, M::frame(p), v);
  for (int l = 0; l < 8; ++l) {
    const auto i = static_cast<std::size_t>(l);
    const auto one = typename M::template LogAround<One, double>(qs[i], M::frame(qs[i]), w1).theta(ps[i], M::frame(ps[i]), v1);
    for (int c = 0; c < k; ++c) {
      const One x = lane(theta[c], l) - one[c];
      EXPECT_NEAR(x.v.v, 0, 1e-14);
      for (std::size_t h = 0; h < x.d[1].h.size(); ++h) EXPECT_NEAR(x.d[1].h[h], 0, 1e-11);
    }
  }
}
