#include "assembly/shell_kernel_impl.hpp"
#include "assembly/shell_kernel_table.hpp"
#include "assembly/shell_projection.hpp"

namespace karcher::shell {

Kernel projection_kernel(Want want) {
  switch (want) {
    case Want::energy:
      return evaluate_batch<NativeScalar, ProjectionRule, Want::energy>;
    case Want::gradient:
      return evaluate_batch<NativeScalar, ProjectionRule, Want::gradient>;
    case Want::hessian:
      break;
  }
  return evaluate_batch<NativeScalar, ProjectionRule, Want::hessian>;
}

}  // namespace karcher::shell
