#pragma once

#include <limits>
#include <optional>

#include "solve/system.hpp"

namespace karcher {

/// Where a moved boundary takes the inside.
struct Prediction {
  Iterate x;                                                ///< evaluated; it may have failed
  double radius = std::numeric_limits<double>::infinity();  ///< no longer steps than this are called for
};

/// Moves the fixed components of u to those of `boundary` and everything else with them by the linear problem, so that a prescribed displacement is not first
/// absorbed by one row of cells. Nothing if the boundary does not move; then u gets its values.
/// \param tolerance  of |g|_*, at which corrections end
std::optional<Prediction> predict(System& system, Configuration& u, const Configuration& boundary, double tolerance);

}  // namespace karcher
