// What is asked of a manifold beside its geometry: the built-in answers, those of a type that says nothing, and those of a type that says all.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "karcher/error.hpp"
#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/every_manifold.hpp"
#include "karcher/manifold/product.hpp"

using namespace karcher;

namespace {

/// The circle by its geometry alone.
struct Plain {
  static constexpr std::string_view name = "SO3";  // what others are called is of no importance
  static constexpr int ambient = 2, dim = 1;
  static constexpr double injectivity_radius = std::numbers::pi;
  template <class T>
  static Vec<T, 2> exp(const Vec<T, 2>& p, const Vec<T, 2>& a) {
    return Sphere<1>::exp(p, a);
  }
  template <class T>
  static Vec<T, 2> log(const Vec<T, 2>& p, const Vec<T, 2>& q) {
    return Sphere<1>::log(p, q);
  }
  template <class T>
  static T inner(const Vec<T, 2>&, const Vec<T, 2>& a, const Vec<T, 2>& b) {
    return dot(a, b);
  }
  template <class T>
  static Mat<T, 2, 1> frame(const Vec<T, 2>& p) {
    return Sphere<1>::frame(p);
  }
};

/// The circle of lines through the origin of the plane, which may be given by their angle.
struct Lines : Plain {
  static constexpr std::string_view name = "lines", description = "lines of the plane";
  static constexpr bool has_identity = true;
  static Vec<double, 2> standard_point() { return {{0, 1}}; }
  /// n n^T / sqrt 2: the same for n and -n, and small distances are angles.
  template <class T>
  static Vec<T, 3> error_coordinates(const Vec<T, 2>& n) {
    return {{n[0] * n[0] * std::numbers::sqrt2 / 2.0, n[0] * n[1], n[1] * n[1] * std::numbers::sqrt2 / 2.0}};
  }
  struct Entries {
    static constexpr std::array counts{1};
    static constexpr std::string_view wanted = "an angle or two coordinates";
    static bool make_point(std::span<const double> e, Vec<double, 2>& p) {
      p = {{std::cos(e[0]), std::sin(e[0])}};
      return std::abs(e[0]) < 10;
    }
    template <class T>
    static Vec<T, 3> error_coordinates(std::span<const T> e) {
      return Lines::error_coordinates(Vec<T, 2>{{cos(e[0]), sin(e[0])}});
    }
  };
  static std::vector<Quantity> quantities() {
    return {quantity<2>("angle", [](const Vec<double, 2>& n) { return Vec<double, 1>{{std::atan2(n[1], n[0])}}; })};
  }
  static Drawing drawing() { return {.glyph = Glyph::rod, .coordinates = {0, 1}, .components = false}; }
};

struct WronglyDrawn : Plain {
  static Drawing drawing() { return {.glyph = Glyph::arrow, .coordinates = {0, 1, 2}}; }
};

}  // namespace

