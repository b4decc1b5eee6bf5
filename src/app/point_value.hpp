#pragma once
/// \file
/// Points of manifolds as problem files write them: initial and boundary values, targets, exact solutions.

#include <optional>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/toml_value.hpp"
#include "karcher/manifold/any_manifold.hpp"

namespace karcher::app {

/// A map into a manifold given by expressions.
class PointValue {
 public:
  PointValue() = default;
  /// \param value an array of numbers and expressions (one number where one is enough), or "identity" (SO3, SU2, SPD).
  ///   R^n: n entries; S^n, SU2, H^n: ambient coordinates, projected; SO3: rotation vector (3), matrix by rows (9, projected), quaternion (4, w first);
  ///   SPD(n): n*n entries by rows
  /// \throws InputError for a wrong number of entries and whatever else is no point
  PointValue(const Value& value, const std::string& key, const ManifoldOps& manifold, const Scope& scope);
  /// Constant, in ambient coordinates.
  static PointValue constant(std::vector<double> point, const std::string& key, const ManifoldOps& manifold);

  /// Ambient coordinates of the point. \throws InputError with key, place and point where the entries give no point of the manifold
  void evaluate(const Vec3<double>& x, double t, double* point) const;
  bool uses_t() const;
  bool is_given() const { return manifold_ != nullptr; }
  const ManifoldOps& manifold() const { return *manifold_; }
  const std::vector<Expression>& entries() const { return entries_; }

  /// Coordinates in the Euclidean space where errors are measured, with derivatives in x, y, z: see error_coordinates(). The entries are taken as they are, not
  /// projected.
  std::vector<Dual<double, 3>> with_derivatives(const Vec3<double>& x, double t) const;

 private:
  const ManifoldOps* manifold_ = nullptr;
  std::vector<Expression> entries_;
  std::string key_;
  Place place_;
};

/// The point that a field has without initial values: 0, the identity, or the last axis of a sphere (first of a hyperboloid).
std::vector<double> standard_point(const ManifoldOps& manifold);

/// Errors are measured in Euclidean coordinates that induce the metric of the manifold: the ambient ones of R^n and S^n; rotations as matrices divided by sqrt 2
/// (so that small distances are angles); SPD(n) and H^n in ambient coordinates.
/// \param p, dp  ambient coordinates and one derivative of them
std::vector<double> error_coordinates(const ManifoldOps& manifold, const double* p);
std::vector<double> error_derivative(const ManifoldOps& manifold, const double* p, const double* dp);

}  // namespace karcher::app
