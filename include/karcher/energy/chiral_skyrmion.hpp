#pragma once
/// \file
/// Chiral magnet films (Melcher, "Chiral skyrmions in the plane", Proc. R. Soc. A 2014):
///   W = 1/2 |grad u|^2 + kappa u . curl u + (h/2) |u - e_3|^2,   curl u = sum_a t_a x d_a u,
/// u: surface -> S^2, in the plane z = 0 with curl u = (d_2 u_3, -d_1 u_3, d_1 u_2 - d_2 u_1); lengths in units of the exchange length.

#include <array>
#include <numbers>
#include <span>
#include <vector>

#include "karcher/energy/energy_info.hpp"
#include "karcher/energy/surface_derivatives.hpp"

namespace karcher {

template <class P>
struct ChiralSkyrmion {
  P kappa, h;
  static ChiralSkyrmion of(std::span<const P> p) { return {p[0], p[1]}; }

  /// exchange, chiral, Zeeman
  template <class S, class Jet>
  auto parts(const S& s, const Jet& u) const {
    const auto& n = u.value;
    const auto exchange = 0.5 * (dot(u.d[0], u.d[0]) + dot(u.d[1], u.d[1]));
    const auto chiral = dot(n, curl(s, u)) * kappa;
    const auto off = n[2] - 1.0;
    const auto zeeman = 0.5 * (n[0] * n[0] + n[1] * n[1] + off * off) * h;
    return std::array{exchange, chiral, zeeman};
  }

  static std::vector<QuantityInfo> quantity_infos() { return {{"charge", "1/area", 1, "topological charge density"}}; }
  /// Topological charge per area, u . (d_1 u x d_2 u) / 4 pi with the orientation of the normal: its integral counts how often u covers the sphere.
  template <class S, class Jet>
  auto quantities(const S& s, const Jet& u) const {
    return std::array{dot(u.value, cross(u.d[0], u.d[1])) * dot(cross(s.tangent[0], s.tangent[1]), s.normal) * (0.25 * std::numbers::inv_pi)};
  }
};

}  // namespace karcher
