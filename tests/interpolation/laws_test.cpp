// What every interpolation of manifold-valued data must do, and what only some do (nestedness), in numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interpolation_laws.hpp"
#include "karcher/error.hpp"
#include "karcher/interpolation/evaluate.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using testing::random_nodes;
using testing::uniform;
template <class M>
using Nodes = std::vector<Point<M>>;
using Weight = std::vector<double>;

struct Geodesic {
  template <class M, int D, class T>
  using Rule = GeodesicInterpolation<M, D, T>;
};
struct Projection {
  template <class M, int D, class T>
  using Rule = ProjectionInterpolation<M, D, T>;
};

template <class R, class M>
struct Value {
  bool defined = false;
  Point<M> point{};
};
template <class R, class M>
Value<R, M> value(const Nodes<M>& nodes, const Weight& l) {
  typename R::template Rule<M, 0, double> rule;
  Value<R, M> v;
  v.defined = rule.begin_cell(nodes.data(), static_cast<int>(nodes.size()));
  v.defined = v.defined & rule.evaluate(nodes.data(), {static_cast<int>(l.size()), l.data(), nullptr});
  v.point = rule.jet().value;
  return v;
}
template <class R, class M>
Point<M> point(const Nodes<M>& nodes, const Weight& l) {
  const auto v = value<R, M>(nodes, l);
  EXPECT_TRUE(v.defined) << M::name;
  return v.point;
}
/// The two quaternions of a rotation are the same point.
template <class M>
double apart(const Point<M>& p, const Point<M>& q) {
  const double d = std::sqrt(norm2(p - q));
  return std::is_same_v<M, Rotation> ? std::min(d, std::sqrt(norm2(p + q))) : d;
}

template <class F>
void with_geodesic(F f) {
  f.template operator()<Geodesic, Euclidean<3>>();
  f.template operator()<Geodesic, Sphere<1>>();
  f.template operator()<Geodesic, Sphere<2>>();
  f.template operator()<Geodesic, Sphere<3>>();
  f.template operator()<Geodesic, Rotation>();
  f.template operator()<Geodesic, Unitary>();
  f.template operator()<Geodesic, Spd<2>>();
  f.template operator()<Geodesic, Spd<3>>();
  f.template operator()<Geodesic, Hyperbolic<2>>();
  f.template operator()<Geodesic, Hyperbolic<3>>();
  f.template operator()<Geodesic, Product<Rotation, Spd<2>>>();
}
template <class F>
void with_projection(F f) {
  f.template operator()<Projection, Euclidean<3>>();
  f.template operator()<Projection, Sphere<1>>();
  f.template operator()<Projection, Sphere<2>>();
  f.template operator()<Projection, Sphere<3>>();
  f.template operator()<Projection, Rotation>();
  f.template operator()<Projection, Unitary>();
}
/// Both rules wherever they exist.
template <class F>
void with_every_rule(F f) {
  with_geodesic(f);
  with_projection(f);
}

/// Weights of a P2 triangle inside the cell: of both signs, sum 1.
Weight p2_weights(double x, double y) { return testing::P2Weights<2>(x, y).l; }

TEST(InterpolationLaws, HasTheNodalValuesAtTheNodes) {
  with_every_rule([]<class R, class M>() {
    testing::Random random(1);
    const Nodes<M> nodes = random_nodes<M>(random, M::origin(), 6, 0.4);
    for (std::size_t i = 0; i < 6; ++i) {
      Weight l(6, 0.0);
      l[i] = 1;
      EXPECT_LT(apart<M>(point<R, M>(nodes, l), nodes[i]), 1e-14) << M::name;
    }
  });
}

