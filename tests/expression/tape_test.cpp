// Tapes against jets.

#include "karcher/expression/tape.hpp"

#include <gtest/gtest.h>

#include "expression/formulas.hpp"

namespace karcher {
namespace {

using namespace testing;

/// Four coordinates; x, y and z depend on some of them, in every lane in another way.
constexpr int coordinates = 4;
using CoordinateJet = Jet<NativeScalar, coordinates>;
const std::vector<std::vector<std::uint32_t>> depends_on{{0, 2, 3}, {}, {0, 1}};
NativeScalar slope_of(std::size_t variable, std::uint32_t y) {
  NativeScalar s;
  for (int l = 0; l < width; ++l) set_lane(s, l, 1 + 0.3 * static_cast<double>(variable) - 0.7 * y + 0.1 * l);
  return s;
}

/// Value, gradient and Hessian of seed = 2 times the program.
CoordinateJet by_tape(const Program& p, Point (*at)(int)) {
  const Tape tape(p, depends_on, coordinates);
  TapeRun run(tape);
  const auto x = in_lanes<NativeScalar>(at);
  std::copy(x.begin(), x.end(), run.values());
  for (std::size_t v = 0; v < 3; ++v)
    for (const std::uint32_t y : depends_on[v]) run.rows()[v * coordinates + y] = slope_of(v, y);
  CoordinateJet j;
  j.v = NativeScalar(2.0) * run.value();
  const NativeScalar* l = run.adjoints(2.0);
  for (std::size_t v = 0; v < 3; ++v)
    for (const std::uint32_t y : depends_on[v]) j.g[y] += l[v] * slope_of(v, y);
  std::array<NativeScalar, coordinates * coordinates> h;
  run.curvature(h.data());
  for (int i = 0; i < coordinates; ++i)
    for (int k = i; k < coordinates; ++k) j.h[j.index(i, k)] = h[static_cast<std::size_t>(i * coordinates + k)];
  return j;
}
CoordinateJet by_jets(const Program& p, Point (*at)(int)) {
  const auto x = in_lanes<NativeScalar>(at);
  std::array<CoordinateJet, 3> variables;
  for (std::size_t v = 0; v < 3; ++v) {
    variables[v] = CoordinateJet(x[v]);
    for (const std::uint32_t y : depends_on[v]) variables[v].g[y] = slope_of(v, y);
  }
  return 2 * p.evaluate<CoordinateJet>(variables);
}

void expect_equal(const CoordinateJet& a, const CoordinateJet& b, const char* text) {
  const auto near = [&](const NativeScalar& x, const NativeScalar& y) {
    for (int l = 0; l < width; ++l) EXPECT_NEAR(lane(x, l), lane(y, l), 1e-13 * (1 + std::abs(lane(y, l)))) << text << " in lane " << l;
  };
  near(a.v, b.v);
  for (std::size_t i = 0; i < a.g.size(); ++i) near(a.g[i], b.g[i]);
  for (std::size_t i = 0; i < a.h.size(); ++i) near(a.h[i], b.h[i]);
}

TEST(Tape, HasTheDerivativesOfJets) {
  for (const char* text : smooth) expect_equal(by_tape(compile(text), point), by_jets(compile(text), point), text);
}

TEST(Tape, IsNotReachedByABranchThatALaneDoesNotTake) {
  for (const char* text : with_singular_branches) expect_equal(by_tape(compile(text), singular), by_jets(compile(text), singular), text);
  // Also where a definition is undefined that the branch uses.
  Symbols symbols({"x", "y", "z"});
  symbols.define("root", symbols.compile("sqrt(x - 0.01)"));
  symbols.define("twice", symbols.compile("root*z + root"));
  const Program p = symbols.link(symbols.compile("x > 0 ? twice^3 + x*z : 3*x"));
  const CoordinateJet j = by_tape(p, singular);
  for (int l = 0; l < width; ++l)
    for (const NativeScalar& h : j.h) EXPECT_TRUE(std::isfinite(lane(h, l)));
  expect_equal(j, by_jets(p, singular), "x > 0 ? twice^3 + x*z : 3*x");
}

TEST(Tape, IsUndefinedWhereJetsAre) {
  // sqrt is there, its slope is not, whatever it is multiplied by.
  const CoordinateJet j = by_tape(compile("sqrt(x)^2"), singular);
  EXPECT_EQ(lane(j.v, 0), 0);
  EXPECT_FALSE(std::isfinite(lane(j.g[0], 0)));
  EXPECT_TRUE(width == 1 || std::isfinite(lane(j.g[0], width - 1)));
}

TEST(Tape, IsRunAgainAtAnotherPoint) {
  const Program p = compile("x < 0.42 ? exp(x*z) : x^3*z");
  const Tape tape(p, depends_on, coordinates);
  TapeRun run(tape);
  for (const double x : {0.1, 0.9, 0.2}) {  // one formula, the other, the first again
    run.values()[0] = x;
    run.values()[2] = 2.0;
    run.rows()[0] = 1.0;
    EXPECT_DOUBLE_EQ(lane(run.value(), 0), x < 0.42 ? std::exp(2 * x) : 2 * x * x * x);
    EXPECT_DOUBLE_EQ(lane(run.adjoints(1.0)[0], 0), x < 0.42 ? 2 * std::exp(2 * x) : 6 * x * x);
    std::array<NativeScalar, coordinates * coordinates> h;
    run.curvature(h.data());
    EXPECT_DOUBLE_EQ(lane(h[0], 0), x < 0.42 ? 4 * std::exp(2 * x) : 12 * x);
  }
}

}  // namespace
}  // namespace karcher
