#include "karcher/assembly/shell_kernel.hpp"

#include <cmath>

#include "assembly/shell_kernel_table.hpp"

namespace karcher::shell {
namespace {

/// Unit quaternion of a rotation matrix, by the largest of its four components (Shepperd 1978), so that nothing is divided by a small number.
std::array<double, 4> quaternion(const Mat3<double>& r) {
  const double t = trace(r);
  const std::array<double, 4> square = {1 + t, 1 + 2 * r(0, 0) - t, 1 + 2 * r(1, 1) - t, 1 + 2 * r(2, 2) - t};
  const Vec3<double> axis = ax(r);
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (square[k] > square[largest]) largest = k;
  std::array<double, 4> q{};
  if (largest == 0) {
    q = {square[0], axis[0], axis[1], axis[2]};
  } else {
    const int i = static_cast<int>(largest) - 1;
    q[0] = axis[i];
    for (int k = 0; k < 3; ++k) q[static_cast<std::size_t>(k) + 1] = k == i ? square[largest] : r(i, k) + r(k, i);
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& x : q) x /= length;
  return q;
}

}  // namespace

void store_point(double* point, int lane, const Mat<double, 2, 2>& jacobian, const Mat3<double>& frame, const ShellForm<double>& form,
                 double weight) {
  double* at = point + lane;
  const auto put = [&](double x) {
    *at = x;
    at += native_width;
  };
  for (double x : jacobian.e) put(x);
  for (double x : quaternion(frame)) put(x);
  store_form(point, lane, form, weight);
}

void store_form(double* point, int lane, const ShellForm<double>& form, double weight) {
  double* at = point + 8 * native_width + lane;
  const auto put = [&](double x) {
    *at = weight * x;
    at += native_width;
  };
  for (double x : form.a) put(x);
  for (double x : form.b) put(x);
  for (double x : form.s) put(x);
}

Kernel kernel(Rule rule, Want want) { return rule == Rule::projection ? projection_kernel(want) : geodesic_kernel(want); }

}  // namespace karcher::shell