TEST(InterpolationLaws, DoesNotDependOnTheOrderOfTheNodes) {
  with_every_rule([]<class R, class M>() {
    testing::Random random(2);
    Nodes<M> nodes = random_nodes<M>(random, M::origin(), 6, 0.4);
    Weight l = p2_weights(0.35, 0.15);
    const Point<M> before = point<R, M>(nodes, l);
    for (int shuffle = 0; shuffle < 5; ++shuffle) {
      for (std::size_t i = 5; i > 0; --i) {
        const std::size_t j = random() % (i + 1);
        std::swap(nodes[i], nodes[j]);
        std::swap(l[i], l[j]);
      }
      EXPECT_LT(apart<M>(point<R, M>(nodes, l), before), 1e-14 * (1 + std::sqrt(norm2(before)))) << M::name;
    }
  });
}

TEST(InterpolationLaws, ReproducesConstantsWithoutDerivatives) {
  with_every_rule([]<class R, class M>() {
    testing::Random random(3);
    const Nodes<M> nodes(6, random_nodes<M>(random, M::origin(), 1, 0.4)[0]);
    const testing::P2Weights<2> w(0.35, 0.15);
    typename R::template Rule<M, 2, double> rule;
    ASSERT_TRUE(rule.begin_cell(nodes.data(), 6));
    ASSERT_TRUE(rule.evaluate(nodes.data(), w.weights()));
    EXPECT_LT(apart<M>(rule.jet().value, nodes[0]), 1e-14) << M::name;
    for (const auto& d : rule.jet().d) EXPECT_LT(std::sqrt(norm2(d)), 1e-14) << M::name;
  });
}

/// |I(phi(nodes)) - phi(I(nodes))|
template <class R, class M, class Isometry>
double defect_of(const Isometry& phi, std::uint32_t seed = 4) {
  testing::Random random(seed);
  Nodes<M> nodes = random_nodes<M>(random, M::origin(), 6, 0.4);
  const Weight l = p2_weights(0.35, 0.15);
  const Point<M> expected = phi(point<R, M>(nodes, l));
  for (auto& p : nodes) p = phi(p);
  return apart<M>(point<R, M>(nodes, l), expected);
}

TEST(InterpolationLaws, CommutesWithIsometries) {
  const Quaternion<double> a = Rotation::from_rotation_vector(Vec3<double>{{0.4, -1.3, 0.7}});
  const Mat3<double> turn = Rotation::to_matrix(a);
  const auto both = [&]<class R>() {
    EXPECT_LT((defect_of<R, Sphere<2>>([&](const auto& p) { return turn * p; })), 1e-14);
    EXPECT_LT((defect_of<R, Sphere<2>>([&](const auto& p) { return Vec3<double>{{p[0], -p[1], p[2]}}; })), 1e-14);
    EXPECT_LT((defect_of<R, Sphere<3>>([&](const auto& p) { return quaternion_product(a, p); })), 1e-14);
    EXPECT_LT((defect_of<R, Unitary>([&](const auto& p) { return quaternion_product(p, a); })), 1e-14);
    EXPECT_LT((defect_of<R, Rotation>([&](const auto& p) { return Rotation::product(a, p); })), 1e-14);
    EXPECT_LT((defect_of<R, Rotation>([&](const auto& p) { return Rotation::product(p, a); })), 1e-14);
    EXPECT_LT((defect_of<R, Rotation>([&](const auto& p) { return conjugate(p); })), 1e-14);
  };
  both.template operator()<Geodesic>();
  both.template operator()<Projection>();
  Mat3<double> g = turn;
  g(0, 1) += 0.8, g(2, 2) += 0.9;
  EXPECT_LT((defect_of<Geodesic, Spd<3>>([&](const auto& p) { return Spd<3>::point(sym(g * Spd<3>::matrix(p) * transpose(g))); })), 1e-12);
  EXPECT_LT((defect_of<Geodesic, Spd<3>>([&](const auto& p) { return Spd<3>::point(sym(inverse(Spd<3>::matrix(p)))); })), 1e-12);
  EXPECT_LT((defect_of<Geodesic, Hyperbolic<2>>([&](const auto& p) {
              const double c = std::cosh(0.8), s = std::sinh(0.8);
              return Point<Hyperbolic<2>>{{c * p[0] + s * p[1], s * p[0] + c * p[1], -p[2]}};
            })),
            1e-13);
}

