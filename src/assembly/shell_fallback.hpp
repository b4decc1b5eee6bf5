#pragma once
/// \file
/// The slow and sure ways to an interpolated rotation, one lane at a time, for the lanes where Newton's method fails.

#include "karcher/manifold/quaternion.hpp"

namespace karcher::shell {

/// The rotation closest to sum_i l_i R(q_i), through the eigenvector of polar.hpp. \param q  n unit quaternions, either sign
/// \returns false, and the identity, if there is none, more than one, or the data is not finite
bool closest_rotation(const Quaternion<double>* q, const double* l, int n, Quaternion<double>& found);

/// The weighted Riemannian mean, by Newton's method with gradient steps where that would go astray.
/// \returns false, and the identity, if it finds no minimiser
bool riemannian_mean(const Quaternion<double>* q, const double* l, int n, Quaternion<double>& found);

/// Whether all rotations lie within 90 degrees (half the injectivity radius) of their plain mean: then the mean with positive weights is unique
/// (Afsari 2011).
bool unique_mean(const Quaternion<double>* q, int n);

}  // namespace karcher::shell
