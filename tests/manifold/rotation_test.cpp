#include "karcher/manifold/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/testing/derivative_checks.hpp"
#include "karcher/testing/random.hpp"

using namespace karcher;

namespace {

using Q = Quaternion<double>;

Q random_rotation(Random& random) { return random.direction<4>(); }

double difference(const Mat3<double>& a, const Mat3<double>& b) { return std::sqrt(norm2(a - b)); }

/// exp([v]) by its series.
Mat3<double> matrix_exponential(const Vec3<double>& v) {
  const auto h = hat(v);
  auto term = identity<double, 3>(), sum = term;
  for (int k = 1; k < 60; ++k) {
    term = (1.0 / k) * (term * h);
    sum += term;
  }
  return sum;
}

/// Minimiser of |A - R|_F over a fine search, refined.
double best_trace(const Mat3<double>& a, Random& random) {
  double best = -1e300;
  for (int start = 0; start < 40; ++start) {
    Q q = random_rotation(random);
    double step = 1;
    double value = dot(rotation_matrix(q), a);
    for (int i = 0; i < 600; ++i) {
      const Q trial = retract<Rotation>(q, step * random.direction<3>());
      const double t = dot(rotation_matrix(trial), a);
      if (t > value) {
        q = trial;
        value = t;
      } else {
        step = std::max(0.97 * step, 1e-4);
      }
    }
    best = std::max(best, value);
  }
  return best;
}

}  // namespace

TEST(Rotation, RetractionIsTheBodyRotationVector) {
  Random random(1);
  for (double angle : {0.0, 1e-9, 0.3, 2.0, 3.1}) {
    const Q p = random_rotation(random);
    const auto v = angle * random.direction<3>();
    const auto expected = Rotation::to_matrix(p) * matrix_exponential(v);
    EXPECT_LT(difference(Rotation::to_matrix(retract<Rotation>(p, v)), expected), 2e-15);
    EXPECT_NEAR(Rotation::dist(p, retract<Rotation>(p, v)), angle, 2e-15);
  }
}

TEST(Rotation, OppositeQuaternionsAreOnePoint) {
  Random random(2);
  const Q p = random_rotation(random), q = random_rotation(random);
  EXPECT_EQ(Rotation::dist(p, -p), 0);
  EXPECT_NEAR(Rotation::dist(p, q), Rotation::dist(p, -q), 1e-15);
  EXPECT_LT(norm2(Rotation::log(p, q) - Rotation::log(p, -q)), 1e-30);
  EXPECT_LT(difference(Rotation::to_matrix(p), Rotation::to_matrix(-p)), 1e-16);
  EXPECT_LT(norm2(Rotation::chord(p, q) - Rotation::chord(p, -q)), 1e-30);
}

TEST(Rotation, QuaternionsMultiplyLikeMatrices) {
  Random random(3);
  const Q p = random_rotation(random), q = random_rotation(random);
  EXPECT_LT(difference(Rotation::to_matrix(Rotation::product(p, q)), Rotation::to_matrix(p) * Rotation::to_matrix(q)), 2e-15);
  EXPECT_LT(difference(Rotation::to_matrix(conjugate(p)), transpose(Rotation::to_matrix(p))), 1e-15);
  const auto v = random.normal_vector<3>();
  EXPECT_LT(norm2(times_imaginary(p, v) - quaternion_product(p, Q{{0, v[0], v[1], v[2]}})), 1e-30);
  EXPECT_LT(norm2(left_invariant_frame(p) * v - times_imaginary(p, v)), 1e-30);
}

TEST(Rotation, VectorsAndQuaternionsConvertBothWays) {
  Random random(4);
  for (double angle : {1e-14, 1e-7, 0.1, 1.0, 3.0, 3.14159}) {
    const auto v = angle * random.direction<3>();
    const auto back = Rotation::to_rotation_vector(-Rotation::from_rotation_vector(v));
    EXPECT_LT(std::sqrt(norm2(back - v)), 2e-15 * (1 + angle));
    EXPECT_LT(difference(Rotation::to_matrix(Rotation::from_rotation_vector(v)), matrix_exponential(v)), 3e-15);
  }
}

TEST(Rotation, ChordHasTheBodyCoordinatesOfThePolarRule) {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const Q q = random_rotation(random), p = random_rotation(random);
    const auto body = coordinates<Rotation>(q, Rotation::frame(q), Rotation::chord(q, p));
    const auto expected = ax(transpose_times(Rotation::to_matrix(q), Rotation::to_matrix(p)));
    EXPECT_LT(std::sqrt(norm2(body - expected)), 2e-15);
    // and it is the gradient of -1/2 |R(p) - R(q)|^2 in q
    const auto v = random.direction<3>();
    const auto f = [&](double t) { return -0.5 * norm2(Rotation::to_matrix(p) - Rotation::to_matrix(retract<Rotation>(q, t * v))); };
    EXPECT_TRUE(taylor_slopes(f, f(0), dot(body, v), 0).gradient_holds());
  }
}

TEST(Polar, AveragesOfThreeRotationsHaveTheReferenceValue) {
  // exp(e1^), exp(e2^), exp(e3^) with the weights .5, .3, .2, against an independent computation (largest eigenvector of sum l_i q_i q_i^T)
  Q nodes[3];
  for (int k = 0; k < 3; ++k) {
    Vec3<double> v;
    v[k] = 1;
    nodes[k] = Rotation::from_rotation_vector(v);
  }
  const double weights[3] = {.5, .3, .2};
  for (int signs = 0; signs < 8; ++signs) {
    Q q[3];
    for (int k = 0; k < 3; ++k) q[k] = (signs >> k & 1) != 0 ? -nodes[k] : nodes[k];
    const auto average = rotation_average(q, weights, 3);
    ASSERT_TRUE(average.defined);
    const auto v = Rotation::to_rotation_vector(average.q);
    EXPECT_NEAR(v[0], 0.545266034909888, 1e-14);
    EXPECT_NEAR(v[1], 0.308112668562855, 1e-14);
    EXPECT_NEAR(v[2], 0.199598226963173, 1e-14);
  }
}