TEST(InterpolationLaws, TheNegativeQuaternionIsTheSameRotation) {
  const auto both = []<class R>() {
    testing::Random random(5);
    Nodes<Rotation> nodes = random_nodes<Rotation>(random, Rotation::origin(), 6, 0.5);
    const Weight l = p2_weights(0.2, 0.45);
    const auto before = point<R, Rotation>(nodes, l);
    for (std::size_t i = 0; i < 6; i += 2) nodes[i] = -nodes[i];
    EXPECT_LT(apart<Rotation>(point<R, Rotation>(nodes, l), before), 1e-14);
  };
  both.template operator()<Geodesic>();
  both.template operator()<Projection>();
}

TEST(InterpolationLaws, PacksAgreeWithDoubleLaneByLane) {
  with_every_rule([]<class R, class M>() {
    constexpr int W = 4, k = M::dim, L = local_dim<M, 2>;
    using P = Pack<W>;
    testing::Random random(6);
    std::vector<Nodes<M>> nodes;
    std::vector<Point<M, P>> packed(6);
    const testing::P2Weights<2> w(0.35, 0.15);
    std::vector<std::array<P, 2>> dl(6);
    Vec<P, L> f;
    for (int i = 0; i < L; ++i) f[i] = P(0.3 + 0.1 * i);
    for (int lane = 0; lane < W; ++lane) {
      nodes.push_back(random_nodes<M>(random, M::origin(), 6, 0.3));
      for (std::size_t i = 0; i < 6; ++i) set_lane(packed[i], lane, nodes.back()[i]);
    }
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t a = 0; a < 2; ++a) dl[i][a] = P(w.dl[i][a]);
    typename R::template Rule<M, 2, P> rule;
    ASSERT_TRUE(all(rule.begin_cell(packed.data(), 6)));
    ASSERT_TRUE(all(rule.evaluate(packed.data(), {6, w.l.data(), dl.data()})));
    std::vector<Mat<P, L, k>> maps(6);
    std::vector<Mat<P, k, k>> blocks(36);
    rule.linearize(packed.data(), maps);
    rule.add_second_variation(packed.data(), f, blocks.data());
    for (int lane = 0; lane < W; ++lane) {
      const Nodes<M>& mine = nodes[static_cast<std::size_t>(lane)];
      typename R::template Rule<M, 2, double> one;
      ASSERT_TRUE(one.begin_cell(mine.data(), 6));
      ASSERT_TRUE(one.evaluate(mine.data(), w.weights()));
      std::vector<Mat<double, L, k>> one_maps(6);
      std::vector<Mat<double, k, k>> one_blocks(36);
      one.linearize(mine.data(), one_maps);
      one.add_second_variation(mine.data(), karcher::lane(f, lane), one_blocks.data());
      EXPECT_LT(apart<M>(karcher::lane(rule.jet().value, lane), one.jet().value), 1e-13) << M::name;
      for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(std::sqrt(norm2(karcher::lane(maps[i], lane) - one_maps[i])), 1e-11) << M::name;
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i; j < 6; ++j)
          EXPECT_LT(std::sqrt(norm2(karcher::lane(blocks[i * 6 + j], lane) - one_blocks[i * 6 + j])), 1e-11) << M::name;
    }
  });
}

