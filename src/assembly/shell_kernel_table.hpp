#pragma once
/// \file
/// The compiled shell kernels of the two interpolation rules.

#include "karcher/assembly/shell_kernel.hpp"

namespace karcher::shell {

Kernel projection_kernel(Want want);
Kernel geodesic_kernel(Want want);

}  // namespace karcher::shell
