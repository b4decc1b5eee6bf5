#include <gtest/gtest.h>

#include "karcher/testing/objectivity_checks.hpp"

using namespace karcher;

namespace {

using Positions = std::vector<Vec3<double>>;
using Rotations = std::vector<Quaternion<double>>;

/// A rod element: strain Q^T (m1 - m0) against e_3, and the relative rotation.
double rod(const Positions& m, const Rotations& q) {
  Vec3<double> v = transpose_times(rotation_matrix(q[0]), m[1] - m[0]);
  v[2] -= 1;
  const double angle = Rotation::dist(q[0], q[1]);
  return norm2(v) + angle * angle;
}

}  // namespace

TEST(Objectivity, SeesRigidMotionsOnlyInEnergiesThatAreNotObjective) {
  Random random(1);
  const Positions m{random.normal_vector<3>(), random.normal_vector<3>()};
  const Rotations q{random.direction<4>(), random.direction<4>()};
  EXPECT_LT(largest_change_by_rigid_motions(rod, m, q), 1e-13);
  const auto spatial_strain = [](const Positions& x, const Rotations& r) { return rod(x, r) + 1e-6 * x[0][0]; };
  EXPECT_GT(largest_change_by_rigid_motions(spatial_strain, m, q), 1e-8);
  const auto wrong_side = [](const Positions& x, const Rotations& r) {
    return norm2(rotation_matrix(r[0]) * (x[1] - x[0]) - Vec3<double>{{0, 0, 1}});
  };
  EXPECT_GT(largest_change_by_rigid_motions(wrong_side, m, q), 1e-3);
}
