#pragma once
/// \file
/// Chiral magnet films (Melcher, "Chiral skyrmions in the plane", Proc. R. Soc. A 2014):
///   W = 1/2 |grad u|^2 + kappa u . curl u + (h/2) |u - e_3|^2,   curl u = (d_2 u_3, -d_1 u_3, d_1 u_2 - d_2 u_1),
/// u: plane domain -> S^2, lengths in units of the exchange length.

#include <array>
#include <span>

#include "karcher/energy/parameter.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class P>
struct ChiralSkyrmion {
  P kappa, h;

  /// exchange, chiral, Zeeman
  template <class Jet>
  auto parts(const Jet& u) const {
    const auto& n = u.value;
    const auto &d1 = u.d[0], &d2 = u.d[1];
    const auto exchange = 0.5 * (dot(d1, d1) + dot(d2, d2));
    const auto chiral = (n[0] * d2[2] - n[1] * d1[2] + n[2] * (d1[1] - d2[0])) * kappa;
    const auto off = n[2] - 1.0;
    const auto zeeman = 0.5 * (n[0] * n[0] + n[1] * n[1] + off * off) * h;
    return std::array{exchange, chiral, zeeman};
  }
};

struct ChiralSkyrmionModel {
  static EnergyInfo info();
  template <class P>
  ChiralSkyrmion<P> at(std::span<const P> p) const {
    return {p[0], p[1]};
  }
  std::vector<std::string> part_names() const { return {"exchange", "chiral", "zeeman"}; }
};

}  // namespace karcher
