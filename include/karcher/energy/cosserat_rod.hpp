#pragma once
/// \file
/// The special Cosserat rod (Antman, "Nonlinear problems of elasticity", chapter VIII; Simo, CMAME 49, 1985; Sander, IJNME 82, 2010):
///   v = R^T m',  u = axl(R^T R'),  W = 1/2 sum_i A_i (v_i - v0_i)^2 + 1/2 sum_i K_i (u_i - u0_i)^2
/// per reference length, the prime the derivative by it; the third director is along the rod. Without stress, v = v0 and u = u0.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "karcher/energy/body_strains.hpp"
#include "karcher/energy/energy_info.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

template <class P>
struct CosseratRod {
  std::array<P, 3> A;  ///< against shear along d_1 and d_2, and stretch [force]
  std::array<P, 3> K;  ///< against bending about d_1 and d_2, and twist [force length^2]
  std::array<P, 3> v0, u0;
  static CosseratRod of(std::span<const P> p) { return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}, {p[9], p[10], p[11]}}; }

  template <class W, class S>
  void add_energy(W& w, const BodyStrains<1, S>& e) const {
    for (std::size_t i = 0; i < 3; ++i) {
      add_square(w, e.v[0].e[i] - constant<S>(v0[i]), 0.5 * A[i]);
      add_square(w, e.u[0].e[i] - constant<S>(u0[i]), 0.5 * K[i]);
    }
  }
  template <class M, class Q>
  auto operator()(const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    std::decay_t<decltype(e.v[0][0])> w(0.0);
    add_energy(w, e);
    return w;
  }

  /// shear, stretch, bending, twist
  template <class M, class Q>
  auto parts(const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    using S = std::decay_t<decltype(e.v[0][0])>;
    std::array<S, 4> w{S(0.0), S(0.0), S(0.0), S(0.0)};
    for (std::size_t i = 0; i < 3; ++i) {
      add_square(w[i / 2], e.v[0].e[i] - constant<S>(v0[i]), 0.5 * A[i]);
      add_square(w[2 + i / 2], e.u[0].e[i] - constant<S>(u0[i]), 0.5 * K[i]);
    }
    return w;
  }

  static std::vector<QuantityInfo> quantity_infos() {
    return {{"strain", "1", 3, "strains v - v0 in the directors: two of shear, stretch"},
            {"curvature", "1/length", 3, "strains u - u0 in the directors: two of bending, twist"}};
  }
  template <class S, class M, class Q>
  auto quantities(const S&, const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    std::array<std::decay_t<decltype(e.v[0][0])>, 6> all;
    for (std::size_t i = 0; i < 3; ++i) {
      all[i] = e.v[0].e[i] - v0[i];
      all[3 + i] = e.u[0].e[i] - u0[i];
    }
    return all;
  }
};

}  // namespace karcher
