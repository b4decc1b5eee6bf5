#pragma once
/// \file
/// What shells with EnergyInfo::prestretch have in common.

#include "karcher/energy/parameter.hpp"

namespace karcher::catalogue {

/// prestretch[0], prestretch[1]
inline Parameter prestretch_parameter() {
  return {.name = "prestretch",
          .unit = "1",
          .description = "length of the stress-free shell by length of the reference, along t1 (the x axis seen from above) and t2; may grow with t",
          .default_value = 1.0,
          .minimum = 0,
          .minimum_allowed = false,
          .size = 2};
}

}  // namespace karcher::catalogue
