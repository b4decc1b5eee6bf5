#pragma once
/// \file
/// Dirichlet data on the nodes of the fields, and when they hold.

#include <span>
#include <vector>

#include "karcher/field/field.hpp"
#include "karcher/problem/problem.hpp"

namespace karcher {

class Constraints {
 public:
  /// fixed[field][node * dim + component], as Layout takes it
  using Fixed = std::vector<std::vector<char>>;
  /// Load steps that end at t with begin < t <= end have the same supports.
  struct Phase {
    double begin = 0, end = 0;
    Fixed fixed;
  };

  Constraints() = default;
  /// \throws InputError for regions that are unknown or carry no node of the field, where two entries give one node different values at the first or last load at
  ///   which both hold, and for what cannot be held
  Constraints(const Problem& problem, std::span<const Field> fields, const Configuration& initial);

  /// In the order of the load steps; one where the supports never change.
  const std::vector<Phase>& phases() const { return phases_; }
  /// That of a load step that ends at t.
  std::size_t phase(double t) const;
  /// Of the first load steps.
  const Fixed& fixed() const { return phases_.front().fixed; }
  /// Are there values that differ from the initial ones?
  bool has_values() const { return !values_.empty(); }
  /// Writes the values at t into the fixed components of u.
  void apply(double t, Configuration& u) const;
  /// Puts the initial values back that the first load steps keep, into a u that starts elsewhere.
  void restore(Configuration& u) const;

 private:
  /// What an entry wants of a node.
  struct NodeValue {
    int spec = 0, field = 0, node = 0;
    MeshPoint place;
    std::vector<double> initial;  ///< of an entry that goes back to the initial values: one that sets in late, or of a field that starts elsewhere
  };

  void find_phases(const Problem& problem);
  bool holds(const DirichletSpec& spec, const Phase& phase) const;
  std::vector<double> wanted(const NodeValue& v, double t, const Configuration& u) const;
  void write(const NodeValue& v, double t, double* point) const;

  std::vector<DirichletSpec> specs_;
  std::vector<Phase> phases_;
  std::vector<NodeValue> values_;
  std::vector<NodeValue> kept_;  ///< of restore()
  std::vector<int> ambient_;
  double same_ = 0;  ///< values of t that differ by less are the same
};

}  // namespace karcher
