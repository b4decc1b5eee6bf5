#pragma once
/// \file
/// Random nodal data and finite-difference checks that every interpolation passes.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "karcher/interpolation/rules.hpp"
#include "karcher/manifold/every_manifold.hpp"

namespace karcher::testing {

using Random = std::mt19937;

inline double uniform(Random& r, double low, double high) { return std::uniform_real_distribution<double>(low, high)(r); }

template <int N>
Vec<double, N> random_vector(Random& r, double size) {
  Vec<double, N> v;
  for (int i = 0; i < N; ++i) v[i] = uniform(r, -size, size);
  return v;
}

/// Points at tangent distance about `spread` from a random centre that is reached from `origin`.
template <class M>
std::vector<Point<M>> random_nodes(Random& r, const Point<M>& origin, int count, double spread) {
  const Point<M> centre = retract<M>(origin, random_vector<M::dim>(r, 1.0));
  std::vector<Point<M>> nodes;
  for (int i = 0; i < count; ++i) nodes.push_back(retract<M>(centre, random_vector<M::dim>(r, spread)));
  return nodes;
}

/// Weights of a P2 triangle (six nodes, some negative) at a point, with derivatives.
template <int D>
struct P2Weights {
  std::vector<double> l;
  std::vector<std::array<double, D>> dl;

  explicit P2Weights(double x, double y) {
    const double z = 1 - x - y;
    const std::array<double, 3> b{z, x, y};
    const std::array<std::array<double, 2>, 3> g{{{-1, -1}, {1, 0}, {0, 1}}};
    const auto add = [&](double value, std::array<double, 2> gradient) {
      l.push_back(value);
      std::array<double, D> d{};
      for (std::size_t a = 0; a < D && a < 2; ++a) d[a] = gradient[a];
      if constexpr (D > 2) d[2] = 0.3 * gradient[0] - 0.8 * gradient[1];
      dl.push_back(d);
    };
    for (std::size_t i = 0; i < 3; ++i) add(b[i] * (2 * b[i] - 1), {(4 * b[i] - 1) * g[i][0], (4 * b[i] - 1) * g[i][1]});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      add(4 * b[i] * b[j], {4 * (b[i] * g[j][0] + b[j] * g[i][0]), 4 * (b[i] * g[j][1] + b[j] * g[i][1])});
    }
  }
  Weights<D, double> weights() const { return {static_cast<int>(l.size()), l.data(), dl.data()}; }
};

/// A smooth density without structure, of the ambient jet.
struct RoughDensity {
  template <class Jet>
  auto operator()(const Jet& u) const {
    auto s = 0.3 * u.value[0];
    for (int c = 0; c < Jet::Manifold::ambient; ++c) {
      s += (0.7 + 0.1 * c) * u.value[c] * u.value[(c + 1) % Jet::Manifold::ambient];
      for (std::size_t a = 0; a < u.d.size(); ++a)
        s += (0.4 + 0.05 * static_cast<double>(a) - 0.03 * c) * u.d[a][c] + 0.2 * u.d[a][c] * u.d[a][c] * u.value[c] +
             0.15 * u.d[a][c] * u.d[(a + 1) % u.d.size()][(c + 1) % Jet::Manifold::ambient];
    }
    return s;
  }
};

/// Sixth-order central differences of f at 0: first and second derivative.
template <class F>
std::array<double, 2> differences(F f, double h) {
  const double p1 = f(h), p2 = f(2 * h), p3 = f(3 * h), m1 = f(-h), m2 = f(-2 * h), m3 = f(-3 * h), o = f(0);
  return {(45 * (p1 - m1) - 9 * (p2 - m2) + (p3 - m3)) / (60 * h), (270 * (p1 + m1) - 27 * (p2 + m2) + 2 * (p3 + m3) - 490 * o) / (180 * h * h)};
}

