#pragma once
/// \file
/// A field (a geometric finite element function: a manifold, an interpolation rule, a space) and a configuration (the nodal values of all fields).

#include <memory>
#include <string>
#include <vector>

#include "karcher/field/space.hpp"
#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/rule.hpp"

namespace karcher {

struct Field {
  std::string name;
  const ManifoldOps* manifold = nullptr;
  Rule rule = Rule::projection;  ///< without meaning for R^n
  std::shared_ptr<const Space> space;
};

/// Nodal values of every field, node after node in ambient coordinates, and the load parameter.
struct Configuration {
  std::vector<std::vector<double>> values;  ///< [field][node * ambient + component]
  double t = 0;

  const double* at(int field, int node, int ambient) const {
    return values[static_cast<std::size_t>(field)].data() + static_cast<std::size_t>(node) * static_cast<std::size_t>(ambient);
  }
  double* at(int field, int node, int ambient) {
    return values[static_cast<std::size_t>(field)].data() + static_cast<std::size_t>(node) * static_cast<std::size_t>(ambient);
  }
};

}  // namespace karcher
