#pragma once
/// \file
/// Meshes, fields and nodal values for tests of what is written.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "karcher/field/field.hpp"
#include "karcher/mesh/generators.hpp"

namespace karcher::testing {

inline std::shared_ptr<const Mesh> generated(const std::string& name, std::map<std::string, std::vector<double>> numbers,
                                             std::map<std::string, std::string> words = {}) {
  return std::make_shared<const Mesh>(generate({name, std::move(numbers), std::move(words)}));
}

inline Field field_on(const std::shared_ptr<const Mesh>& mesh, const Region& region, const std::string& name, const std::string& manifold, int order,
                      Rule rule = Rule::projection) {
  return {name, &manifold_by_name(manifold), rule, std::make_shared<const Space>(mesh, region, order)};
}

/// Values of a field from a function of the place.
template <class F>
std::vector<double> nodal(const Field& field, F f) {
  std::vector<double> values;
  for (int n = 0; n < field.space->node_count(); ++n) {
    const std::vector<double> v = f(field.space->position(n));
    values.insert(values.end(), v.begin(), v.end());
  }
  return values;
}

}  // namespace karcher::testing
