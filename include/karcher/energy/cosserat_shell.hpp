#pragma once
/// \file
/// The curved six-parameter Cosserat shell with all terms up to h^5.
///
/// Sources: Birsan, Ghiba, Martin, Neff, "Refined dimensional reduction for isotropic elastic Cosserat shells with initial curvature", Math. Mech. Solids 24
/// (2019); Birsan, "Derivation of a refined six-parameter shell model", Math. Mech. Solids 26 (2021); Nebel, Sander, Birsan, Neff, CMAME 416 (2023) 116309.
///
///   E = sum_a Q^T d_a m (x) a^a - a           K = sum_a axl(Q^T d_a Q) (x) a^a         a = sum_a a_a (x) a^a
///   b = - sum_a d_a n_0 (x) a^a               c = sqrt(det a_ab) (a^1 (x) a^2 - a^2 (x) a^1)
///   H = tr b / 2, K_G = det b on the tangent plane
///   W = (h - K_G h^3/12) Wm(E) + (h^3/12 - K_G h^5/80) Wm(E b + c K) + h^3/6 Wmixt(E, c K b - 2 H c K) + h^5/80 Wmp((E b + c K) b)
///     + (h - K_G h^3/12) Wcurv(K) + (h^3/12 - K_G h^5/80) Wcurv(K b) + h^5/80 Wcurv(K b^2)
///   Wmixt(S, T) = mu <sym S, sym T> + mu_c <skew S, skew T> + lambda mu / (lambda + 2 mu) tr S tr T,   Wm(S) = Wmixt(S, S)
///   Wmp(S) = mu |sym S|^2 + mu_c |skew S|^2 + lambda/2 (tr S)^2
///   Wcurv(S) = mu L_c^2 (b1 |dev sym S|^2 + b2 |skew S|^2 + b3 (tr S)^2)
/// With ShellCoupling::birsan_2021 the three forms Wm, Wmixt, Wmp are all replaced by the bilinear form of
///   Wcoss(S) = mu |sym aS|^2 + mu_c |skew aS|^2 + lambda mu / (lambda + 2 mu) (tr aS)^2 + 2 mu mu_c / (mu + mu_c) |n_0^T S|^2.
/// All terms are even in n_0, so every choice of the normal gives the same energy. W is per area of the reference surface.
///
/// Two forms of the same density: `cosserat_shell_density` in 3 x 3 tensors of any scalar, and `ShellForm`, its matrix in the principal frame.

#include <array>
#include <cstddef>
#include <span>

#include "karcher/energy/reference_point.hpp"
#include "karcher/manifold/quaternion.hpp"
#include "karcher/math/scalar.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

enum class ShellCoupling { standard, birsan_2021 };

/// Constants of the shell at a point. T: double, or a scalar that holds several points.
template <class T>
struct ShellMaterial {
  T thickness{};         ///< h > 0 [length]
  T mu{}, lambda{};      ///< Lame parameters [force/length^2], mu > 0, 3 lambda + 2 mu > 0
  T mu_c{};              ///< Cosserat couple modulus >= 0 [force/length^2]
  T internal_length{};   ///< L_c > 0 [length]
  std::array<T, 3> b{};  ///< curvature coefficients [1]
};

/// Parts of the density: "membrane" is the term in Wm(E); "bending" are the terms in E b + c K, with the mixed one; "curvature" are those in Wcurv.
template <class T>
struct ShellEnergy {
  T membrane{}, bending{}, curvature{};
  T total() const { return membrane + bending + curvature; }
};

