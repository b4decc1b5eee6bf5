#pragma once
/// \file
/// The fast kernel of the curved Cosserat shell: energy, gradient and Hessian of native_width elements at once, in closed form.
///
/// Data of all lanes stand side by side ("entry-major, lane-minor": entry e of lane l at e * native_width + l), aligned to 64 bytes. Unknowns of an
/// element:
/// the deformation nodes (three coordinates each), then the rotation nodes (v of R exp([v])). The derivation is docs/cosserat-kernel.md.

#include <array>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/manifold/rule.hpp"

namespace karcher::shell {

/// Most nodes that one field may have on an element (cubic quadrilateral).
inline constexpr int max_nodes = 16;

/// Lagrange bases at the quadrature points of one kind of cell.
struct Tables {
  int points = 0, m_nodes = 0, r_nodes = 0;
  std::vector<double> m_gradient;           ///< [point][node][2]: derivatives of the deformation's basis in reference coordinates
  std::vector<double> r_value, r_gradient;  ///< [point][node], [point][node][2]: the rotation's basis
};

/// What the kernel knows of a quadrature point: the Jacobian a^a . t_b (4), the unit quaternion of the principal frame (4), the quadratic form of the
/// density times the weight of the point (24).
inline constexpr int point_entries = 8 + ShellForm<double>::size;

/// Writes one lane of the data of a point.
/// \param frame  rotation matrix with the columns t_1, t_2, n_0 \param weight  quadrature weight times sqrt(det a)
void store_point(double* point, int lane, const Mat<double, 2, 2>& jacobian, const Mat3<double>& frame, const ShellForm<double>& form, double weight);
/// Writes the quadratic form only.
void store_form(double* point, int lane, const ShellForm<double>& form, double weight);

/// Where the results go; energy and trouble have native_width entries. gradient and hessian may be null where they are not wanted.
struct Output {
  double* energy = nullptr;
  Trouble* trouble = nullptr;
  double* gradient = nullptr;  ///< 3 (m_nodes + r_nodes) entries
  double* hessian = nullptr;   ///< that number squared; entries (r, c) with r <= c and the whole 3 x 3 diagonal blocks are written
};

/// \param points  [point][point_entries] \param m  [node][3] \param q  [node][4]: unit quaternions, either sign
/// A lane whose interpolation is not defined or whose results are not finite has its trouble set and its energy infinite.
using Kernel = void (*)(const Tables&, const double* points, const double* m, const double* q, const Output&);

/// One for all node counts up to max_nodes: a copy for six and six nodes was not faster.
Kernel kernel(Rule rule, Want want);

}  // namespace karcher::shell