TEST(InterpolationLaws, ValuesAndDerivativesAreSmoothInNodesAndPositionAlsoForNegativeWeights) {
  // Taylor: the value moves with the first variation up to second order when one node and the position move; weights here have both signs.
  with_every_rule([]<class R, class M>() {
    constexpr int k = M::dim, L = local_dim<M, 2>;
    testing::Random random(7);
    const Nodes<M> nodes = random_nodes<M>(random, M::origin(), 6, 0.3);
    const testing::P2Weights<2> w(0.1, 0.1);
    ASSERT_LT(*std::min_element(w.l.begin(), w.l.end()), -0.07);
    typename R::template Rule<M, 2, double> rule;
    ASSERT_TRUE(rule.begin_cell(nodes.data(), 6));
    ASSERT_TRUE(rule.evaluate(nodes.data(), w.weights()));
    std::vector<Mat<double, L, k>> maps(6);
    rule.linearize(nodes.data(), maps);
    const auto v = testing::random_vector<k>(random, 1.0);
    double last = 0;
    for (double t : {1e-2, 1e-3}) {
      Nodes<M> moved = nodes;
      moved[4] = retract<M>(nodes[4], t * v);
      const Point<M> at = point<R, M>(moved, p2_weights(0.1 + 0.7 * t, 0.1 - 0.4 * t));
      Vec<double, k> first;
      for (int r = 0; r < k; ++r)
        for (int c = 0; c < k; ++c) first[r] += maps[4](r, c) * v[c];
      Point<M> predicted = rule.jet().value + t * (rule.frame() * first);
      predicted += (0.7 * t) * rule.jet().d[0] + (-0.4 * t) * rule.jet().d[1];
      const double error = apart<M>(at, predicted);
      if (last > 1e-10) {
        EXPECT_NEAR(std::log10(last / error), 2, 0.2) << M::name;
      }
      last = error;
    }
  });
}

TEST(InterpolationLaws, InRnBothRulesAreLagrangeInterpolation) {
  testing::Random random(8);
  const Nodes<Euclidean<3>> nodes = random_nodes<Euclidean<3>>(random, {}, 6, 5.0);
  const testing::P2Weights<2> w(0.1, 0.7);
  const auto both = [&]<class R>() {
    typename R::template Rule<Euclidean<3>, 2, double> rule;
    ASSERT_TRUE(rule.begin_cell(nodes.data(), 6));
    ASSERT_TRUE(rule.evaluate(nodes.data(), w.weights()));
    Vec3<double> x, dx, dy;
    for (std::size_t i = 0; i < 6; ++i) {
      x += w.l[i] * nodes[i];
      dx += w.dl[i][0] * nodes[i];
      dy += w.dl[i][1] * nodes[i];
    }
    EXPECT_LT(norm2(rule.jet().value - x), 1e-28);
    EXPECT_LT(norm2(rule.jet().d[0] - dx), 1e-27);
    EXPECT_LT(norm2(rule.jet().d[1] - dy), 1e-27);
  };
  both.template operator()<Geodesic>();
  both.template operator()<Projection>();
}

TEST(InterpolationLaws, OnTheCircleGeodesicInterpolationIsThatOfTheAngle) {
  // S^1 is flat: the mean of angles that lie within a half circle.
  const Weight l = p2_weights(0.15, 0.6);
  Nodes<Sphere<1>> nodes;
  double angle = 0, at = 2.9;
  for (std::size_t i = 0; i < 6; ++i, at += 0.3) {
    nodes.push_back({{std::cos(at), std::sin(at)}});
    angle += l[i] * at;
  }
  const auto p = point<Geodesic, Sphere<1>>(nodes, l);
  EXPECT_NEAR(p[0], std::cos(angle), 1e-14);
  EXPECT_NEAR(p[1], std::sin(angle), 1e-14);
}

TEST(InterpolationLaws, OfTwoPointsIsTheGeodesic) {
  with_geodesic([]<class R, class M>() {
    testing::Random random(9);
    const Nodes<M> nodes = random_nodes<M>(random, M::origin(), 2, 0.6);
    for (double t : {0.2, 0.5, 0.9, -0.3})
      EXPECT_LT(apart<M>(point<R, M>(nodes, {1 - t, t}), M::exp(nodes[0], t * M::log(nodes[0], nodes[1]))), 1e-12) << M::name;
  });
  // The projection of a chord of the sphere runs over the same great circle with another speed: slerp's angle theta is arctan2(t sin, 1 - t + t cos).
  const double angle = 1.1, t = 0.3;
  const auto p = point<Projection, Sphere<2>>({{{1, 0, 0}}, {{std::cos(angle), std::sin(angle), 0}}}, {1 - t, t});
  EXPECT_NEAR(std::atan2(p[1], p[0]), std::atan2(t * std::sin(angle), 1 - t + t * std::cos(angle)), 1e-15);
}