/// The density in tensors. Scalar S of the strains (double, Jet, ...), scalar T of the geometry and the constants; S * T must be an S.
/// \param e, k  strain tensors E and K, any basis of R^3, the same for all arguments
/// \param b, c  tensors of the reference surface \param n  its unit normal n_0
template <class S, class T>
ShellEnergy<S> cosserat_shell_density(const Mat3<S>& e, const Mat3<S>& k, const Mat3<T>& b, const Mat3<T>& c, const Vec3<T>& n,
                                      const ShellMaterial<T>& material, ShellCoupling coupling) {
  const T h = material.thickness, mu = material.mu, mu_c = material.mu_c, lambda = material.lambda;
  const T mean = T(0.5) * trace(b), gauss = T(2.0) * mean * mean - T(0.5) * trace(b * b), twice_mean = T(2.0) * mean;
  const T plane = lambda * mu / (lambda + T(2.0) * mu);
  const bool refined = coupling == ShellCoupling::birsan_2021;

  const auto times = [](const Mat3<S>& x, const Mat3<T>& y) {  // without turning the constants into S
    Mat3<S> r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) = x(i, 0) * y(0, j) + x(i, 1) * y(1, j) + x(i, 2) * y(2, j);
    return r;
  };
  const auto quadratic = [&](const Mat3<S>& x, const Mat3<S>& y, const T& trace_factor) {
    // mu <sym, sym> + mu_c <skew, skew> = (mu + mu_c)/2 <x, y> + (mu - mu_c)/2 <x, y^T>
    return dot(x, y) * (T(0.5) * (mu + mu_c)) + dot(x, transpose(y)) * (T(0.5) * (mu - mu_c)) + trace(x) * trace(y) * trace_factor;
  };
  const auto mixed = [&](const Mat3<S>& x, const Mat3<S>& y, const T& trace_factor) -> S {
    if (!refined) return quadratic(x, y, trace_factor);
    Mat3<S> ax = x, ay = y;  // a x = x - n (n^T x)
    S normal(0.0);
    for (int j = 0; j < 3; ++j) {
      const S nx = x(0, j) * n[0] + x(1, j) * n[1] + x(2, j) * n[2], ny = y(0, j) * n[0] + y(1, j) * n[1] + y(2, j) * n[2];
      for (int i = 0; i < 3; ++i) {
        ax(i, j) -= nx * n[i];
        ay(i, j) -= ny * n[i];
      }
      normal += nx * ny;
    }
    return quadratic(ax, ay, trace_factor) + normal * (T(2.0) * mu * mu_c / (mu + mu_c));
  };
  const T ml = mu * material.internal_length * material.internal_length;
  const auto curvature = [&](const Mat3<S>& x) {
    const S tr = trace(x);
    return dot(x, x) * (T(0.5) * ml * (material.b[0] + material.b[1])) + dot(x, transpose(x)) * (T(0.5) * ml * (material.b[0] - material.b[1])) +
           tr * tr * (ml * (material.b[2] - material.b[0] * T(1.0 / 3)));
  };

  Mat3<S> ck;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) ck(i, j) = k(0, j) * c(i, 0) + k(1, j) * c(i, 1) + k(2, j) * c(i, 2);
  const Mat3<S> bending = times(e, b) + ck;
  Mat3<S> change = times(ck, b);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) change(i, j) -= ck(i, j) * twice_mean;
  const Mat3<S> kb = times(k, b), bb = times(bending, b);

  const T h3 = h * h * h, h5 = h3 * h * h;
  const T a0 = h - gauss * h3 * T(1.0 / 12), a1 = h3 * T(1.0 / 12) - gauss * h5 * T(1.0 / 80), a2 = h3 * T(1.0 / 6), a3 = h5 * T(1.0 / 80);
  ShellEnergy<S> w;
  w.membrane = mixed(e, e, plane) * a0;
  w.bending = mixed(bending, bending, plane) * a1 + mixed(e, change, plane) * a2 + mixed(bb, bb, refined ? plane : T(0.5) * lambda) * a3;
  w.curvature = curvature(k) * a0 + curvature(kb) * a1 + curvature(times(kb, b)) * a3;
  return w;
}

/// Which parts a ShellForm contains.
struct ShellParts {
  bool membrane = true, bending = true, curvature = true;
};

