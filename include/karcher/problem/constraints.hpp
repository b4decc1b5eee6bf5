#pragma once
/// \file
/// Dirichlet data on the nodes of the fields.

#include <span>
#include <vector>

#include "karcher/field/field.hpp"
#include "karcher/problem/problem.hpp"

namespace karcher {

class Constraints {
 public:
  Constraints() = default;
  /// \throws InputError for regions that are unknown or carry no node of the field, and where two entries give one node different values at the first or last load
  ///   parameter
  Constraints(const Problem& problem, std::span<const Field> fields, const Configuration& initial);

  /// fixed[field][node * dim + component], as Layout takes it
  const std::vector<std::vector<char>>& fixed() const { return fixed_; }
  /// Are there values that differ from the initial ones?
  bool has_values() const { return !values_.empty(); }
  /// Writes the values at t into the fixed components of u.
  void apply(double t, Configuration& u) const;

 private:
  struct NodeValue {
    int spec = 0, field = 0, node = 0;
    MeshPoint place;
  };

  std::vector<DirichletSpec> specs_;
  std::vector<std::vector<char>> fixed_;
  std::vector<NodeValue> values_;
  std::vector<int> ambient_;
};

}  // namespace karcher
