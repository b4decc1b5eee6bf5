#include "mesh/simplex_rules.hpp"

#include <cmath>

namespace karcher {

std::span<const SymmetricRule> triangle_rules() {
  static const double root15 = std::sqrt(15.0), a = (6 - root15) / 21, b = (6 + root15) / 21;
  static const std::vector<SymmetricRule> rules = {
      {1, {{1, {1.0 / 3, 1.0 / 3, 1.0 / 3}}}},
      {2, {{1.0 / 3, {1.0 / 6, 1.0 / 6, 2.0 / 3}}}},
      {5, {{9.0 / 40, {1.0 / 3, 1.0 / 3, 1.0 / 3}}, {(155 - root15) / 1200, {a, a, 1 - 2 * a}}, {(155 + root15) / 1200, {b, b, 1 - 2 * b}}}},
  };
  return rules;
}

std::span<const SymmetricRule> tetrahedron_rules() {
  static const double a = (5 - std::sqrt(5.0)) / 20;
  static const std::vector<SymmetricRule> rules = {
      {1, {{1, {0.25, 0.25, 0.25, 0.25}}}},
      {2, {{0.25, {a, a, a, 1 - 3 * a}}}},
  };
  return rules;
}

}  // namespace karcher
