// The law suite must see what is wrong: spheres with one mistake each.
#include <gtest/gtest.h>

#include "karcher/manifold/sphere.hpp"
#include "karcher/testing/manifold_laws.hpp"

using namespace karcher;

namespace {

using S2 = Sphere<2>;

struct WrongScaleOfLog : S2 {
  template <class T>
  static Vec<T, 3> log(const Vec<T, 3>& p, const Vec<T, 3>& q) {
    return (1 + 1e-9) * S2::log(p, q);
  }
};
struct WrongMetric : S2 {
  template <class T>
  static T inner(const Vec<T, 3>& p, const Vec<T, 3>& a, const Vec<T, 3>& b) {
    return (1.0 + 0.01 * p[0]) * dot(a, b);
  }
  static double dist(const Vec<double, 3>& p, const Vec<double, 3>& q) = delete;
  template <class T>
  static Mat<T, 3, 2> frame(const Vec<T, 3>& p) {
    return (T(1.0) / sqrt(1.0 + 0.01 * p[0])) * S2::frame(p);
  }
};
struct SkewFrame : S2 {
  template <class T>
  static Mat<T, 3, 2> frame(const Vec<T, 3>& p) {
    auto e = S2::frame(p);
    for (int i = 0; i < 3; ++i) e(i, 0) += 1e-8 * e(i, 1);
    return e;
  }
};
struct ProjectionThatLeaves : S2 {
  template <class T>
  static Vec<T, 3> project(const Vec<T, 3>& x) {
    return (1 + 1e-9) * S2::project(x);
  }
};
/// x / |x| with respect to another norm: idempotent, on the sphere, not the closest point.
struct ProjectionNotClosest : S2 {
  template <class T>
  static Vec<T, 3> project(const Vec<T, 3>& x) {
    const T excess = norm2(x) - 1.0;
    Vec<T, 3> y = x;
    y[2] += excess;
    return S2::project(y);
  }
};
struct ExpWithoutSecondOrder : S2 {
  // A retraction, not the exponential map.
  template <class T>
  static Vec<T, 3> exp(const Vec<T, 3>& p, const Vec<T, 3>& a) {
    return S2::project(p + a);
  }
};
/// Takes a derivative-free shortcut: jets lose the second derivative of the length.
struct LogWithFrozenFactor : S2 {
  template <class T>
  static Vec<T, 3> log(const Vec<T, 3>& p, const Vec<T, 3>& q) {
    const T c = dot(p, q);
    return constant<T>(arc_ratio(base(c))) * (q - c * p);
  }
};

struct SphereThatIsCalledLinear : Sphere<1> {
  static constexpr int dim = 2;
  static constexpr bool linear = true;
  template <class T>
  static Mat<T, 2, 2> frame(const Vec<T, 2>&) {
    return identity<T, 2>();
  }
};

template <class M>
bool violates(const std::string& law) {
  for (const std::string& s : manifold_laws<M>())
    if (s.find(law) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST(ManifoldLaws, FindAWrongLog) { EXPECT_TRUE(violates<WrongScaleOfLog>("log does not invert exp")); }
TEST(ManifoldLaws, FindAMetricThatDoesNotBelongToTheExponentialMap) { EXPECT_TRUE(violates<WrongMetric>("geodesic changes its speed")); }
TEST(ManifoldLaws, FindASkewFrame) { EXPECT_TRUE(violates<SkewFrame>("frame is not orthonormal")); }
TEST(ManifoldLaws, FindAProjectionThatLeavesTheManifold) { EXPECT_TRUE(violates<ProjectionThatLeaves>("project moves a point")); }
TEST(ManifoldLaws, FindAProjectionThatIsNotClosest) { EXPECT_TRUE(violates<ProjectionNotClosest>("another point is closer")); }
TEST(ManifoldLaws, FindARetractionThatIsNotTheExponentialMap) { EXPECT_TRUE(violates<ExpWithoutSecondOrder>("log does not invert exp")); }
TEST(ManifoldLaws, FindLostDerivatives) { EXPECT_TRUE(violates<LogWithFrozenFactor>("derivatives of log are wrong")); }
TEST(ManifoldLaws, FindAManifoldThatIsCalledLinear) { EXPECT_TRUE(violates<SphereThatIsCalledLinear>("exp_p(a) is not p + a")); }
TEST(ManifoldLaws, FindNothingWrongWithTheSphere) { EXPECT_TRUE(manifold_laws<S2>().empty()); }
