#include "karcher/math/combination.hpp"

#include <gtest/gtest.h>

#include "karcher/math/pack.hpp"

namespace karcher {
namespace {

constexpr int N = 5;

/// The same value and derivatives, entry by entry.
template <class S>
void expect_same(const S& a, const S& b) {
  EXPECT_DOUBLE_EQ(a.v, b.v);
  for (std::size_t i = 0; i < N; ++i) {
    if constexpr (requires { a.h; })
      EXPECT_DOUBLE_EQ(a.g[i], b.g[i]);
    else
      EXPECT_DOUBLE_EQ(a.d[i], b.d[i]);
  }
  if constexpr (requires { a.h; }) {
    for (std::size_t i = 0; i < a.h.size(); ++i) EXPECT_DOUBLE_EQ(a.h[i], b.h[i]) << i;
  }
}

/// A sum of squares and products of combinations, in which a variable stands twice and variables stand in any order. S: Combination, or the kind of W itself.
template <class W, class S>
W polynomial(const std::array<S, N>& x) {
  W w(0.0);
  add_square(w, x[3] - x[1], 0.7);
  add_square(w, scaled(x[4], 3.0) + x[0] - 1.0, -0.2);
  S sum = x[4];
  sum += x[2];
  sum -= scaled(x[0], 0.5);
  add_product(w, sum, x[2] - x[4]);
  add_product(w, -x[1], x[1]);
  add_scaled(w, sum, 1.5);
  W square(0.0);
  add_square(square, x[2] + x[1], 1.0);
  add_product(w, x[4] - x[1], square);
  return w;
}

template <class W>
void compare() {
  constexpr std::array<double, N> at{0.3, -1.2, 0.8, 2.1, -0.4};
  std::array<Combination<double, N>, N> x;
  std::array<W, N> plain;
  for (int i = 0; i < N; ++i) {
    const auto k = static_cast<std::size_t>(i);
    x[k] = Combination<double, N>::variable(at[k], i);
    plain[k].v = at[k];
    if constexpr (requires { plain[k].h; })
      plain[k].g[k] = 1;
    else
      plain[k].d[k] = 1;
  }
  expect_same(polynomial<W>(x), polynomial<W>(plain));
}

TEST(Combination, GivesTheDerivativesOfAJet) { compare<Jet<double, N>>(); }
TEST(Combination, GivesTheDerivativesOfADual) { compare<Dual<double, N>>(); }

TEST(Combination, IsChosenLaneByLane) {
  using P = Pack<4>;
  P which;
  for (int l = 0; l < 4; ++l) set_lane(which, l, l);
  const auto a = Combination<P, N>::variable(P(2.0), 3), b = Combination<P, N>::variable(P(5.0), 1);
  const auto chosen = select(which < P(2.0), a, b);
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(lane(chosen.v, l), l < 2 ? 2 : 5);
    Dual<P, N> d(0.0);
    add_scaled(d, chosen, P(1.0));
    EXPECT_EQ(lane(d.d[3], l), l < 2 ? 1 : 0);
    EXPECT_EQ(lane(d.d[1], l), l < 2 ? 0 : 1);
  }
}

}  // namespace
}  // namespace karcher
