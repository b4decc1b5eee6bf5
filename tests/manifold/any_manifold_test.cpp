#include "karcher/manifold/any_manifold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"

using namespace karcher;

TEST(AnyManifold, KnowsEveryNameWithItsDimensions) {
  struct Row {
    const char* name;
    int ambient, dim;
    bool projection;
  };
  const Row rows[] = {{"R1", 1, 1, true},    {"R2", 2, 2, true},    {"R3", 3, 3, true},  {"S1", 2, 1, true},
                      {"S2", 3, 2, true},    {"S3", 4, 3, true},    {"SO3", 4, 3, true}, {"SU2", 4, 3, true},
                      {"SPD2", 4, 3, false}, {"SPD3", 9, 6, false}, {"H2", 3, 2, false}, {"H3", 4, 3, false}};
  ASSERT_EQ(manifold_names().size(), std::size(rows));
  for (const Row& row : rows) {
    const ManifoldOps& m = manifold_by_name(row.name);
    EXPECT_EQ(m.name, row.name);
    EXPECT_EQ(m.ambient, row.ambient);
    EXPECT_EQ(m.dim, row.dim);
    EXPECT_EQ(m.has_projection, row.projection);
    EXPECT_FALSE(m.description.empty());
  }
}

TEST(AnyManifold, AnUnknownNameIsAnsweredWithTheNearest) {
  try {
    manifold_by_name("SO2");
    FAIL();
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("\"SO2\""), std::string::npos) << text;
    EXPECT_NE(text.find("Did you mean"), std::string::npos) << text;
    EXPECT_NE(text.find("SPD3"), std::string::npos) << text;
  }
}

TEST(AnyManifold, OperationsAreThoseOfTheType) {
  const ManifoldOps& m = manifold_by_name("SO3");
  const Vec<double, 4> p{{0.5, -0.5, 0.5, 0.5}};
  const Vec<double, 3> v{{0.3, -0.2, 0.9}};
  Vec<double, 4> q = p;
  m.retract(q.e.data(), v.e.data(), q.e.data());  // in place
  const Vec<double, 4> expected = retract<Rotation>(p, v);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(q[i], expected[i]);
  EXPECT_NEAR(m.dist(p.e.data(), q.e.data()), std::sqrt(norm2(v)), 1e-15);
  Vec<double, 4> a;
  m.log(p.e.data(), q.e.data(), a.e.data());
  EXPECT_NEAR(m.inner(p.e.data(), a.e.data(), a.e.data()), norm2(v), 1e-15);
  double frame[12];
  m.frame(p.e.data(), frame);
  EXPECT_EQ(frame[3 * 1 + 0], Rotation::frame(p)(1, 0));
  m.exp(p.e.data(), a.e.data(), q.e.data());
  EXPECT_NEAR(Rotation::dist(q, expected), 0, 1e-15);
}

TEST(AnyManifold, DataBecomePointsOrAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto accepts = [](const char* name, std::vector<double> x) {
    const std::vector<double> before = x;
    const bool good = manifold_by_name(name).make_point(x.data(), x.data());
    if (!good) {
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_TRUE(x[i] == before[i] || before[i] != before[i]);
    }
    return good;
  };
  EXPECT_TRUE(accepts("R3", {1, 2, 3}));
  EXPECT_FALSE(accepts("R3", {1, nan, 3}));
  EXPECT_TRUE(accepts("S2", {0, 3, 4}));
  EXPECT_FALSE(accepts("S2", {0, 0, 0}));
  EXPECT_TRUE(accepts("SO3", {2, 0, 0, 0}));
  EXPECT_FALSE(accepts("SO3", {0, 0, 0, 0}));
  EXPECT_TRUE(accepts("SPD2", {2, 1, 1, 2}));
  EXPECT_FALSE(accepts("SPD2", {1, 2, 2, 1}));
  EXPECT_FALSE(accepts("SPD2", {2, 1, 0, 2}));
  EXPECT_TRUE(accepts("H2", {1, 0, 0}));
  EXPECT_FALSE(accepts("H2", {2, 0, 0}));
  double x[3] = {0, 3, 4};
  manifold_by_name("S2").make_point(x, x);
  EXPECT_NEAR(x[1], 0.6, 2e-16);
}

TEST(Product, IsNamedAndLaidOutAfterItsFactors) {
  using M = Product<Euclidean<3>, Rotation, Spd<2>>;
  EXPECT_EQ(M::name, "R3xSO3xSPD2");
  EXPECT_EQ(M::ambient, 11);
  EXPECT_EQ(M::dim, 9);
  EXPECT_EQ(M::ambient_offset[2], 7);
  EXPECT_EQ(M::dim_offset[2], 6);
  EXPECT_EQ(M::injectivity_radius, Rotation::injectivity_radius);
  static_assert(!HasProjection<M> && HasProjection<Product<Euclidean<3>, Rotation>>);
  const ManifoldOps& ops = manifold_ops<M>();
  EXPECT_EQ(ops.name, "R3xSO3xSPD2");
  const auto p = M::origin();
  Vec<double, 9> v{{3, 4, 0, 0, 0, 2, 0, 0, 0}};
  EXPECT_NEAR(distance<M>(p, retract<M>(p, v)), std::sqrt(29.0), 1e-14);
}
