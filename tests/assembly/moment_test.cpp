#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assembly/map_problem.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher {
namespace {

using testing::MapProblem;
using Point3 = Vec3<double>;

constexpr double pi = std::numbers::pi;

/// Rotations on a region of a generated mesh that start at random and have turned by `angle` about their second axis.
MapProblem turned(const std::string& generator, std::map<std::string, std::vector<double>> numbers, int order, const std::string& region,
                  double angle, const Point3& moment) {
  MapProblem p(testing::moved_mesh(generator, std::move(numbers), ""), manifold_ops<Rotation>(), Rule::projection, order, region);
  const auto start = quaternion_of_rotation_vector(Point3{{0.7, -1.1, 0.4}});
  Configuration initial;
  initial.values.resize(1);
  for (int n = 0; n < p.space().node_count(); ++n) {
    const auto now = quaternion_product(start, quaternion_of_rotation_vector(Point3{{0, angle, 0}}));
    initial.values[0].insert(initial.values[0].end(), start.e.begin(), start.e.end());
    p.u.values[0].insert(p.u.values[0].end(), now.e.begin(), now.e.end());
  }
  p.input.initial = std::make_shared<const Configuration>(initial);
  p.input.free_axes.assign(static_cast<std::size_t>(p.space().node_count()), 1);
  for (int c = 0; c < 3; ++c) p.input.parameters["value[" + std::to_string(c) + "]"] = moment[c];
  p.make("moment-load");
  return p;
}
const Point3 axis = Rotation::director(quaternion_of_rotation_vector(Point3{{0.7, -1.1, 0.4}}), 1);
double energy(const MapProblem& p) { return p.functional->energy(p.u).energy; }

TEST(Moment, WorksByItsAngleThroughOneAndAHalfTurns) {
  const Point3 across = cross(axis, Point3{{1, 2, 3}});
  for (const double sense : {1.0, -1.0})
    for (const double angle : {-0.99 * pi, -0.5, 0.0, 1.0, pi, 1.99 * pi, 2 * pi, 2.99 * pi})
      // Five cells of length 2 in all, and what is across the axis does no work.
      EXPECT_NEAR(energy(turned("interval", {{"length", {2}}, {"cells", {5}}}, 3, "all", sense * angle, sense * 0.3 * axis + across)),
                  -0.3 * 2 * angle, 1e-13);
  EXPECT_NEAR(energy(turned("interval", {{"length", {2}}}, 2, "left", 1.5, 0.3 * axis)), -0.45, 1e-14);
  EXPECT_NEAR(energy(turned("rectangle", {{"size", {2, 3}}}, 2, "all", 1.5, 0.3 * axis)), -0.45 * 6, 1e-13);
}

TEST(Moment, HasTheWorkInAllDirectionsAsGradientAndNoHessian) {
  const Point3 moment{{0.3, -0.8, 0.5}};
  const MapProblem p = turned("interval", {{"cells", {2}}}, 2, "all", 0.8, moment);
  const testing::Dense d(p);
  Point3 sum;
  for (int n = 0; n < p.space().node_count(); ++n) {
    const auto first = static_cast<std::size_t>(p.layout->first_dof(0, n));
    sum += rotation_matrix(manifold_detail::read<4>(p.u.at(0, n, 4))) * Point3{{d.gradient[first], d.gradient[first + 1], d.gradient[first + 2]}};
  }
  EXPECT_LT(norm2(sum + moment), 1e-28);
  for (const auto& row : d.hessian)
    for (const double x : row) EXPECT_EQ(x, 0);
  // Along the free axis the energy is linear.
  MapProblem later = turned("interval", {{"cells", {2}}}, 2, "all", 0.9, moment);
  EXPECT_NEAR(energy(later) - d.evaluation.energy, -0.1 * dot(moment, axis), 1e-14);
}

TEST(Moment, ChangesWithPlaceAndLoad) {
  MapProblem p = turned("interval", {{"length", {2}}}, 1, "all", 1, {});
  for (int c = 0; c < 3; ++c) {
    ParameterValue& value = p.input.parameters["value[" + std::to_string(c) + "]"];
    value.function = [c](const Point3& x, double t) { return x[0] * t * axis[c]; };
    value.depends_on_t = true;
  }
  p.make("moment-load");
  EXPECT_EQ(energy(p), 0);
  p.functional->set_load_parameter(3);
  EXPECT_NEAR(energy(p), -6, 1e-13);
}

TEST(Moment, WantsToKnowItsAxes) {
  MapProblem p = turned("interval", {}, 1, "all", 1, axis);
  p.input.free_axes.clear();
  EXPECT_THROW(p.make("moment-load"), InputError);
}

}  // namespace
}  // namespace karcher
