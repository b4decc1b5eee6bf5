#include "karcher/interpolation/evaluate.hpp"

#include <map>

#include "karcher/error.hpp"
#include "karcher/interpolation/evaluator.hpp"
#include "karcher/manifold/every_manifold.hpp"

namespace karcher {
namespace {

using Table = std::map<const ManifoldOps*, FieldEvaluator>;

Table& evaluators() {
  static Table table = [] {
    Table built_in;
    EveryManifold::for_each([&]<class M>() { built_in[&manifold_ops<M>()] = field_evaluator<M>(); });
    return built_in;
  }();
  return table;
}

}  // namespace

void register_evaluator(const ManifoldOps& manifold, FieldEvaluator evaluator) { evaluators()[&manifold] = evaluator; }

FieldAtPoint evaluate_field(const ManifoldOps& manifold, Rule rule, std::span<const double> nodes, std::span<const double> l,
                            std::span<const std::array<double, 3>> dl) {
  const auto found = evaluators().find(&manifold);
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
