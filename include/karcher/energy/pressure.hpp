#pragma once
/// \file
/// The potential of a pressure p that follows the motion: the traction -p n on the current surface, n its unit normal.
///
/// It is p V with the volume V = sum_i s_i int (m_i - o_i) (m_1 x m_2)_i, s_1 + s_2 + s_3 = 1, where m_1 x m_2 points as n does. Of a closed surface every choice of shares s and
/// origin o gives the volume that it encloses; the third of each, 1/3 int m . (m_1 x m_2), is its usual formula. Of an open surface they differ by integrals along its rim, and
/// problem/enclosure.hpp finds those whose derivative is the pressure alone.
/// In the plane V = int s_1 (m_1 - o_1) m_2' - s_2 (m_2 - o_2) m_1' is an area, per thickness.

#include <array>
#include <cstddef>
#include <span>

#include "karcher/math/tensor.hpp"

namespace karcher {

/// On surfaces of a deformation with values in R^3.
template <class P>
struct Pressure {
  P value;
  Vec3<P> share, origin;
  static Pressure of(std::span<const P> p) { return {p[0], {{p[1], p[2], p[3]}}, {{p[4], p[5], p[6]}}}; }

  template <class S, class M>
  auto operator()(const S& s, const M& m) const {
    const auto area = cross(m.d[0], m.d[1]);
    const P side = value * dot(s.normal, cross(s.tangent[0], s.tangent[1]));
    auto w = (m.value[0] - origin[0]) * area[0] * (side * share[0]);
    for (int i = 1; i < 3; ++i) w += (m.value[i] - origin[i]) * area[i] * (side * share[i]);
    return w;
  }
};

/// On the boundary of a plane body with values in R^2.
template <class P>
struct PlanePressure {
  P value;
  std::array<P, 2> share, origin;
  static PlanePressure of(std::span<const P> p) { return {p[0], {p[1], p[2]}, {p[3], p[4]}}; }

  template <class S, class M>
  auto operator()(const S& s, const M& m) const {
    const P side = value * (s.tangent[0][1] * s.normal[0] - s.tangent[0][0] * s.normal[1]);
    return (m.value[0] - origin[0]) * m.d[0][1] * (side * share[0]) - (m.value[1] - origin[1]) * m.d[0][0] * (side * share[1]);
  }
};

}  // namespace karcher