/// Compares gradient A^T f and Hessian A^T C A + contraction(f) along random directions with differences through the retraction.
template <class I, int D>
void expect_exact_variations(const Point<typename I::Manifold>& origin, double spread, double tolerance) {
  using M = typename I::Manifold;
  constexpr int k = M::dim, L = local_dim<M, D>;
  Random random(7);
  for (int sample = 0; sample < 4; ++sample) {
    const auto nodes = random_nodes<M>(random, origin, 6, spread);
    const P2Weights<D> w(uniform(random, 0.1, 0.5), uniform(random, 0.1, 0.4));
    I interpolation;
    ASSERT_TRUE(interpolation.begin_cell(nodes.data(), 6));
    ASSERT_TRUE(interpolation.evaluate(nodes.data(), w.weights()));

    using S = Jet<double, L>;
    const Vec<double, L> y0 = interpolation.local_coordinates();
    Vec<S, L> y;
    for (int i = 0; i < L; ++i) y[i] = S::variable(y0[i], i);
    const S density = RoughDensity{}(jet_at<M, D, typename I::Chart, double, S>(interpolation.jet().value, interpolation.frame(), y));
    EXPECT_NEAR(density.v, RoughDensity{}(interpolation.jet()), 1e-12 * (1 + std::abs(density.v)));
    Vec<double, L> f;
    for (int i = 0; i < L; ++i) f[i] = density.gradient(i);

    std::vector<Mat<double, L, k>> maps(6);
    std::vector<Mat<double, k, k>> blocks(36);
    interpolation.linearize(nodes.data(), maps);
    interpolation.add_second_variation(nodes.data(), f, blocks.data());

    std::vector<Vec<double, k>> v;
    for (int i = 0; i < 6; ++i) v.push_back(random_vector<k>(random, 0.5));
    double first = 0, second = 0;
    Vec<double, L> dy;
    for (std::size_t i = 0; i < 6; ++i) dy += maps[i] * v[i];
    first = dot(f, dy);
    for (int i = 0; i < L; ++i)
      for (int j = 0; j < L; ++j) second += dy[i] * density.hessian(i, j) * dy[j];
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = i; j < 6; ++j) second += (i == j ? 1.0 : 2.0) * dot(v[i], blocks[i * 6 + j] * v[j]);

    const auto along = [&](double s) {
      std::vector<Point<M>> moved;
      for (std::size_t i = 0; i < 6; ++i) moved.push_back(retract<M>(nodes[i], s * v[i]));
      I other;
      EXPECT_TRUE(other.begin_cell(moved.data(), 6));
      EXPECT_TRUE(other.evaluate(moved.data(), w.weights()));
      return RoughDensity{}(other.jet());
    };
    const auto difference = differences(along, 0.01);
    const double size = 1 + std::abs(first) + std::abs(second);
    EXPECT_NEAR(first, difference[0], tolerance * size) << M::name << " D = " << D;
    EXPECT_NEAR(second, difference[1], 30 * tolerance * size) << M::name << " D = " << D;
  }
}

/// Derivatives in the position against differences of the value.
template <class I>
void expect_exact_derivatives(const Point<typename I::Manifold>& origin, double spread) {
  using M = typename I::Manifold;
  Random random(11);
  const auto nodes = random_nodes<M>(random, origin, 6, spread);
  const P2Weights<2> w(0.3, 0.25);
  I interpolation;
  ASSERT_TRUE(interpolation.begin_cell(nodes.data(), 6));
  ASSERT_TRUE(interpolation.evaluate(nodes.data(), w.weights()));
  for (std::size_t a = 0; a < 2; ++a)
    for (int c = 0; c < M::ambient; ++c) {
      const auto along = [&](double s) {
        const P2Weights<2> moved(0.3 + (a == 0 ? s : 0), 0.25 + (a == 1 ? s : 0));
        I other;
        other.begin_cell(nodes.data(), 6);
        other.evaluate(nodes.data(), moved.weights());
        return other.jet().value[c];
      };
      EXPECT_NEAR(interpolation.jet().d[a][c], differences(along, 0.01)[0], 1e-9) << M::name;
    }
}

}  // namespace karcher::testing