/// W = 1/2 z^T C z in the orthonormal principal frame (t_1, t_2, n_0) of the reference surface. With E_cb, K_cb (component c, direction b) the matrix C falls
/// into two 4 x 4 blocks and four numbers:
///   a: (E11, E22, K21, K12)      b: (E12, E21, K22, K11)      s: E31, E32, K31, K32
/// Blocks are stored as the upper triangle by rows.
template <class T>
struct ShellForm {
  static constexpr int size = 24;
  std::array<T, 10> a{}, b{};
  std::array<T, 4> s{};

  /// Position of (i, j), i <= j, in a and b.
  static constexpr std::size_t index(int i, int j) { return static_cast<std::size_t>(i * 4 - i * (i - 1) / 2 + j - i); }
};

/// \param k1, k2  principal curvatures, i.e. the eigenvalues of b (negative for a sphere with the outward normal)
template <class T>
ShellForm<T> shell_form(const T& k1, const T& k2, const ShellMaterial<T>& material, ShellCoupling coupling, ShellParts parts = {}) {
  const T h = material.thickness, mu = material.mu, mu_c = material.mu_c, lambda = material.lambda;
  const bool refined = coupling == ShellCoupling::birsan_2021;
  const T gauss = k1 * k2, h3 = h * h * h, h5 = h3 * h * h;
  const T c0 = h - gauss * h3 * T(1.0 / 12), c1 = h3 * T(1.0 / 12) - gauss * h5 * T(1.0 / 80), c3 = h5 * T(1.0 / 80);
  const T membrane = T(parts.membrane ? 1.0 : 0.0), bending = T(parts.bending ? 1.0 : 0.0), curvature = T(parts.curvature ? 1.0 : 0.0);
  const T a0 = membrane * c0, a1 = bending * c1, a2 = bending * h3 * T(1.0 / 6), a3 = bending * c3;

  const T ls = lambda * mu / (lambda + T(2.0) * mu), p = mu + ls;
  const T p5 = refined ? p : mu + T(0.5) * lambda, l5 = refined ? T(2.0) * ls : lambda;  // of the term Wmp
  const T m1 = T(0.5) * (mu + mu_c), m2 = mu - mu_c;
  const T shear = refined ? T(2.0) * mu * mu_c / (mu + mu_c) : m1;
  const T ml = mu * material.internal_length * material.internal_length * curvature;
  const T o1 = ml * (material.b[0] + material.b[1]) * T(0.5), o2 = ml * (material.b[0] - material.b[1]);
  const T d1 = ml * (material.b[0] * T(2.0 / 3) + material.b[2]), d12 = ml * T(2.0) * (material.b[2] - material.b[0] * T(1.0 / 3));
  const T x1 = c0 + c1 * k1 * k1 + c3 * k1 * k1 * k1 * k1, x2 = c0 + c1 * k2 * k2 + c3 * k2 * k2 * k2 * k2,
          x12 = c0 + c1 * gauss + c3 * gauss * gauss;

  ShellForm<T> f;
  // S11 = k1 E11 + K21 and S22 = k2 E22 - K12 are the diagonal of E b + c K; their quadratic form:
  const T s11 = a1 * p + a3 * p5 * k1 * k1, s22 = a1 * p + a3 * p5 * k2 * k2, s12 = T(2.0) * a1 * ls + a3 * l5 * gauss;
  f.a = {T(2.0) * (a0 * p + s11 * k1 * k1),
         T(2.0) * a0 * ls + s12 * gauss,
         T(2.0) * s11 * k1 - a2 * p * k2,
         k1 * (a2 * ls - s12),
         T(2.0) * (a0 * p + s22 * k2 * k2),
         k2 * (s12 - a2 * ls),
         a2 * p * k1 - T(2.0) * s22 * k2,
         T(2.0) * (s11 + o1 * x1),
         o2 * x12 - s12,
         T(2.0) * (s22 + o1 * x2)};
  // S12 = k2 E12 + K22 and S21 = k1 E21 - K11 are its off-diagonal entries.
  const T r12 = m1 * (a1 + a3 * k2 * k2), r21 = m1 * (a1 + a3 * k1 * k1), rx = m2 * (a1 + a3 * gauss);
  f.b = {T(2.0) * (a0 * m1 + r12 * k2 * k2),
         a0 * m2 + rx * gauss,
         T(2.0) * r12 * k2 - a2 * m1 * k1,
         k2 * (T(0.5) * a2 * m2 - rx),
         T(2.0) * (a0 * m1 + r21 * k1 * k1),
         k1 * (rx - T(0.5) * a2 * m2),
         a2 * m1 * k2 - T(2.0) * r21 * k1,
         T(2.0) * (r12 + d1 * x2),
         d12 * x12 - rx,
         T(2.0) * (r21 + d1 * x1)};
  const auto normal = [&](const T& k) { return T(2.0) * shear * (a0 + a1 * k * k + a3 * k * k * k * k); };
  f.s = {normal(k1), normal(k2), T(2.0) * o1 * x1, T(2.0) * o1 * x2};
  return f;
}

