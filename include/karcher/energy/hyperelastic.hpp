#pragma once
/// \file
/// Hyperelastic solids: isotropic densities of the deformation gradient F = grad m, in space and, in the plane, of F with the third axis kept (plane strain).
/// J = det F, V = (F F^T)^(1/2), E = (F^T F - I)/2, kappa = lambda + 2 mu/3. W is infinite where J <= 0.
///
/// All formulas are written in H = F - I, so that their rounding errors are relative to H, and an undeformed body has no energy to the square of rounding:
///   |F|^2 - 3 = 2 tr H + |H|^2,   J - 1 = tr H + tr cof H + det H,   cof F = I + K,   K = (tr H) I - H^T + cof H,   2 E = H + H^T + H^T H.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "karcher/energy/energy_info.hpp"
#include "karcher/math/functions.hpp"
#include "karcher/math/symmetric.hpp"

namespace karcher {

namespace hyperelastic_detail {

template <class W, class S>
W cofactor_entry(const Mat3<S>& h, int i, int j) {
  const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  W c(0.0);
  add_product(c, h(i1, j1), h(i2, j2));
  add_product(c, -h(i1, j2), h(i2, j1));
  return c;
}
/// J - 1
template <class W, class S>
W change_of_volume(const Mat3<S>& h) {
  using P = Base<W>;
  W j(0.0);
  for (int i = 0; i < 3; ++i) {
    add_scaled(j, h(i, i), P(1.0));
    add_product(j, h(0, i), cofactor_entry<W>(h, 0, i));
    j += cofactor_entry<W>(h, i, i);
  }
  return j;
}
/// w += (|F|^2 - 3) factor
template <class W, class S>
void add_stretch(W& w, const Mat3<S>& h, const Base<W>& factor) {
  for (int i = 0; i < 3; ++i) {
    add_scaled(w, h(i, i), 2.0 * factor);
    for (int k = 0; k < 3; ++k) add_square(w, h(i, k), factor);
  }
}
/// 2 E = F^T F - I
template <class W, class S>
Mat3<W> twice_green(const Mat3<S>& h) {
  using P = Base<W>;
  Mat3<W> e;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      W x(0.0);
      add_scaled(x, h(i, j), P(1.0));
      add_scaled(x, h(j, i), P(1.0));
      for (int k = 0; k < 3; ++k) add_product(x, h(k, i), h(k, j));
      e(i, j) = e(j, i) = x;
    }
  return e;
}

}  // namespace hyperelastic_detail

/// What the materials have in common. A Material has add_energy(W& w, const Mat3<S>& h, const W& j): its density at H = h, where j is J - 1 > -1; W is a scalar of any
/// kind, S the same or a Combination (math/combination.hpp).
template <class Material, class P>
struct Hyperelastic {
  /// \param f  F, or its upper left part in the plane
  template <class W, class S, int D>
  void add_energy_of_gradient(W& w, const Mat<S, D, D>& f) const {
    Mat3<S> h = less_identity(f);
    const W j = hyperelastic_detail::change_of_volume<W>(h);
    const auto possible = base(j) > P(-1.0);
    for (S& x : h.e) x = select(possible, x, S(0.0));
    static_cast<const Material&>(*this).add_energy(w, h, select(possible, j, W(0.0)));
    w += constant<W>(select(possible, P(0.0), P(std::numeric_limits<double>::infinity())));
  }

  static std::vector<QuantityInfo> quantity_infos() {
    return {{"cauchy", "force/length^2", 6, "Cauchy stress, xx, yy, zz, xy, yz, xz"},
            {"von_mises", "force/length^2", 1, "von Mises stress"},
            {"stretch", "1", 3, "principal stretches, the largest first"}};
  }
  /// sigma = 1/J dW/dF F^T, its equivalent stress (3/2 |dev sigma|^2)^(1/2), the eigenvalues of V
  template <class M>
  std::array<P, 10> quantities(const M& m) const {
    using S = Dual<P, 9>;
    const Mat3<P> h = less_identity(matrix_of_columns(m.d)), f = identity<P, 3>() + h;
    Mat3<S> variables;
    for (std::size_t i = 0; i < 9; ++i) {
      variables.e[i].v = f.e[i];
      variables.e[i].d[i] = P(1.0);
    }
    S w(0.0);
    add_energy_of_gradient(w, variables);
    const Mat3<P> sigma = (P(1.0) / determinant(f)) * (Mat3<P>{w.d} * transpose(f));
    const P mean = trace(sigma) * P(1.0 / 3);
    const P size2 = norm2(sigma - mean * identity<P, 3>());
    Vec3<P> stretch = eigen(hyperelastic_detail::twice_green<P>(h)).values;
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < 2; ++i) {
        const P larger = max(stretch[i], stretch[i + 1]), smaller = min(stretch[i], stretch[i + 1]);
        stretch[i] = larger;
        stretch[i + 1] = smaller;
      }
    using karcher::sqrt;
    for (P& x : stretch.e) x = sqrt(P(1.0) + x);
    return {sigma(0, 0), sigma(1, 1), sigma(2, 2), sigma(0, 1), sigma(1, 2), sigma(0, 2), sqrt(P(1.5) * size2), stretch[0], stretch[1], stretch[2]};
  }

 private:
  /// H
  template <class S, int D>
  static Mat3<S> less_identity(const Mat<S, D, D>& f) {
    Mat3<S> h;
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) h(i, k) = i == k ? f(i, k) - 1.0 : f(i, k);
    return h;
  }
};

