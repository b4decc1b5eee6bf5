#pragma once
/// \file
/// Nematic liquid crystals (Oseen 1933, Frank 1958): W = 1/2 [ K1 (div n)^2 + K2 (n . curl n)^2 + K3 |n x curl n|^2 - chi (n . H)^2 ],
/// n: domain of R^3 -> S^2; chi is the anisotropy of the susceptibility in the magnetic field H (Freedericksz 1933).

#include <array>
#include <span>

#include "karcher/energy/parameter.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class P>
struct FrankOseen {
  P K1, K2, K3, chi;
  Vec<P, 3> H;

  /// splay, twist, bend, magnetic. In a plane domain nothing depends on the third coordinate.
  template <class Jet>
  auto parts(const Jet& u) const {
    using S = std::decay_t<decltype(u.value[0])>;
    const auto d = [&](std::size_t a, int c) { return a < u.d.size() ? u.d[a < u.d.size() ? a : 0][c] : S(0.0); };
    const S divergence = d(0, 0) + d(1, 1) + d(2, 2);
    const Vec<S, 3> curl{{d(1, 2) - d(2, 1), d(2, 0) - d(0, 2), d(0, 1) - d(1, 0)}};
    const S twist = dot(u.value, curl);
    const Vec<S, 3> bend = cross(u.value, curl);
    const S along = u.value[0] * H[0] + u.value[1] * H[1] + u.value[2] * H[2];
    return std::array<S, 4>{0.5 * divergence * divergence * K1, 0.5 * twist * twist * K2, 0.5 * dot(bend, bend) * K3, -0.5 * along * along * chi};
  }
};

struct FrankOseenModel {
  static EnergyInfo info();
  template <class P>
  FrankOseen<P> at(std::span<const P> p) const {
    return {p[0], p[1], p[2], p[3], {{p[4], p[5], p[6]}}};
  }
  std::vector<std::string> part_names() const { return {"splay", "twist", "bend", "magnetic"}; }
};

}  // namespace karcher
