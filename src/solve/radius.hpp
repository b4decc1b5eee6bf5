#pragma once
/// \file
/// The radius of the trust region after a trial step of length |s| within `radius`.

#include <algorithm>
#include <cmath>

#include "solve/tuning.hpp"

namespace karcher {

/// ratio: of the fall of the energy to the model's decrease; quadratic: the model is exact and has a minimum, which the radius keeps away.
inline double radius_after_accepted(double radius, double length, double ratio, bool quadratic, const SolverTuning& tuning) {
  if (ratio < tuning.poor_ratio) return tuning.poor_fall * length;
  const bool held_back = ratio > tuning.good_ratio && length > tuning.long_step * radius;
  if (held_back && quadratic) return tuning.exact_growth * radius;
  return std::min(held_back ? tuning.growth * radius : radius, tuning.longest_radius * length);
}

/// slope: g.s, energy_change: E(trial) - E(current), infinite or NaN where the energy is not defined.
inline double radius_after_rejected(double length, double slope, double energy_change, const SolverTuning& tuning) {
  const double rise = energy_change - slope;  // of the parabola above its tangent
  const double least = std::isfinite(rise) && rise > 0 ? -0.5 * slope / rise : tuning.undefined_fall;
  return std::clamp(least, tuning.least_fall, tuning.most_fall) * length;
}

}  // namespace karcher
