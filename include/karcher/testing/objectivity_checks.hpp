#pragma once
/// \file
/// Is an energy of positions and rotations the same after a rigid motion, E(A m + c, A Q) = E(m, Q)?
///
///     const double change = largest_change_by_rigid_motions(energy, positions, rotations);
///     EXPECT_LT(change, 1e-12);

#include <algorithm>
#include <cmath>
#include <vector>

#include "karcher/manifold/rotation.hpp"
#include "karcher/testing/random.hpp"

namespace karcher {

/// \param energy     double(const std::vector<Vec3<double>>&, const std::vector<Quaternion<double>>&)
/// \param positions  points of R^3 (or empty)
/// \param rotations  unit quaternions (or empty)
/// \param distance   size of the translations
/// \returns the largest |E' - E| / |E| over some random rigid motions; the plain difference where E is zero
template <class Energy>
double largest_change_by_rigid_motions(const Energy& energy, const std::vector<Vec3<double>>& positions,
                                       const std::vector<Quaternion<double>>& rotations, double distance = 1, int motions = 10,
                                       std::uint64_t seed = 1) {
  Random random(seed);
  const double before = energy(positions, rotations);
  double change = 0;
  for (int i = 0; i < motions; ++i) {
    const Quaternion<double> a = random.direction<4>();
    const Mat3<double> matrix = rotation_matrix(a);
    const Vec3<double> c = distance * random.normal_vector<3>();
    auto m = positions;
    auto q = rotations;
    for (auto& x : m) x = matrix * x + c;
    for (auto& x : q) x = quaternion_product(a, x);
    const double difference = std::abs(energy(m, q) - before) / (before == 0 ? 1 : std::abs(before));
    if (!(difference <= change)) change = difference;  // NaN stays
  }
  return change;
}

}  // namespace karcher
