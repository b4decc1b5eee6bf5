#pragma once
/// \file
/// The Reissner-Mindlin shell with one director d in S^2 and Green's strains (Simo, Fox, "On a stress resultant geometrically exact shell model", CMAME 72, 1989; Mueller,
/// Bischoff, "A consistent finite element formulation of the geometrically non-linear Reissner-Mindlin shell model", Arch. Comput. Methods Eng. 29, 2022):
///   eps_ab = (m_a . m_b - m0_a . m0_b)/2,  kappa_ab = sym(m_a . d_b) - sym(m0_a . d0_b),  gamma_a = m_a . d - m0_a . d0
///   W = h/2 eps : C : eps + h^3/24 kappa : C : kappa + k_s mu h/2 |gamma|^2,  e : C : e = 2 lambda mu/(lambda + 2 mu) (tr e)^2 + 2 mu |e|^2
/// in orthonormal directions of the reference surface, whose metric is then the identity. W is per area of the reference surface.

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
  std::array<P, 3> bending0;  ///< m0_1 . d0_1, m0_2 . d0_2, (m0_1 . d0_2 + m0_2 . d0_1)/2
  std::array<P, 2> shear0;    ///< m0_a . d0
  static ReissnerMindlin of(std::span<const P> p) { return {p[0], p[1], p[2], p[3], {p[4], p[5], p[6]}, {p[7], p[8]}}; }

  template <class W, class S>
  void add_parts(const DirectorStrains<S>& e, W& membrane, W& bending, W& shear) const {
    const P h = thickness, plane = 2.0 * lambda * mu / (lambda + 2.0 * mu);
    const auto add = [&](W& to, const std::array<S, 3>& strain, const P& weight) {  // weight strain : C : strain
      add_square(to, strain[0] + strain[1], weight * plane);
      add_square(to, strain[0], 2.0 * weight * mu);
      add_square(to, strain[1], 2.0 * weight * mu);
      add_square(to, strain[2], 4.0 * weight * mu);
    };
    add(membrane, {0.5 * (e.metric[0] - 1.0), 0.5 * (e.metric[1] - 1.0), 0.5 * e.metric[2]}, 0.5 * h);
    add(bending, {e.bending[0] - constant<S>(bending0[0]), e.bending[1] - constant<S>(bending0[1]), e.bending[2] - constant<S>(bending0[2])},
        h * h * h * (1.0 / 24));
    for (std::size_t a = 0; a < 2; ++a) add_square(shear, e.shear[a] - constant<S>(shear0[a]), 0.5 * h * shear_correction * mu);
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
    const DirectorStrains<P> e = director_strains(m.d, d);
    const auto size = [](const P& first, const P& second, const P& mixed) { return sqrt(first * first + second * second + 2.0 * mixed * mixed); };
    const P membrane = size(0.5 * (e.metric[0] - 1.0), 0.5 * (e.metric[1] - 1.0), 0.5 * e.metric[2]);
    const P bending = size(e.bending[0] - bending0[0], e.bending[1] - bending0[1], e.bending[2] - bending0[2]);
    return std::array<P, 1>{membrane + 0.5 * thickness * bending + size(e.shear[0] - shear0[0], e.shear[1] - shear0[1], P(0.0))};
  }
};

}  // namespace karcher
