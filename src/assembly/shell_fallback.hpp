#pragma once
/// \file
/// The slow and sure ways to an interpolated rotation, one lane at a time, for the lanes where Newton's method fails.

namespace karcher::shell {

/// tr(Q^T sum_i l_i R_i) = 4 q^T N q - sum_i l_i with N = sum_i l_i q_i q_i^T: the closest rotation is the eigenvector of the largest eigenvalue of N.
/// \param q  n unit quaternions, either sign \param l  weights
/// \returns false, and the identity, if the two largest eigenvalues agree to 1e-8 (two rotations are equally close) or the data is not finite
bool closest_rotation(const double (*q)[4], const double* l, int n, double* found);

/// The weighted Riemannian mean, by Newton's method with gradient steps where that would go astray.
/// \returns false, and the identity, if it finds no minimiser
bool riemannian_mean(const double (*q)[4], const double* l, int n, double* found);

/// Whether all rotations lie within 90 degrees (half the injectivity radius) of their plain mean: then the mean with positive weights is unique (Afsari 2011).
bool unique_mean(const double (*q)[4], int n);

}  // namespace karcher::shell