// ---- nestedness ------------------------------------------------------------------------------------------------------------------------------------

/// Equispaced Lagrange nodes of a simplex (dim 1 or 2) in barycentric coordinates, and the basis: product of (p b_c - m) / (m + 1), m < p node_c.
std::vector<Vec3<double>> lagrange_nodes(int dim, int p) {
  std::vector<Vec3<double>> nodes;
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= (dim == 2 ? p - i : 0); ++j) nodes.push_back((1.0 / p) * Vec3<double>{{1.0 * (p - i - j), 1.0 * i, 1.0 * j}});
  return nodes;
}
Weight lagrange_weights(int dim, int p, const Vec3<double>& b) {
  Weight l;
  for (const auto& node : lagrange_nodes(dim, p)) {
    l.push_back(1);
    for (int c = 0; c < 3; ++c)
      for (int m = 0; m < std::lround(p * node[c]); ++m) l.back() *= (p * b[c] - m) / (m + 1);
  }
  return l;
}
/// Some points inside.
std::vector<Vec3<double>> points_of(int dim) {
  testing::Random random(15);
  std::vector<Vec3<double>> points;
  for (int i = 0; i < 10; ++i) {
    const double x = uniform(random, 0.05, 0.45), y = dim == 2 ? uniform(random, 0.05, 0.45) : 0;
    points.push_back({{1 - x - y, x, y}});
  }
  return points;
}

/// Interpolates random data of order p, takes the values at the nodes of order q as data, and returns the largest difference at some points.
template <class R, class M>
double nesting_error(int dim, int p, int q, double spread = 0.5) {
  testing::Random random(10);
  const auto count = static_cast<int>(lagrange_nodes(dim, p).size());
  const Nodes<M> coarse = random_nodes<M>(random, M::origin(), count, spread);
  Nodes<M> fine;
  for (const auto& b : lagrange_nodes(dim, q)) fine.push_back(point<R, M>(coarse, lagrange_weights(dim, p, b)));
  double largest = 0;
  for (const auto& b : points_of(dim))
    largest = std::max(largest, apart<M>(point<R, M>(fine, lagrange_weights(dim, q, b)), point<R, M>(coarse, lagrange_weights(dim, p, b))));
  return largest;
}

TEST(Nestedness, GeodesicInterpolationOfOrderOneIsNestedInOrderTwoOnALineOnly) {
  // On a line both run along the same geodesic with constant speed: the order-two mean of the ends and their midpoint is a point of the geodesic.
  const auto line = []<class M>() { EXPECT_LT((nesting_error<Geodesic, M>(1, 1, 2)), 1e-13) << M::name; };
  line.template operator()<Sphere<2>>();
  line.template operator()<Rotation>();
  line.template operator()<Spd<3>>();
  line.template operator()<Hyperbolic<2>>();
  // In higher dimensions the curvature is felt. The numbers, for data spread over about 0.5 (rounding would be 1e-15):
  const auto triangle = []<class M>(double number) {
    const double error = nesting_error<Geodesic, M>(2, 1, 2);
    EXPECT_GT(error, number / 3) << M::name;
    EXPECT_LT(error, 3 * number) << M::name;
  };
  triangle.template operator()<Sphere<2>>(5.1e-5);
  triangle.template operator()<Rotation>(7.4e-6);
  triangle.template operator()<Spd<3>>(2.1e-4);
  triangle.template operator()<Hyperbolic<2>>(4.8e-5);
  // Flat manifolds do not feel any.
  EXPECT_LT((nesting_error<Geodesic, Sphere<1>>(2, 1, 2)), 1e-14);
  // A curve of order two is not a geodesic, and not nested in order three.
  EXPECT_GT((nesting_error<Geodesic, Sphere<2>>(1, 2, 3)), 1e-5);
}

