#pragma once
/// \file
/// The compiled shell kernels of the two interpolation rules.

#include "karcher/assembly/shell_kernel.hpp"

namespace karcher::shell {

Kernel projection_kernel(Want want, int m_nodes, int r_nodes);
Kernel geodesic_kernel(Want want, int m_nodes, int r_nodes);

}  // namespace karcher::shell
