#pragma once
/// \file
/// Points of manifolds as problem files write them: initial and boundary values, targets, exact solutions.

#include <optional>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/toml_value.hpp"
#include "karcher/manifold/any_manifold.hpp"
#include "karcher/problem/problem.hpp"

namespace karcher::app {

/// A map into a manifold given by expressions.
class PointValue {
 public:
  PointValue() = default;
  /// \param value an array of numbers and expressions (one number where one is enough) as ManifoldOps::entries reads them: ambient coordinates, projected, or what
  ///   else the manifold knows (rotation vectors); or "identity", if it has one
  /// \throws InputError for a wrong number of entries and whatever else is no point
  PointValue(const Value& value, const std::string& key, const ManifoldOps& manifold, const Scope& scope);
  /// The map as a problem takes it.
  PointFunction function() const;
  /// Constant, in ambient coordinates.
  static PointValue constant(std::vector<double> point, const std::string& key, const ManifoldOps& manifold);

  /// Ambient coordinates of the point. \throws InputError with key, place and point where the entries give no point of the manifold
  void evaluate(const Vec3<double>& x, double t, double* point) const;
  bool uses_t() const;
  bool is_given() const { return manifold_ != nullptr; }
  const ManifoldOps& manifold() const { return *manifold_; }
  const std::vector<Expression>& entries() const { return entries_; }

  /// ManifoldOps::error_coordinates, with derivatives in x, y, z. The entries are taken as they are, not projected.
  std::vector<Dual<double, 3>> with_derivatives(const Vec3<double>& x, double t) const;

 private:
  const ManifoldOps* manifold_ = nullptr;
  std::vector<Expression> entries_;
  std::string key_;
  Place place_;
};

}  // namespace karcher::app
