#include "karcher/interpolation/evaluate.hpp"

#include <map>

#include "karcher/error.hpp"
#include "karcher/interpolation/evaluator.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"

namespace karcher {
namespace {

template <class... Ms>
std::map<std::string, FieldEvaluator> table_of() {
  return {{std::string(Ms::name), field_evaluator<Ms>()}...};
}

std::map<std::string, FieldEvaluator>& evaluators() {
  static std::map<std::string, FieldEvaluator> table = table_of<Euclidean<1>, Euclidean<2>, Euclidean<3>, Sphere<1>, Sphere<2>, Sphere<3>, Rotation,
                                                                Unitary, Spd<2>, Spd<3>, Hyperbolic<2>, Hyperbolic<3>>();
  return table;
}

}  // namespace

void register_evaluator(const std::string& manifold, FieldEvaluator evaluator) { evaluators()[manifold] = evaluator; }

FieldAtPoint evaluate_field(const ManifoldOps& manifold, Rule rule, std::span<const double> nodes, std::span<const double> l,
                            std::span<const std::array<double, 3>> dl) {
  const auto found = evaluators().find(manifold.name);
  if (found == evaluators().end())
    throw InputError("No interpolation is registered for the manifold " + manifold.name + " (see register_evaluator).");
  const auto function = rule == Rule::projection ? found->second.projection : found->second.geodesic;
  if (!function) throw InputError(manifold.name + " has no projection from its ambient space; use interpolation = \"geodesic\".");
  return function(nodes, l, dl);
}

FieldAtPoint evaluate_field(const ManifoldOps& manifold, Rule rule, std::span<const double> nodes, std::span<const double> l) {
  return evaluate_field(manifold, rule, nodes, l, {});
}

}  // namespace karcher
