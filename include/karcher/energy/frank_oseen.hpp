#pragma once
/// \file
/// Nematic liquid crystals (Oseen 1933, Frank 1958): W = 1/2 [ K1 (div n)^2 + K2 (n . curl n)^2 + K3 |n x curl n|^2 - chi (n . H)^2 ],
/// n: domain of R^3, or a surface in it -> S^2; chi is the anisotropy of the susceptibility in the magnetic field H (Freedericksz 1933).

#include <array>
#include <span>

#include "karcher/energy/surface_derivatives.hpp"

namespace karcher {

template <class P>
struct FrankOseen {
  P K1, K2, K3, chi;
  Vec<P, 3> H;

  static FrankOseen of(std::span<const P> p) { return {p[0], p[1], p[2], p[3], {{p[4], p[5], p[6]}}}; }

  /// splay, twist, bend, magnetic
  template <class R, class Jet>
  auto parts(const R& r, const Jet& u) const {
    const auto splay = divergence(r, u);
    const auto curl_n = curl(r, u);
    using S = std::decay_t<decltype(splay)>;
    const S twist = dot(u.value, curl_n), along = field_along(u);
    const Vec<S, 3> bend = cross(u.value, curl_n);
    return std::array<S, 4>{0.5 * splay * splay * K1, 0.5 * twist * twist * K2, 0.5 * dot(bend, bend) * K3, -0.5 * along * along * chi};
  }
  /// Their sum by |n x curl n|^2 = |curl n|^2 - (n . curl n)^2 for unit n: with derivatives, half the work.
  template <class R, class Jet>
  auto operator()(const R& r, const Jet& u) const {
    const auto splay = divergence(r, u);
    const auto curl_n = curl(r, u);
    using S = std::decay_t<decltype(splay)>;
    S w(0.0);
    add_square(w, splay, 0.5 * K1);
    add_square(w, dot(u.value, curl_n), 0.5 * (K2 - K3));
    for (int i = 0; i < 3; ++i) add_square(w, curl_n[i], 0.5 * K3);
    add_square(w, field_along(u), -0.5 * chi);
    return w;
  }

 private:
  template <class Jet>
  auto field_along(const Jet& u) const {
    return u.value[0] * H[0] + u.value[1] * H[1] + u.value[2] * H[2];
  }
};

}  // namespace karcher