TEST(Polar, FindsTheFactorOfAStretchedRotation) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const Q q = random_rotation(random);
    Mat3<double> b;
    for (double& x : b.e) x = random.normal();
    const auto stretch = transpose_times(b, b) + 0.05 * identity<double, 3>();
    const auto factor = polar_factor(Rotation::to_matrix(q) * stretch);
    ASSERT_TRUE(factor.defined);
    EXPECT_LT(Rotation::dist(factor.q, q), 1e-13);
  }
}

TEST(Polar, IsTheClosestRotationAlsoForLargeDistortionsAndFromABadStart) {
  Random random(7);
  for (int i = 0; i < 12; ++i) {
    Mat3<double> a;
    for (double& x : a.e) x = random.normal();  // half of these have a negative determinant
    const auto from_bad_start = polar_factor(a, random_rotation(random));
    const auto factor = polar_factor(a);
    ASSERT_TRUE(factor.defined);
    ASSERT_TRUE(from_bad_start.defined);
    EXPECT_LT(Rotation::dist(factor.q, from_bad_start.q), 1e-12);
    const double reached = dot(Rotation::to_matrix(factor.q), a), searched = best_trace(a, random);
    EXPECT_GT(reached, searched - 1e-9);
    EXPECT_LT(reached, searched + 1e-2);
  }
}

TEST(Polar, ReportsMatricesWithoutAUniqueClosestRotation) {
  EXPECT_FALSE(polar_factor(Mat3<double>{}).defined);
  EXPECT_FALSE(polar_factor(diagonal(Vec3<double>{{1, 0, 0}})).defined);
  EXPECT_FALSE(polar_factor(diagonal(Vec3<double>{{1, 1, -1}})).defined);
  EXPECT_FALSE(polar_factor(-1.0 * identity<double, 3>()).defined);
  EXPECT_FALSE(polar_factor(std::numeric_limits<double>::quiet_NaN() * identity<double, 3>()).defined);
  EXPECT_TRUE(polar_factor(diagonal(Vec3<double>{{1, 1, 0}})).defined);  // two directors determine the third
  EXPECT_THROW(Rotation::from_matrix(diagonal(Vec3<double>{{1, 1, -1}})), InputError);
  // two rotations by pi about different axes: no mean
  const Q opposite[2] = {{{1, 0, 0, 0}}, {{0, 1, 0, 0}}};
  const double half[2] = {0.5, 0.5};
  EXPECT_FALSE(rotation_average(opposite, half, 2).defined);
}

TEST(Polar, ScalesAndRotatesWithTheMatrix) {
  Random random(8);
  Mat3<double> a;
  for (double& x : a.e) x = random.normal();
  const Q q = polar_factor(a).q, g = random_rotation(random);
  for (double scale : {1e-30, 1e-3, 1e20}) EXPECT_LT(Rotation::dist(polar_factor(scale * a).q, q), 1e-13);
  EXPECT_LT(Rotation::dist(polar_factor(Rotation::to_matrix(g) * a).q, Rotation::product(g, q)), 1e-13);
}

TEST(Polar, AgreesInPacksWithLanesThatNeedTheFallBack) {
  Random random(9);
  using P = Pack<8>;
  for (int i = 0; i < 20; ++i) {
    Mat3<P> a;
    Quaternion<P> start;
    std::array<Mat3<double>, 8> one;
    for (int l = 0; l < 8; ++l) {
      const double distortion = l < 4 ? 0.1 : 1.5;
      one[static_cast<std::size_t>(l)] = identity<double, 3>();
      for (double& x : one[static_cast<std::size_t>(l)].e) x += distortion * random.normal();
      if (l == 7) one[7] = Mat3<double>{};
      for (std::size_t c = 0; c < 9; ++c) set_lane(a.e[c], l, one[static_cast<std::size_t>(l)].e[c]);
    }
    start[0] = P(1.0);
    start[1] = start[2] = start[3] = P(0.0);
    const auto packed = polar_factor(a, start);
    EXPECT_FALSE(packed.defined[7]);
    for (int l = 0; l < 7; ++l) {
      const auto alone = polar_factor(one[static_cast<std::size_t>(l)]);
      ASSERT_EQ(packed.defined[l], alone.defined);
      Q q;
      for (int c = 0; c < 4; ++c) q[c] = lane(packed.q[c], l);
      EXPECT_LT(Rotation::dist(q, alone.q), 1e-12);
    }
  }
}

TEST(Polar, HasExactDerivatives) {
  Random random(10);
  using J = Jet<double, 1>;
  Mat3<double> a = identity<double, 3>(), b;
  for (double& x : a.e) x += 0.3 * random.normal();
  for (double& x : b.e) x = random.normal();
  const auto c = random.direction<4>();
  const Q start = polar_factor(a).q;
  const auto f = [&](const auto& t) {
    using S = std::decay_t<decltype(t)>;
    return dot(cast<S>(c), polar_factor(cast<S>(a) + t * cast<S>(b), start).q);
  };
  const J j = f(J::variable(0, 0));
  const TaylorSlopes s = taylor_slopes(f, f(0.0), j.gradient(0), j.hessian(0, 0), 0.02);
  EXPECT_TRUE(s.hessian_holds()) << s.sentence();
}
