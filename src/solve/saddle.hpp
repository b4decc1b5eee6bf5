#pragma once

#include <optional>

#include "solve/system.hpp"

namespace karcher {

/// From a saddle, where the system is linearised, down the lowest eigenvector of the Hessian: the best of a few points along it, evaluated; nothing if none has
/// less energy.
std::optional<Iterate> escape_saddle(System& system, const Iterate& saddle);

}  // namespace karcher