TEST(Nestedness, ProjectionsOfLagrangeSpacesAreNestedInTheOrder) {
  // P(V_p) with V_p all polynomials of order p into the ambient space: the coefficients of order q are the values of the polynomial before it is projected.
  const auto error = []<class M>(int dim, int p, int q) {
    testing::Random random(14);
    const Nodes<M> coarse = random_nodes<M>(random, M::origin(), static_cast<int>(lagrange_nodes(dim, p).size()), 0.5);
    Nodes<M> fine;
    for (const auto& b : lagrange_nodes(dim, q)) {
      const Weight l = lagrange_weights(dim, p, b);
      Point<M>& x = fine.emplace_back();
      for (std::size_t i = 0; i < l.size(); ++i) x += l[i] * coarse[i];
    }
    double largest = 0;
    for (const auto& b : points_of(dim))
      largest = std::max(
          largest, apart<M>(point<Projection, M>(fine, lagrange_weights(dim, q, b)), point<Projection, M>(coarse, lagrange_weights(dim, p, b))));
    return largest;
  };
  for (const int dim : {1, 2})
    for (const auto& [p, q] : {std::pair(1, 2), {1, 3}, {2, 3}}) {
      EXPECT_LT((error.template operator()<Sphere<2>>(dim, p, q)), 1e-14) << dim << p << q;
      EXPECT_LT((error.template operator()<Unitary>(dim, p, q)), 1e-14) << dim << p << q;
    }
}

TEST(Nestedness, ProjectionsOfNodalValuesOnTheManifoldAreNestedUpToTheirError) {
  // With coefficients on the manifold the interpolant of order q is another map: the chord has lost its length in the middle. The difference is that of an
  // interpolation error, of the order p + 1 in the size of the cell (here: in the spread of the data).
  for (const int dim : {1, 2}) {
    const double wide = nesting_error<Projection, Sphere<2>>(dim, 1, 2, 0.4), narrow = nesting_error<Projection, Sphere<2>>(dim, 1, 2, 0.1);
    EXPECT_GT(wide, 1e-5);
    EXPECT_LT(wide, 5e-2);
    EXPECT_NEAR(std::log(wide / narrow) / std::log(4.0), 3, 0.3);
  }
}

// ---- reference values ------------------------------------------------------------------------------------------------------------------------------

TEST(ReferenceValues, OfSpdMeans) {
  testing::Random random(11);
  const auto nodes = random_nodes<Spd<3>>(random, Spd<3>::origin(), 4, 0.6);
  const Weight l{0.5, 0.4, 0.3, -0.2};
  // mean(P A P^T, ...) = P mean P^T, and det(mean) = product of det^weight
  Mat3<double> g = identity<double, 3>();
  g(0, 1) = 0.7, g(2, 0) = -0.4, g(1, 1) = 1.6;
  const auto mean = Spd<3>::matrix(point<Geodesic, Spd<3>>(nodes, l));
  Nodes<Spd<3>> moved;
  double log_det = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    moved.push_back(Spd<3>::point(sym(g * Spd<3>::matrix(nodes[i]) * transpose(g))));
    log_det += l[i] * std::log(determinant(Spd<3>::matrix(nodes[i])));
  }
  EXPECT_LT(std::sqrt(norm2(Spd<3>::matrix(point<Geodesic, Spd<3>>(moved, l)) - g * mean * transpose(g))), 1e-12);
  EXPECT_NEAR(std::log(determinant(mean)), log_det, 1e-12);
  // (A#B) A^-1 (A#B) = B
  const auto a = Spd<3>::matrix(nodes[0]), b = Spd<3>::matrix(nodes[1]),
             m = Spd<3>::matrix(point<Geodesic, Spd<3>>({nodes[0], nodes[1]}, {0.5, 0.5}));
  EXPECT_LT(std::sqrt(norm2(m * inverse(a) * m - b)), 1e-12);
}

TEST(ReferenceValues, OfCommutingMatricesAreMeansOfTheLogarithms) {
  // Diagonal matrices are a flat subspace.
  const Weight l = p2_weights(0.3, 0.6);
  Nodes<Spd<2>> nodes;
  double first = 0, second = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double x = 0.3 * static_cast<double>(i) - 0.7, y = 0.5 - 0.4 * static_cast<double>(i % 3);
    nodes.push_back({{std::exp(x), 0, 0, std::exp(y)}});
    first += l[i] * x;
    second += l[i] * y;
  }
  const auto p = point<Geodesic, Spd<2>>(nodes, l);
  EXPECT_NEAR(std::log(p[0]), first, 1e-13);
  EXPECT_NEAR(std::log(p[3]), second, 1e-13);
  EXPECT_NEAR(p[1], 0, 1e-15);
}

