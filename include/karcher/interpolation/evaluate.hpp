#pragma once
/// \file
/// A field at a point, by names chosen at run time: for output, probes, errors and transfer. Kernels use the types of rules.hpp.

#include <array>
#include <span>
#include <vector>

#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/rule.hpp"

namespace karcher {

struct FieldAtPoint {
  bool defined = true;                   ///< false where the nodal values are too far apart; the rest is then meaningless
  std::vector<double> value;             ///< ambient coordinates
  std::array<std::vector<double>, 3> d;  ///< derivatives in the three directions of the weights
};

/// \param nodes  nodal values, node after node in ambient coordinates
/// \param l, dl  Lagrange basis at the point: values, and derivatives in any three directions (zeros for directions that do not exist)
/// \throws InputError for the projection rule on a manifold without one
FieldAtPoint evaluate_field(const ManifoldOps& manifold, Rule rule, std::span<const double> nodes, std::span<const double> l,
                            std::span<const std::array<double, 3>> dl);
/// The value alone.
FieldAtPoint evaluate_field(const ManifoldOps& manifold, Rule rule, std::span<const double> nodes, std::span<const double> l);

/// Fills the table for a user's own manifold, so that evaluate_field knows it. The built-in manifolds are there already.
struct FieldEvaluator {
  FieldAtPoint (*projection)(std::span<const double>, std::span<const double>, std::span<const std::array<double, 3>>) = nullptr;
  FieldAtPoint (*geodesic)(std::span<const double>, std::span<const double>, std::span<const std::array<double, 3>>) = nullptr;
};
void register_evaluator(const ManifoldOps& manifold, FieldEvaluator evaluator);

}  // namespace karcher
