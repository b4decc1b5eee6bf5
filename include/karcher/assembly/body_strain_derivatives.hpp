#pragma once
/// \file
/// Value, gradient and Hessian of a density of body strains (energy/body_strains.hpp) in the local coordinates of deformation and rotation: jets in the strains,
/// composed with the derivatives of the strains in closed form.
///
/// Local coordinates (interpolation.hpp): d_a m itself, and w, k_a of the rotation in the projection chart with the frame q (0, e_i)/2. There the rotation is that of
/// the Gibbs vector w/2, and to second order
///   v_a = R^T d_a m:  v + v x w + 1/2 w x (w x v),      u_a = (k - 1/2 w x k)/(1 + |w|^2/4)
/// (Rodrigues 1840). With f = dW/dv, g = dW/du the curvature of the strains adds to the Hessian
///   (w, w): (f v^T + v f^T)/2 - (f . v) I - (g . k)/2 I,      (d_a m, w): -R [f]x,      (k, w): -1/2 [g]x,   [f]x x = f x x.

#include <array>

#include "karcher/energy/body_strains.hpp"
#include "karcher/interpolation/interpolation.hpp"
#include "karcher/math/combination.hpp"
#include "karcher/math/jet.hpp"

namespace karcher {

/// A density of the body strains in D directions.
template <class Density, int D, class T>
concept OfBodyStrains = requires(const Density& w, Jet<T, 6 * D>& sum, const BodyStrains<D, Combination<T, 6 * D>>& e) {
  w.add_energy(sum, e);
};

/// S: Dual<T, L> or Jet<T, L> in the L = 6 (1 + D) local coordinates: m, d_1 m, ..., d_D m, w, k_1, ..., k_D.
/// \param m  derivatives of the deformation  \param q  the rotation  \param u  its body rates k_a
template <class S, int D, class T, class Density>
S of_body_strains(const Density& density, const std::array<Vec3<T>, static_cast<std::size_t>(D)>& m, const Quaternion<T>& q,
                  const std::array<Vec3<T>, static_cast<std::size_t>(D)>& u) {
  constexpr bool with_hessian = requires(S s) { s.h; };
  constexpr int N = 6 * D, L = 6 * (1 + D), w = 3 * (1 + D);
  using E = std::conditional_t<with_hessian, Jet<T, N>, Dual<T, N>>;
  const Mat3<T> rotation = rotation_matrix(q);
  using Variable = Combination<T, N>;
  BodyStrains<D, Variable> e;
  std::array<Vec3<T>, D> v;
  for (std::size_t a = 0; a < D; ++a) {
    v[a] = transpose_times(rotation, m[a]);
    for (int i = 0; i < 3; ++i) {
      e.v[a][i] = Variable::variable(v[a][i], static_cast<int>(a) * 6 + i);
      e.u[a][i] = Variable::variable(u[a][i], static_cast<int>(a) * 6 + 3 + i);
    }
  }
  E energy(0.0);
  density.add_energy(energy, e);
  const auto slope = [&](std::size_t a, int part) {
    Vec3<T> f;
    for (int i = 0; i < 3; ++i) f[i] = chart_detail::slope(energy, static_cast<int>(a) * 6 + part * 3 + i);
    return f;
  };

  S result;
  result.v = energy.v;
  const auto set = [&](int at, const Vec3<T>& g) {
    for (int i = 0; i < 3; ++i) chart_detail::slope(result, at + i) = g[i];
  };
  Vec3<T> turning;
  for (std::size_t a = 0; a < D; ++a) {
    const Vec3<T> f = slope(a, 0), g = slope(a, 1);
    set(3 * (1 + static_cast<int>(a)), rotation * f);
    set(w + 3 * (1 + static_cast<int>(a)), g);
    turning += cross(f, v[a]) + T(0.5) * cross(g, u[a]);
  }
  set(w, turning);

  if constexpr (with_hessian) {
    const auto put = [&](int i, int j, const T& x) { result.h[S::index(i, j)] = x; };
    std::array<Mat3<T>, D> turn_v, turn_u;  // derivatives of v_a and u_a by w
    for (std::size_t a = 0; a < D; ++a) {
      turn_v[a] = hat(v[a]);
      turn_u[a] = T(0.5) * hat(u[a]);
    }
    const auto block = [&](std::size_t a, int part, std::size_t b, int other) {
      Mat3<T> c;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c(i, j) = energy.hessian(static_cast<int>(a) * 6 + part * 3 + i, static_cast<int>(b) * 6 + other * 3 + j);
      return c;
    };
    Mat3<T> ww;
    for (std::size_t a = 0; a < D; ++a) {
      const int ma = 3 * (1 + static_cast<int>(a)), ka = w + ma;
      const Vec3<T> f = slope(a, 0), g = slope(a, 1);
      Mat3<T> vw, uw;  // rows of the strains of direction a, columns w
      for (std::size_t b = 0; b < D; ++b) {
        const int mb = 3 * (1 + static_cast<int>(b)), kb = w + mb;
        const Mat3<T> vv = block(a, 0, b, 0), vu = block(a, 0, b, 1), uv = block(a, 1, b, 0), uu = block(a, 1, b, 1);
        vw += vv * turn_v[b] + vu * turn_u[b];
        uw += uv * turn_v[b] + uu * turn_u[b];
        const Mat3<T> mk = rotation * vu;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) put(ma + i, kb + j, mk(i, j));
        if (b < a) continue;
        const Mat3<T> mm = rotation * vv * transpose(rotation);
        for (int i = 0; i < 3; ++i)
          for (int j = a == b ? i : 0; j < 3; ++j) {
            put(ma + i, mb + j, mm(i, j));
            put(ka + i, kb + j, uu(i, j));
          }
      }
      ww += transpose_times(turn_v[a], vw) + transpose_times(turn_u[a], uw);
      ww += outer(f, v[a]) - (dot(f, v[a]) + T(0.5) * dot(g, u[a])) * identity<T, 3>();
      const Mat3<T> mw = rotation * (vw - hat(f));
      uw -= T(0.5) * hat(g);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          put(ma + i, w + j, mw(i, j));
          put(w + j, ka + i, uw(i, j));
        }
    }
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) put(w + i, w + j, T(0.5) * (ww(i, j) + ww(j, i)));
  }
  static_assert(L == 2 * w);
  return result;
}

}  // namespace karcher
