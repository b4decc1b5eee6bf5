#pragma once
/// \file
/// Nematic liquid crystals (Oseen 1933, Frank 1958): W = 1/2 [ K1 (div n)^2 + K2 (n . curl n)^2 + K3 |n x curl n|^2 - chi (n . H)^2 ],
/// n: domain of R^3 -> S^2; chi is the anisotropy of the susceptibility in the magnetic field H (Freedericksz 1933).

#include <array>
#include <span>
#include <tuple>
#include <utility>

#include "karcher/energy/parameter.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class P>
struct FrankOseen {
  P K1, K2, K3, chi;
  Vec<P, 3> H;

  /// splay, twist, bend, magnetic
  template <class Jet>
  auto parts(const Jet& u) const {
    const auto [divergence, curl] = divergence_and_curl(u);
    using S = std::decay_t<decltype(divergence)>;
    const S twist = dot(u.value, curl), along = field_along(u);
    const Vec<S, 3> bend = cross(u.value, curl);
    return std::array<S, 4>{0.5 * divergence * divergence * K1, 0.5 * twist * twist * K2, 0.5 * dot(bend, bend) * K3, -0.5 * along * along * chi};
  }
  /// Their sum by |n x curl n|^2 = |curl n|^2 - (n . curl n)^2 for unit n: with derivatives, half the work.
  template <class Jet>
  auto operator()(const Jet& u) const {
    const auto [divergence, curl] = divergence_and_curl(u);
    using S = std::decay_t<decltype(divergence)>;
    S w(0.0);
    add_square(w, divergence, 0.5 * K1);
    add_square(w, dot(u.value, curl), 0.5 * (K2 - K3));
    for (int i = 0; i < 3; ++i) add_square(w, curl[i], 0.5 * K3);
    add_square(w, field_along(u), -0.5 * chi);
    return w;
  }

 private:
  template <class Jet>
  auto field_along(const Jet& u) const {
    return u.value[0] * H[0] + u.value[1] * H[1] + u.value[2] * H[2];
  }
  /// In a plane domain nothing depends on the third coordinate.
  template <class Jet>
  static auto divergence_and_curl(const Jet& u) {
    using S = std::decay_t<decltype(u.value[0])>;
    const auto &d1 = u.d[0], &d2 = u.d[1];
    std::pair<S, Vec<S, 3>> r{d1[0] + d2[1], {{d2[2], -d1[2], d1[1] - d2[0]}}};
    if constexpr (std::tuple_size_v<std::decay_t<decltype(u.d)>> == 3) {
      const auto& d3 = u.d[2];
      r.first += d3[2];
      r.second[0] -= d3[1];
      r.second[1] += d3[0];
    }
    return r;
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
