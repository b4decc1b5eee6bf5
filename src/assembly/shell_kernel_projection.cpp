#include "assembly/shell_kernel_impl.hpp"
#include "assembly/shell_kernel_table.hpp"
#include "assembly/shell_projection.hpp"

namespace karcher::shell {

Kernel projection_kernel(Want want, int m_nodes, int r_nodes) {
  const bool quadratic_triangle = m_nodes == 6 && r_nodes == 6;
  switch (want) {
    case Want::energy:
      return evaluate_batch<NativeScalar, ProjectionRule, Want::energy, 0, 0>;
    case Want::gradient:
      return evaluate_batch<NativeScalar, ProjectionRule, Want::gradient, 0, 0>;
    case Want::hessian:
      break;
  }
  return quadratic_triangle ? evaluate_batch<NativeScalar, ProjectionRule, Want::hessian, 6, 6>
                            : evaluate_batch<NativeScalar, ProjectionRule, Want::hessian, 0, 0>;
}

}  // namespace karcher::shell
