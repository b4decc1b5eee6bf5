#pragma once
/// \file
/// An immersed Klein bottle.

#include "karcher/math/tensor.hpp"

namespace karcher {

/// Point of the bottle of height 1 at u, v (both 2 pi periodic up to the flip (u + 2 pi, v) ~ (u, -v)).
Vec3<double> klein_bottle(double u, double v);

}  // namespace karcher