// ---- data that are too far apart -------------------------------------------------------------------------------------------------------------------

template <class R, class M>
bool defined(const Nodes<M>& nodes, const Weight& l) {
  return value<R, M>(nodes, l).defined;
}

TEST(FarData, OppositePointsHaveNoMeanAndSayItForEveryWeight) {
  for (double t : {0.5, 0.3, 0.001}) {
    const Weight l{1 - t, t};
    EXPECT_FALSE((defined<Geodesic, Sphere<1>>({{{1, 0}}, {{-1, 0}}}, l)));
    EXPECT_FALSE((defined<Geodesic, Sphere<2>>({{{1, 0, 0}}, {{-1, 0, 0}}}, l)));
    EXPECT_FALSE((defined<Geodesic, Sphere<3>>({{{1, 0, 0, 0}}, {{-1, 0, 0, 0}}}, l)));
    EXPECT_FALSE((defined<Geodesic, Unitary>({{{1, 0, 0, 0}}, {{-1, 0, 0, 0}}}, l)));
    // rotations by pi against each other
    EXPECT_FALSE((defined<Geodesic, Rotation>({{{1, 0, 0, 0}}, {{0, 1, 0, 0}}}, l)));
    EXPECT_FALSE((defined<Geodesic, Rotation>({{{std::sqrt(0.5), std::sqrt(0.5), 0, 0}}, {{-std::sqrt(0.5), std::sqrt(0.5), 0, 0}}}, l)));
  }
  // The projection of opposite points exists but in the middle.
  EXPECT_FALSE((defined<Projection, Sphere<2>>({{{1, 0, 0}}, {{-1, 0, 0}}}, {0.5, 0.5})));
  EXPECT_FALSE((defined<Projection, Sphere<1>>({{{0, 1}}, {{0, -1}}}, {0.5, 0.5})));
  EXPECT_FALSE((defined<Projection, Rotation>({{{1, 0, 0, 0}}, {{0, 1, 0, 0}}}, {0.5, 0.5})));
}

TEST(FarData, PointsAllAroundHaveNoMean) {
  Nodes<Sphere<1>> circle;
  Nodes<Sphere<2>> equator;
  Nodes<Rotation> rotations;  // about one axis by 0, 120 and 240 degrees
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * pi * i / 3;
    circle.push_back({{std::cos(a), std::sin(a)}});
    equator.push_back({{std::cos(a), std::sin(a), 0}});
    rotations.push_back({{std::cos(a / 2), 0, 0, std::sin(a / 2)}});
  }
  const Weight equal(3, 1.0 / 3);
  EXPECT_FALSE((defined<Geodesic, Sphere<1>>(circle, equal)));
  EXPECT_FALSE((defined<Geodesic, Sphere<2>>(equator, equal)));
  EXPECT_FALSE((defined<Geodesic, Rotation>(rotations, equal)));
  EXPECT_FALSE((defined<Projection, Sphere<1>>(circle, equal)));
  EXPECT_FALSE((defined<Projection, Sphere<2>>(equator, equal)));
  EXPECT_FALSE((defined<Projection, Rotation>(rotations, equal)));
}

TEST(FarData, IsReportedFromTheBoundOnAndRightBelowIt) {
  // Two points at the distance r: the mean is unique for r < pi and then the midpoint.
  for (const double gap : {0.5, 0.1, 1e-3, 1e-6}) {
    const double r = pi - gap;
    const auto m = point<Geodesic, Sphere<2>>({{{1, 0, 0}}, {{std::cos(r), std::sin(r), 0}}}, {0.5, 0.5});
    EXPECT_NEAR(m[0], std::cos(r / 2), 1e-9);
    EXPECT_NEAR(m[1], std::sin(r / 2), 1e-9);
    const auto q = point<Geodesic, Rotation>({{{1, 0, 0, 0}}, {{std::cos(r / 2), std::sin(r / 2), 0, 0}}}, {0.5, 0.5});
    EXPECT_NEAR(std::fabs(q[0]), std::cos(r / 4), 1e-9);
  }
}