TEST(Traits, StandardPointsAreZeroTheIdentityTheLastAxisOfASphereAndTheFirstOfAHyperboloid) {
  using Point = std::vector<double>;
  const std::map<std::string, Point> points{{"R1", {0}},       {"R2", {0, 0}},       {"R3", {0, 0, 0}},      {"S1", {0, 1}},
                                            {"S2", {0, 0, 1}}, {"S3", {0, 0, 0, 1}}, {"SO3", {1, 0, 0, 0}},  {"SU2", {1, 0, 0, 0}},
                                            {"H2", {1, 0, 0}}, {"H3", {1, 0, 0, 0}}, {"SPD2", {1, 0, 0, 1}}, {"SPD3", {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
  for (const std::string& name : manifold_names()) {
    const ManifoldOps& m = manifold_by_name(name);
    EXPECT_EQ(m.standard_point, points.at(name)) << name;
    Point p(m.standard_point.size());
    EXPECT_TRUE(m.make_point(m.standard_point.data(), p.data())) << name;
    EXPECT_EQ(p, m.standard_point) << name;
    EXPECT_EQ(m.has_identity, name == "SO3" || name == "SU2" || name == "SPD2" || name == "SPD3") << name;
    EXPECT_EQ(m.linear, name == "R1" || name == "R2" || name == "R3") << name;
    EXPECT_EQ(m.lengths, std::vector<bool>(static_cast<std::size_t>(m.dim), m.linear)) << name;
    EXPECT_EQ(m.body_axes, name == "SO3") << name;
    EXPECT_FALSE(m.description.empty()) << name;
  }
}

TEST(Traits, OfATypeThatSaysNothingAreThoseOfItsAmbientCoordinates) {
  const ManifoldOps& m = manifold_ops<Plain>();
  EXPECT_FALSE(m.linear);
  EXPECT_FALSE(m.body_axes);
  EXPECT_FALSE(m.has_identity);
  EXPECT_TRUE(m.standard_point.empty());
  EXPECT_EQ(m.lengths, std::vector<bool>{false});
  EXPECT_EQ(m.entries.counts, std::vector<int>{2});
  EXPECT_EQ(m.entries.wanted, "2 numbers or expressions");
  const double e[] = {0.6, 0.8};
  double p[2], x[2], dx[2];
  EXPECT_TRUE(m.entries.make_point(e, 2, p));
  EXPECT_EQ(p[0], 0.6);
  ASSERT_EQ(m.error_size, 2);
  m.error_coordinates(e, x);
  m.error_derivative(p, e, dx);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(x[i], e[i]);
    EXPECT_EQ(dx[i], e[i]);
  }
  EXPECT_TRUE(m.quantities.empty() && m.arrays.empty());
  EXPECT_EQ(m.drawing.glyph, Glyph::none);
  EXPECT_TRUE(m.drawing.components);
  EXPECT_FALSE(m.drawing.place);
}

TEST(Traits, OfATypeThatSaysAllAreItsOwn) {
  const ManifoldOps& m = manifold_ops<Lines>();
  EXPECT_EQ(m.description, "lines of the plane");
  EXPECT_TRUE(m.has_identity);
  EXPECT_EQ(m.standard_point, (std::vector<double>{0, 1}));
  EXPECT_EQ(m.entries.counts, (std::vector<int>{2, 1}));
  EXPECT_EQ(m.entries.wanted, "an angle or two coordinates");
  const double angle = 0.7, far = 11;
  double p[2], x[3], dx[3];
  EXPECT_TRUE(m.entries.make_point(&angle, 1, p));
  EXPECT_EQ(p[1], std::sin(angle));
  EXPECT_FALSE(m.entries.make_point(&far, 1, p));
  EXPECT_EQ(p[1], std::sin(angle));  // untouched
  // n and -n are the same, and the coordinates move as fast as the angle, whichever way they are made.
  const double opposite[] = {-p[0], -p[1]}, speed[] = {-p[1], p[0]};
  double y[3];
  m.error_coordinates(p, x);
  m.error_coordinates(opposite, y);
  m.error_derivative(p, speed, dx);
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(x[i], y[i]);
    square += dx[i] * dx[i];
  }
  EXPECT_NEAR(square, 1, 1e-15);
  Dual<double, 3> moving(angle), coordinates[3];
  moving.d = {1, 0, 2};
  m.entries.error_coordinates(&moving, 1, coordinates);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(coordinates[i].v, x[i], 1e-15);
    EXPECT_NEAR(coordinates[i].d[0], dx[i], 1e-15);
    EXPECT_NEAR(coordinates[i].d[2], 2 * dx[i], 1e-15);
  }
  ASSERT_EQ(m.quantities.size(), 1U);
  EXPECT_EQ(m.quantities[0].name, "angle");
  ASSERT_EQ(m.quantities[0].components, 1);
  m.quantities[0].value(p, x);
  EXPECT_NEAR(x[0], angle, 1e-15);
  EXPECT_EQ(m.drawing.glyph, Glyph::rod);
}

TEST(Traits, OfAProductCountLengthsFactorByFactor) {
  EXPECT_EQ((manifold_ops<Product<Rotation, Euclidean<2>>>().lengths), (std::vector<bool>{false, false, false, true, true}));
}

TEST(Traits, DirectorsForFilesAreThoseForProbes) {
  const ManifoldOps& m = manifold_ops<Rotation>();
  const Vec<double, 4> q = Rotation::from_rotation_vector(Vec3<double>{{0.3, -1.1, 0.4}});
  ASSERT_EQ(m.arrays.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    double a[3], b[3];
    EXPECT_EQ(m.arrays[k].name, m.quantities[k + 1].name);
    m.arrays[k].value(q.e.data(), a);
    m.quantities[k + 1].value(q.e.data(), b);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(a[i], b[i], 1e-15);
      EXPECT_NEAR(b[i], Rotation::director(q, static_cast<int>(k))[i], 1e-15);
    }
  }
}

TEST(Traits, ADrawingThatTakesCoordinatesThatAreNotThereIsRefused) {
  EXPECT_THROW(manifold_ops<WronglyDrawn>(), InputError);
  EXPECT_EQ((Drawing{.glyph = Glyph::frame, .coordinates = {1, 2, 3, 0}}.complaint(4)), "");
  EXPECT_NE((Drawing{.glyph = Glyph::frame, .coordinates = {1, 2, 3}}.complaint(4)), "");
  EXPECT_NE((Drawing{.coordinates = {0}}.complaint(4)), "");
  EXPECT_NE((Drawing{.glyph = Glyph::ellipsoid, .coordinates = {0, 3, -1}}.complaint(4)), "");
}