/// |E|^2 as a form.
template <class T>
ShellForm<T> strain_square() {
  ShellForm<T> f;
  f.a[f.index(0, 0)] = f.a[f.index(1, 1)] = f.b[f.index(0, 0)] = f.b[f.index(1, 1)] = f.s[0] = f.s[1] = T(2.0);
  return f;
}

/// |h/2 (E b + c K)|^2 as a form: the square of the strains that bending makes at the two faces of the shell, h/2 away from the surface.
template <class T>
ShellForm<T> bending_strain_square(const T& k1, const T& k2, const T& thickness) {
  const T f = T(0.5) * thickness * thickness;  // 2 (h/2)^2
  ShellForm<T> form;
  // S11 = k1 E11 + K21, S22 = k2 E22 - K12; S12 = k2 E12 + K22, S21 = k1 E21 - K11; S31 = k1 E31, S32 = k2 E32
  form.a = {f * k1 * k1, T(0.0), f * k1, T(0.0), f * k2 * k2, T(0.0), -(f * k2), f, T(0.0), f};
  form.b = {f * k2 * k2, T(0.0), f * k2, T(0.0), f * k1 * k1, T(0.0), -(f * k1), f, T(0.0), f};
  form.s = {f * k1 * k1, f * k2 * k2, T(0.0), T(0.0)};
  return form;
}

/// The same density of a deformation and a rotation field (unit quaternions), for the generic kernel: an independent way to what the closed-form kernel computes.
/// Parameters: h, mu, lambda, mu_c, L_c, b1, b2, b3.
template <class P>
struct CosseratShell {
  ShellMaterial<P> material;
  ShellCoupling coupling = ShellCoupling::standard;
  static CosseratShell of(std::span<const P> p) { return {{p[0], p[1], p[2], p[3], p[4], {p[5], p[6], p[7]}}}; }

  /// membrane, bending, curvature
  template <class R, class M, class Q>
  auto parts(const R& r, const M& m, const Q& q) const {
    using S = std::decay_t<decltype(m.value[0])>;
    const Mat3<S> rotation = rotation_matrix(q.value);
    Mat3<S> e, k;
    Mat3<P> b;
    for (std::size_t a = 0; a < 2; ++a) {
      // Q^T d_a m - t_a, and axl(Q^T d_a Q) = 2 vec(conj(q) d_a q)
      const Vec3<S> strain = transpose_times(rotation, m.d[a]);
      const Quaternion<S> rate = quaternion_product(conjugate(q.value), q.d[a]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          add_scaled(e(i, j), strain[i], r.tangent[a][j]);
          e(i, j) -= S(r.tangent[a][i] * r.tangent[a][j]);
          add_scaled(k(i, j), rate[i + 1], P(2.0) * r.tangent[a][j]);
        }
      for (std::size_t c = 0; c < 2; ++c) b += r.b(static_cast<int>(a), static_cast<int>(c)) * outer(r.tangent[a], r.tangent[c]);
    }
    const ShellEnergy<S> w = cosserat_shell_density(e, k, b, -hat(r.normal), r.normal, material, coupling);
    return std::array<S, 3>{w.membrane, w.bending, w.curvature};
  }
};

}  // namespace karcher