TEST(FarData, WhatIsNotReportedIsACriticalPointInTheBall) {
  // Random triples of any spread on the sphere and of rotations: undefined, or the gradient of the sum of squared distances vanishes there.
  const auto check = []<class M>() {
    testing::Random random(12);
    int refused = 0;
    for (int sample = 0; sample < 300; ++sample) {
      const Nodes<M> nodes = random_nodes<M>(random, M::origin(), 6, uniform(random, 0.1, 2.5));
      const Weight l = p2_weights(uniform(random, 0.05, 0.5), uniform(random, 0.05, 0.45));
      const auto v = value<Geodesic, M>(nodes, l);
      if (!v.defined) {
        ++refused;
        continue;
      }
      Point<M> gradient{};
      for (std::size_t i = 0; i < 6; ++i) gradient += l[i] * M::log(v.point, nodes[i]);
      EXPECT_LT(std::sqrt(M::inner(v.point, gradient, gradient)), 1e-12) << M::name;
    }
    EXPECT_GT(refused, 30) << M::name;
    EXPECT_LT(refused, 270) << M::name;
  };
  check.template operator()<Sphere<1>>();
  check.template operator()<Sphere<2>>();
  check.template operator()<Sphere<3>>();
  check.template operator()<Rotation>();
}

TEST(FarData, NeverFailsWithoutCutLocus) {
  const auto check = []<class M>(double spread) {
    testing::Random random(13);
    for (int sample = 0; sample < 50; ++sample) {
      const Nodes<M> nodes = random_nodes<M>(random, M::origin(), 3, spread);
      const auto m = point<Geodesic, M>(nodes, {0.5, 0.3, 0.2});
      Point<M> gradient{};
      const Weight l{0.5, 0.3, 0.2};
      for (std::size_t i = 0; i < 3; ++i) gradient += l[i] * M::log(m, nodes[i]);
      EXPECT_LT(std::sqrt(norm2(coordinates<M>(m, M::frame(m), gradient))), 1e-8) << M::name;
    }
  };
  check.template operator()<Spd<2>>(3.0);
  check.template operator()<Spd<3>>(3.0);
  check.template operator()<Hyperbolic<2>>(3.0);
  check.template operator()<Hyperbolic<3>>(3.0);
}

TEST(FieldAtAPoint, HasTheValuesOfTheRulesAndReportsUndefinedData) {
  const std::vector<double> nodes{1, 0, 0, 0, 1, 0, 0, 0, 1}, l{.5, .3, .2};
  const auto geodesic = evaluate_field(manifold_ops<Sphere<2>>(), Rule::geodesic, nodes, l);
  const auto projection = evaluate_field(manifold_ops<Sphere<2>>(), Rule::projection, nodes, l);
  const double g[3] = {0.774245752809689, 0.515343944168288, 0.367374650003549}, p[3] = {0.811107105653813, 0.486664263392288, 0.324442842261525};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(geodesic.value[c], g[c], 1e-12);
    EXPECT_NEAR(projection.value[c], p[c], 1e-12);
  }
  const std::vector<double> opposite{1, 0, 0, -1, 0, 0}, half{.5, .5};
  EXPECT_FALSE(evaluate_field(manifold_ops<Sphere<2>>(), Rule::geodesic, opposite, half).defined);
  EXPECT_FALSE(evaluate_field(manifold_ops<Sphere<2>>(), Rule::projection, opposite, half).defined);
  EXPECT_THROW(evaluate_field(manifold_ops<Spd<2>>(), Rule::projection, std::vector<double>{1, 0, 0, 1}, std::vector<double>{1}), InputError);
}

}  // namespace
}  // namespace karcher
