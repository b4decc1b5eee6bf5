#pragma once
/// \file
/// The Reissner-Mindlin shell with one director d in S^2 and Green's strains (Simo, Fox, "On a stress resultant geometrically exact shell model", CMAME 72, 1989; Mueller,
/// Bischoff, "A consistent finite element formulation of the geometrically non-linear Reissner-Mindlin shell model", Arch. Comput. Methods Eng. 29, 2022):
///   eps_ab = (m_a . m_b - m0_a . m0_b)/2,  kappa_ab = sym(m_a . d_b) - sym(m0_a . d0_b),  gamma_a = m_a . d - m0_a . d0
///   W = h/2 eps : C : eps + h^3/24 kappa : C : kappa + k_s mu h/2 |gamma|^2,  e : C : e = 2 lambda mu/(lambda + 2 mu) (tr e)^2 + 2 mu |e|^2
/// in orthonormal directions of the reference surface, whose metric is then the identity. W is per area of the reference surface. A prestretch e_a makes the stress-free
/// surface longer along the direction a than the reference: derivatives by its lengths are d_a/e_a, its area is e_1 e_2 times as large, its normals are the same.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "karcher/energy/director_strains.hpp"
#include "karcher/energy/energy_info.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

template <class P>
struct ReissnerMindlin {
  P thickness, mu, lambda, shear_correction;
  std::array<P, 2> prestretch;  ///< e_1, e_2
  std::array<P, 4> bending0;    ///< m0_a . d0_b without prestretch: 11, 22, 12, 21
  std::array<P, 2> shear0;      ///< m0_a . d0, the same
  /// Of selective integration (assembly/selective_integration.hpp), with alpha = min(1, h^2/diameter2).
  P diameter2 = P(1.0), membrane_constant = P(1.0), membrane_slope = P(0.0), shear_constant = P(1.0), shear_slope = P(0.0), rest = P(1.0);
  static ReissnerMindlin of(std::span<const P> p) {
    return {p[0], p[1], p[2], p[3], {p[4], p[5]}, {p[6], p[7], p[8], p[9]}, {p[10], p[11]}, p[12], p[13], p[14], p[15], p[16], p[17]};
  }

  template <class S>
  struct Strains {
    std::array<S, 3> membrane, bending;  ///< 11, 22, 12
    std::array<S, 2> shear;
  };
  template <class S>
  Strains<S> strains(const DirectorStrains<S>& e) const {
    const P r0 = 1.0 / prestretch[0], r1 = 1.0 / prestretch[1];
    const std::array<P, 3> r{r0 * r0, r1 * r1, r0 * r1};
    const std::array<P, 3> free{r0 * bending0[0], r1 * bending0[1], 0.5 * (r1 * bending0[2] + r0 * bending0[3])};
    Strains<S> s;
    for (std::size_t i = 0; i < 3; ++i) {
      s.membrane[i] = scaled(e.metric[i], 0.5 * r[i]);
      if (i < 2) s.membrane[i] -= constant<S>(P(0.5));
      s.bending[i] = scaled(e.bending[i], r[i]) - constant<S>(free[i]);
    }
    s.shear = {scaled(e.shear[0], r0) - constant<S>(shear0[0]), scaled(e.shear[1], r1) - constant<S>(shear0[1])};
    return s;
  }

  template <class W, class S>
  void add_parts(const DirectorStrains<S>& e, W& membrane, W& bending, W& shear) const {
    const P h = thickness * (prestretch[0] * prestretch[1]), plane = 2.0 * lambda * mu / (lambda + 2.0 * mu);
    const Strains<S> s = strains(e);
    const auto add = [&](W& to, const std::array<S, 3>& strain, const P& weight) {  // weight strain : C : strain
      add_square(to, strain[0] + strain[1], weight * plane);
      add_square(to, strain[0], 2.0 * weight * mu);
      add_square(to, strain[1], 2.0 * weight * mu);
      add_square(to, strain[2], 4.0 * weight * mu);
    };
    const P alpha = min(P(1.0), thickness * thickness / diameter2);
    add(membrane, s.membrane, 0.5 * h * (membrane_constant + membrane_slope * alpha));
    add(bending, s.bending, rest * h * thickness * thickness * (1.0 / 24));
    const P shear_weight = 0.5 * h * shear_correction * mu * (shear_constant + shear_slope * alpha);
    for (const S& gamma : s.shear) add_square(shear, gamma, shear_weight);
  }
  template <class W, class S>
  void add_energy(W& w, const DirectorStrains<S>& e) const {
    add_parts(e, w, w, w);
  }
  template <class M, class D>
  auto operator()(const M& m, const D& d) const {
    const auto e = director_strains(m.d, d);
    std::decay_t<decltype(e.shear[0])> w(0.0);
    add_energy(w, e);
    return w;
  }
  /// membrane, bending, shear
  template <class M, class D>
  auto parts(const M& m, const D& d) const {
    const auto e = director_strains(m.d, d);
    using S = std::decay_t<decltype(e.shear[0])>;
    std::array<S, 3> w{S(0.0), S(0.0), S(0.0)};
    add_parts(e, w[0], w[1], w[2]);
    return w;
  }

  static std::vector<QuantityInfo> quantity_infos() { return {{"strain", "1", 1, "size of the strains, |eps| + h/2 |kappa| + |gamma|", 0.2}}; }
  template <class S, class M, class D>
  auto quantities(const S&, const M& m, const D& d) const {
    const Strains<P> s = strains(director_strains(m.d, d));
    const auto size = [](const std::array<P, 3>& e) { return sqrt(e[0] * e[0] + e[1] * e[1] + 2.0 * e[2] * e[2]); };
    return std::array<P, 1>{size(s.membrane) + 0.5 * thickness * size(s.bending) + sqrt(s.shear[0] * s.shear[0] + s.shear[1] * s.shear[1])};
  }
};

}  // namespace karcher
