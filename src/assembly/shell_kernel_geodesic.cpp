#include "assembly/shell_geodesic.hpp"
#include "assembly/shell_kernel_impl.hpp"
#include "assembly/shell_kernel_table.hpp"

namespace karcher::shell {

Kernel geodesic_kernel(Want want) {
  switch (want) {
    case Want::energy:
      return evaluate_batch<NativeScalar, GeodesicRule, Want::energy>;
    case Want::gradient:
      return evaluate_batch<NativeScalar, GeodesicRule, Want::gradient>;
    case Want::hessian:
      break;
  }
  return evaluate_batch<NativeScalar, GeodesicRule, Want::hessian>;
}

}  // namespace karcher::shell
