// Programs over duals and jets, of doubles and of packs.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "expression/formulas.hpp"

namespace karcher {
namespace {

using namespace testing;

using Slope = Dual<double, 3>;
using PackSlope = Dual<NativeScalar, 3>;
const double infinity = std::numeric_limits<double>::infinity();

double value(const Program& p, const Point& x) { return p.evaluate<double>(x); }

Slope slope(const Program& p, const Point& x) {
  std::array<Slope, 3> s;
  for (std::size_t i = 0; i < 3; ++i) {
    s[i] = Slope(x[i]);
    s[i].d[i] = 1;
  }
  return p.evaluate<Slope>(s);
}

TEST(Derivatives, OfDualsAgreeWithDifferences) {
  for (const char* text : smooth) {
    const Program p = compile(text);
    const Slope s = slope(p, point(0));
    EXPECT_NEAR(s.v, value(p, point(0)), 1e-14 * (1 + std::abs(s.v))) << text;
    for (std::size_t i = 0; i < 3; ++i) {
      const double h = 1e-5;
      Point high = point(0), low = point(0);
      high[i] += h;
      low[i] -= h;
      EXPECT_NEAR(s.d[i], (value(p, high) - value(p, low)) / (2 * h), 2e-9 * (1 + std::abs(s.d[i]))) << text << " in direction " << i;
    }
  }
}

TEST(Derivatives, OfPacksAndTheirDualsAndJetsAreThoseOfEveryLane) {
  for (const char* text : smooth) {
    const Program p = compile(text);
    const NativeScalar v = p.evaluate<NativeScalar>(in_lanes<NativeScalar>(point));
    const PackSlope d = p.evaluate<PackSlope>(in_lanes<PackSlope>(point));
    const PackJet j = p.evaluate<PackJet>(in_lanes<PackJet>(point));
    for (int l = 0; l < width; ++l) {
      const Slope s = slope(p, point(l));
      const double tolerance = 1e-13 * (1 + std::abs(s.v));
      EXPECT_NEAR(lane(v, l), s.v, tolerance) << text << " in lane " << l;
      EXPECT_NEAR(lane(d.v, l), s.v, tolerance) << text << " in lane " << l;
      EXPECT_NEAR(lane(j.v, l), s.v, tolerance) << text << " in lane " << l;
      for (std::size_t i = 0; i < 3; ++i) {
        const double near = 1e-13 * (1 + std::abs(s.d[i]));
        EXPECT_NEAR(lane(d.d[i], l), s.d[i], near) << text << " in lane " << l << ", direction " << i;
        EXPECT_NEAR(lane(j.g[i], l), s.d[i], near) << text << " in lane " << l << ", direction " << i;
        // The second derivatives are differences of the first.
        const double h = 1e-5;
        Point high = point(l), low = point(l);
        high[i] += h;
        low[i] -= h;
        const Slope above = slope(p, high), below = slope(p, low);
        for (std::size_t k = 0; k < 3; ++k) {
          const double expected = (above.d[k] - below.d[k]) / (2 * h);
          EXPECT_NEAR(lane(j.hessian(static_cast<int>(i), static_cast<int>(k)), l), expected, 1e-8 * (1 + std::abs(expected)))
              << text << " in lane " << l << ", directions " << i << ", " << k;
        }
      }
    }
  }
}

TEST(Derivatives, ABranchThatALaneDoesNotTakeDoesNotReachIt) {
  for (const char* text : with_singular_branches) {
    const Program p = compile(text);
    const PackJet j = p.evaluate<PackJet>(in_lanes<PackJet>(singular));
    EXPECT_EQ(lane(j.v, 0), 0) << text;
    EXPECT_EQ(lane(j.g[0], 0), 7) << text;
    EXPECT_EQ(lane(j.g[1], 0), 0) << text;
    for (int l = 0; l < width; ++l) EXPECT_TRUE(is_finite(j, l)) << text << " in lane " << l;
    for (int l = 1; l < width; ++l) {
      const double x = point(l)[0], y = point(l)[1], r = std::hypot(x, y);
      EXPECT_NEAR(lane(j.v, l), x / r, 1e-14) << text;
      EXPECT_NEAR(lane(j.g[0], l), y * y / (r * r * r), 1e-13) << text;
    }
    EXPECT_EQ(slope(p, {0, 0, 0}).d[0], 7) << text;
  }
}

TEST(Derivatives, AreInfiniteWhereTheyAre) {
  const Slope s = slope(compile("sqrt(x)"), {0, 0, 0});
  EXPECT_EQ(s.v, 0);
  EXPECT_EQ(s.d[0], infinity);
}

TEST(Derivatives, OfAPowerWithoutVariablesInTheExponentHoldForEveryBase) {
  // t has no derivatives, so x may be negative or zero; in other lanes it is positive and the exponent varies.
  Symbols symbols({"x", "t"});
  const Program p = symbols.link(symbols.compile("x^t"));
  const auto at = [&](double x, double t, double slope_of_t) {
    std::array<Jet<double, 2>, 2> s{Jet<double, 2>::variable(x, 0), Jet<double, 2>(t)};
    s[1].g[1] = slope_of_t;
    return p.evaluate<Jet<double, 2>>(s);
  };
  EXPECT_EQ(at(-3, 2, 0).v, 9);
  EXPECT_EQ(at(-3, 2, 0).g[0], -6);
  EXPECT_EQ(at(-3, 2, 0).hessian(0, 0), 2);
  EXPECT_EQ(at(0, 2, 0).hessian(0, 0), 2);
  EXPECT_EQ(at(0, 1, 0).g[0], 1);
  EXPECT_EQ(at(0, 0, 0).g[0], 0);
  EXPECT_NEAR(at(3, 2, 1).g[1], 9 * std::log(3), 1e-13);
  EXPECT_NEAR(at(3, 2, 1).hessian(0, 1), 3 + 6 * std::log(3), 1e-13);
  EXPECT_NEAR(at(3, 2, 1).hessian(1, 1), 9 * std::log(3) * std::log(3), 1e-13);

  std::array<PackJet, 2> s{PackJet::variable(NativeScalar(-3.0), 0), PackJet(2.0)};
  for (int l = 1; l < width; ++l) {
    set_lane(s[0].v, l, 3);
    set_lane(s[1].g[1], l, 1);
  }
  const PackJet j = p.evaluate<PackJet>(s);
  EXPECT_EQ(lane(j.v, 0), 9);
  EXPECT_EQ(lane(j.g[0], 0), -6);
  EXPECT_EQ(lane(j.g[1], 0), 0);
  for (int l = 1; l < width; ++l) EXPECT_NEAR(lane(j.g[1], l), 9 * std::log(3), 1e-13);
}

TEST(Derivatives, OfNamesOfFieldsAndTheirDerivatives) {
  // The density of a harmonic map, as an energy would write it.
  Symbols symbols({"x"});
  symbols.define("k", 0.5);
  for (const char* name : {"u[0]", "u[1]", "u[0].x", "u[1].x", "u.k1[2]"}) symbols.add_variable(name);
  const Program p = symbols.link(symbols.compile("k*(u[0].x^2 + u[1].x^2) + u[0]*u[1]*u.k1[2]"));
  EXPECT_EQ(p.inputs(), (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
  using J = Jet<NativeScalar, 5>;
  std::array<J, 6> s;
  for (int i = 0; i < 5; ++i) s[static_cast<std::size_t>(i + 1)] = J::variable(NativeScalar(i + 1.0), i);
  const J w = p.evaluate<J>(s);
  for (int l = 0; l < width; ++l) {
    EXPECT_EQ(lane(w.v, l), 0.5 * (9 + 16) + 1 * 2 * 5);
    EXPECT_EQ(lane(w.g[2], l), 3);
    EXPECT_EQ(lane(w.g[4], l), 2);
    EXPECT_EQ(lane(w.hessian(3, 3), l), 1);
    EXPECT_EQ(lane(w.hessian(0, 1), l), 5);
    EXPECT_EQ(lane(w.hessian(0, 2), l), 0);
  }
}

}  // namespace
}  // namespace karcher
