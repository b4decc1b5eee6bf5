#pragma once
/// \file
/// Distance of a discrete field to a known map: L2 norm and H1 seminorm of the difference, in the coordinates of ManifoldOps::error_coordinates.
///
///   l2^2 = int |u_h - u|^2,   h1^2 = int |grad_s (u_h - u)|^2   over the region of the field, by quadrature of degree 2 order + 10;
/// grad_s is the gradient along the mesh's own (curved) cells.

#include <map>
#include <string>

#include "karcher/io/summary.hpp"
#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Errors against [exact] at u.t. \param u complete on this rank. Collective.
std::map<std::string, Summary::Error> errors_against_exact(const Problem& problem, const DiscreteProblem& model, const Configuration& u);

/// The value of a field in coordinates of errors, and its derivatives in the reference coordinates of a cell.
struct FieldSample {
  bool defined = true;
  std::vector<double> value;
  std::array<std::vector<double>, 3> d;
};
/// \param cell of the field's region
FieldSample sample_field(const Field& field, const std::vector<double>& nodal_values, int cell, const Vec3<double>& xi);

/// |sum of squares| of derivatives in reference coordinates, measured on the geometry: G^ab d_a . d_b, and the measure per reference measure.
struct Metric {
  double measure = 0;
  std::array<std::array<double, 3>, 3> inverse{};
  Metric(const GeometryJet& g, int dim);
};

}  // namespace karcher
