#include "karcher/solve/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/sphere.hpp"
#include "solve/boundary.hpp"
#include "solve/cell_functions.hpp"

namespace karcher {
namespace {

using testing::SmallProblem;

testing::CellValue nothing(const std::vector<const double*>&, const Vec3<double>&, double, double*, double*) { return {}; }

std::vector<double> on_equator(const std::vector<double>& degrees) {
  std::vector<double> values;
  for (const double a : degrees) {
    const double radians = a * std::numbers::pi / 180;
    values.insert(values.end(), {std::cos(radians), std::sin(radians), 0.0});
  }
  return values;
}

TEST(Spread, IsThatOfTheCellWhereValuesTurnMost) {
  const SmallProblem p(4, manifold_by_name("S2"), nothing, on_equator({0, 40, 160, 170, 200}));
  const Spread s = widest_spread(*p.layout, p.u);
  EXPECT_NEAR(s.ratio, 120.0 / 180, 1e-12);
  EXPECT_EQ(s.sentence, "the values of the field \"u\" differ by 120 of at most 180 degrees within the cell around (1.5, 0, 0)");
}

TEST(Spread, OfOppositeValuesIsOne) {
  const SmallProblem p(3, manifold_by_name("S2"), nothing, on_equator({0, 10, 190, 200}));
  EXPECT_GE(widest_spread(*p.layout, p.u).ratio, Spread::opposite);
}

TEST(Spread, OfVectorsIsNone) {
  const SmallProblem p(2, manifold_by_name("R1"), nothing, {0, 1e300, -1e300});
  EXPECT_EQ(widest_spread(*p.layout, p.u).ratio, 0);
  EXPECT_EQ(widest_spread(*p.layout, p.u).sentence, "");
}

TEST(Spread, OfAProductIsThatOfTheFactorThatTurnsMost) {
  using P = Product<Euclidean<1>, Sphere<1>>;
  const auto value = [](double x, double angle) { return std::vector<double>{x, std::cos(angle), std::sin(angle)}; };
  const std::vector<double> a = value(0, 0), b = value(1e6, 0.3 * std::numbers::pi);
  EXPECT_NEAR(manifold_ops<P>().cut_ratio(a.data(), b.data()), 0.3, 1e-12);
}

TEST(FarTurn, OfBoundaryDataIsToldWithDegreesAndPlaceFrom90DegreesOn) {
  const SmallProblem p(2, manifold_by_name("S2"), nothing, on_equator({0, 0, 0}));
  const std::vector<char> fixed(6, 1);
  SmallProblem held(2, manifold_by_name("S2"), nothing, on_equator({0, 0, 0}), fixed);
  const SmallProblem turned(2, manifold_by_name("S2"), nothing, on_equator({0, 0, 115}));
  EXPECT_EQ(far_turn(*p.layout, p.u, turned.u), "");
  EXPECT_EQ(far_turn(*held.layout, held.u, turned.u).substr(0, 90),
            "the boundary data of the field \"u\" turn by 115 degrees in this load step, at (2, 0, 0): wh");
  const SmallProblem near(2, manifold_by_name("S2"), nothing, on_equator({0, 0, 85}));
  EXPECT_EQ(far_turn(*held.layout, held.u, near.u), "");
}

}  // namespace
}  // namespace karcher