/// mu |E|^2 + lambda/2 (tr E)^2
template <class P>
struct SaintVenantKirchhoff : Hyperelastic<SaintVenantKirchhoff<P>, P> {
  P mu, lambda;
  static SaintVenantKirchhoff of(std::span<const P> p) { return {{}, p[0], p[1]}; }
  template <class W, class S>
  void add_energy(W& w, const Mat3<S>& h, const W&) const {
    const Mat3<W> e = hyperelastic_detail::twice_green<W>(h);
    for (int i = 0; i < 3; ++i)
      for (int k = i; k < 3; ++k) add_square(w, e(i, k), (i == k ? 0.25 : 0.5) * mu);
    add_square(w, trace(e), 0.125 * lambda);
  }
};

/// mu/2 (|F|^2 - 3 - 2 ln J) + lambda/2 (ln J)^2
template <class P>
struct NeoHooke : Hyperelastic<NeoHooke<P>, P> {
  P mu, lambda;
  static NeoHooke of(std::span<const P> p) { return {{}, p[0], p[1]}; }
  template <class W, class S>
  void add_energy(W& w, const Mat3<S>& h, const W& j) const {
    const W log_j = log1p(j);
    hyperelastic_detail::add_stretch(w, h, 0.5 * mu);
    add_scaled(w, log_j, -mu);
    add_square(w, log_j, 0.5 * lambda);
  }
};

/// a |F|^2 + b |cof F|^2 + c J^2 - (2 a + 4 b + 2 c) ln J (Ciarlet 1988, section 4.10), less its value 3 a + 3 b + c at F = I where `normalised` is 1 (else 0)
template <class P>
struct MooneyRivlin : Hyperelastic<MooneyRivlin<P>, P> {
  P a, b, c, normalised;
  static MooneyRivlin of(std::span<const P> p) { return {{}, p[0], p[1], p[2], p[3]}; }
  template <class W, class S>
  void add_energy(W& w, const Mat3<S>& h, const W& j) const {
    hyperelastic_detail::add_stretch(w, h, a);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        W x = hyperelastic_detail::cofactor_entry<W>(h, i, k);  // K
        add_scaled(x, h(k, i), P(-1.0));
        for (int l = 0; i == k && l < 3; ++l) add_scaled(x, h(l, l), P(1.0));
        add_square(w, x, b);
        if (i == k) add_scaled(w, x, 2.0 * b);
      }
    add_scaled(w, j, 2.0 * c);
    add_square(w, j, c);
    add_scaled(w, W(log1p(j)), -(2.0 * a + 4.0 * b + 2.0 * c));
    w += constant<W>((1.0 - normalised) * (3.0 * a + 3.0 * b + c));
  }
};

namespace hyperelastic_detail {
/// |log V|^2, and |dev log V|^2 = |log V|^2 - (ln J)^2/3
template <class W, class S>
W squared_log_stretch(const Mat3<S>& h) {
  return 0.25 * squared_log1p(twice_green<W>(h));
}
}  // namespace hyperelastic_detail

/// mu |dev log V|^2 + kappa/2 (ln J)^2 (Hencky 1929)
template <class P>
struct Hencky : Hyperelastic<Hencky<P>, P> {
  P mu, lambda;
  static Hencky of(std::span<const P> p) { return {{}, p[0], p[1]}; }
  template <class W, class S>
  void add_energy(W& w, const Mat3<S>& h, const W& j) const {
    add_scaled(w, hyperelastic_detail::squared_log_stretch<W>(h), mu);
    add_square(w, W(log1p(j)), 0.5 * lambda);
  }
};

/// mu/k exp(k |dev log V|^2) + kappa/(2 k^) exp(k^ (ln J)^2) (Neff, Ghiba, Lankeit 2015), less its value at F = I where `normalised` is 1 (else 0)
template <class P>
struct ExpHencky : Hyperelastic<ExpHencky<P>, P> {
  P mu, lambda, k, k_hat, normalised;
  static ExpHencky of(std::span<const P> p) { return {{}, p[0], p[1], p[2], p[3], p[4]}; }
  template <class W, class S>
  void add_energy(W& w, const Mat3<S>& h, const W& j) const {
    const W log_j = log1p(j);
    W change = hyperelastic_detail::squared_log_stretch<W>(h), volume(0.0);
    add_square(change, log_j, P(-1.0 / 3));
    add_square(volume, log_j, k_hat);
    const P shear = mu / k, bulk = 0.5 * (lambda + (2.0 / 3) * mu) / k_hat;
    add_scaled(w, W(expm1(scaled(change, k))), shear);
    add_scaled(w, W(expm1(volume)), bulk);
    w += constant<W>((1.0 - normalised) * (shear + bulk));
  }
};

}  // namespace karcher
