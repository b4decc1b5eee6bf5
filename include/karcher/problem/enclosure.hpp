#pragma once
/// \file
/// Where a pressure has a potential: the rule of the rim.
///
/// With w_i = (m_i - o_i) dm_j ^ dm_k for i, j, k cyclic, dw_i is the form of volume, so V = sum_i s_i int w_i with shares s_1 + s_2 + s_3 = 1 varies by
///   dV = int dm . (m_1 x m_2) + sum_i s_i oint (m_i - o_i) (dm_j m_k' - dm_k m_j').
/// The first is the work of a pressure, the second must vanish. On a piece of the rim the axis i can be used where j and k are held, or one of them is held and the same all
/// along the piece (its derivative vanishes, too), or i is held at o_i. The axes that can be used on the whole rim share alike. A closed surface has no rim. So a dome may be clamped
/// or cut by planes of symmetry. In the plane the rim is the ends of a curve, where j held or i held at o_i is enough.

#include <string>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Parameters of the density Pressure (PlanePressure).
struct Enclosure {
  /// origin: where the rule leaves it open, the centre of the rim, or of a closed surface, so that V is the volume between them and does not depend on where the body lies.
  Vec3<double> share, origin;
  std::string warning;  ///< a sentence where there is no potential and the choice `force` takes one; else empty
};

/// Of a term with EnergyInfo::enclosure. \throws InputError where there is no potential: the surface has one side only, or its rim can move
Enclosure enclosure(const Problem& problem, const TermSpec& term, const Discretisation& d);

}  // namespace karcher
