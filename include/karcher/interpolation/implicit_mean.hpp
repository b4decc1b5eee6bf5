#pragma once
/// \file
/// What every implicitly given mean has in common, whatever its two-point function (notation of weighted_mean.hpp): the test for a unique mean, one safeguarded
/// step of Newton's method for F0 = 0, the solution of the linearised equations, and the products of first variations in the second one.

#include <limits>
#include <vector>

#include "karcher/interpolation/interpolation.hpp"

namespace karcher::implicit_mean {

/// Lanes where all points lie in the ball of half the injectivity radius around `centre` (Afsari 2011: the mean with positive weights is then unique).
template <class M, class T>
MaskOf<T> close_to(const Point<M, T>& centre, const Point<M, T>* points, int count) {
  MaskOf<T> ok = T(0.0) < T(1.0);
  if (M::injectivity_radius < std::numeric_limits<double>::max()) {
    const double limit = 0.5 * M::injectivity_radius;
    for (int i = 0; i < count; ++i) {
      const auto a = M::log(centre, points[i]);
      ok = ok & (M::inner(centre, a, a) < T(limit * limit * (1 - 1e-10)));
    }
  }
  return ok;
}

/// Tangent coordinates of the next step where F0 = `residual` and G = `g`; zero in lanes that are done. Newton's convergence is quadratic: a lane is done where
/// the square of the Newton step that it makes now is below `tolerance2`.
template <class T, int K>
Vec<T, K> newton_step(const Mat<T, K, K>& g, const Mat<T, K, 1>& residual, double tolerance2, MaskOf<T>& done) {
  Mat<T, K, 1> step = residual;
  const MaskOf<T> regular = solve_in_place(g, step);
  // Away from an extremum (or far from the solution) a plain gradient step, of length at most 1, leads back into the region of Newton's method.
  const T newton2 = norm2(step);
  const MaskOf<T> trust = regular & (newton2 < T(1.0));
  const T shorten = T(1.0) / sqrt(max(T(1.0), norm2(residual)));
  Vec<T, K> w;
  for (int c = 0; c < K; ++c) w[c] = select(done, T(0.0), select(trust, step(c, 0), shorten * residual(c, 0)));
  done = done | (regular & (newton2 < T(tolerance2)));
  return w;
}

/// From the right-hand sides d_v F0 and d_v F_a (in `variation`) to the first variations w_i, k_{a,i}, in place, and to the maps A_i.
template <class T, int K, std::size_t B, int L>
void solve_variations(const Mat<T, K, K>& inverse, const std::array<Mat<T, K, K>, B - 1>& u, std::vector<std::array<Mat<T, K, K>, B>>& variation,
                      std::vector<Mat<T, L, K>>& maps) {
  for (std::size_t i = 0; i < variation.size(); ++i) {
    variation[i][0] = inverse * variation[i][0];
    for (std::size_t a = 0; a + 1 < B; ++a) variation[i][1 + a] = inverse * (variation[i][1 + a] + u[a] * variation[i][0]);
    for (std::size_t b = 0; b < B; ++b)
      for (int r = 0; r < K; ++r)
        for (int c = 0; c < K; ++c) maps[i](static_cast<int>(b) * K + r, c) = variation[i][b](r, c);
  }
}

/// Adds H_ij = w_i^T (1/2 S w_j + B_j) + (1/2 S w_i + B_i)^T w_j + sum_a k_{a,i}^T C_{a,j} + C_{a,i}^T k_{a,j}, C_{a,i} = N_a w_i + P_{a,i}, for i <= j.
/// \param s, n        S and N_a
/// \param b, p        B_i and P_{a,i}; working space afterwards
template <class T, int K, std::size_t B>
void add_products(const Mat<T, K, K>& s, const std::array<Mat<T, K, K>, B - 1>& n, const std::vector<std::array<Mat<T, K, K>, B>>& variation,
                  std::vector<Mat<T, K, K>>& b, std::vector<std::array<Mat<T, K, K>, B - 1>>& p, Mat<T, K, K>* blocks) {
  const std::size_t count = variation.size();
  for (std::size_t i = 0; i < count; ++i) {
    b[i] += T(0.5) * (s * variation[i][0]);
    for (std::size_t a = 0; a + 1 < B; ++a) p[i][a] += n[a] * variation[i][0];
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i; j < count; ++j) {
      Mat<T, K, K>& h = blocks[i * count + j];
      h += transpose_times(variation[i][0], b[j]) + transpose_times(b[i], variation[j][0]);
      for (std::size_t a = 0; a + 1 < B; ++a) h += transpose_times(variation[i][1 + a], p[j][a]) + transpose_times(p[i][a], variation[j][1 + a]);
    }
}

}  // namespace karcher::implicit_mean
