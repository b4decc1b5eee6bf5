#include "karcher/mesh/quadrature.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>

#include "karcher/error.hpp"
#include "mesh/gauss.hpp"
#include "mesh/simplex_rules.hpp"

namespace karcher {
namespace {

constexpr int highest_degree = 40;

Quadrature product_rule(CellKind kind, int degree) {
  const GaussRule g = gauss_jacobi(std::max(1, (degree + 2) / 2), 0);
  const int n = static_cast<int>(g.points.size()), dim = dimension(kind);
  Quadrature rule;
  for (int k = 0; k < (dim > 2 ? n : 1); ++k)
    for (int j = 0; j < (dim > 1 ? n : 1); ++j)
      for (int i = 0; i < n; ++i) {
        Vec3<double> x;
        double weight = 1;
        const std::array<int, 3> at = {i, j, k};
        for (int a = 0; a < dim; ++a) {
          x[a] = g.points[static_cast<std::size_t>(at[static_cast<std::size_t>(a)])];
          weight *= g.weights[static_cast<std::size_t>(at[static_cast<std::size_t>(a)])];
        }
        rule.points.push_back(x);
        rule.weights.push_back(weight);
      }
  return rule;
}

Quadrature expand(CellKind kind, const SymmetricRule& symmetric) {
  const auto corners = static_cast<std::size_t>(vertex_count(kind));
  Quadrature rule;
  for (const Orbit& orbit : symmetric.orbits) {
    std::vector<double> b(orbit.barycentric.begin(), orbit.barycentric.begin() + static_cast<std::ptrdiff_t>(corners));
    std::sort(b.begin(), b.end());
    do {
      Vec3<double> x;
      for (std::size_t a = 1; a < corners; ++a) x[static_cast<int>(a) - 1] = b[a];
      rule.points.push_back(x);
      rule.weights.push_back(orbit.weight * reference_measure(kind));
    } while (std::next_permutation(b.begin(), b.end()));
  }
  return rule;
}

/// Product rule on the simplex through the map of the cube that collapses a face per direction (Stroud's conical product).
Quadrature collapsed_rule(CellKind kind, int degree) {
  const int n = (degree + 2) / 2;
  const GaussRule x = gauss_jacobi(n, 0), y = gauss_jacobi(n, 1), z = gauss_jacobi(n, 2);
  Quadrature rule;
  const auto size = static_cast<std::size_t>(n);
  if (kind == CellKind::triangle) {
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = 0; i < size; ++i) {
        rule.points.push_back({{x.points[i] * (1 - y.points[j]), y.points[j], 0.0}});
        rule.weights.push_back(x.weights[i] * y.weights[j]);
      }
    return rule;
  }
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = 0; i < size; ++i) {
        const double c = z.points[k], b = y.points[j] * (1 - c), a = x.points[i] * (1 - y.points[j]) * (1 - c);
        rule.points.push_back({{a, b, c}});
        rule.weights.push_back(x.weights[i] * y.weights[j] * z.weights[k]);
      }
  return rule;
}

Quadrature make(CellKind kind, int degree) {
  switch (kind) {
    case CellKind::vertex:
      return {{Vec3<double>{}}, {1.0}};
    case CellKind::line:
    case CellKind::quadrilateral:
    case CellKind::hexahedron:
      return product_rule(kind, degree);
    case CellKind::triangle:
    case CellKind::tetrahedron:
      break;
  }
  const auto rules = kind == CellKind::triangle ? triangle_rules() : tetrahedron_rules();
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const SymmetricRule& rule) { return rule.degree >= degree; });
  return found != rules.end() ? expand(kind, *found) : collapsed_rule(kind, degree);
}

}  // namespace

const Quadrature& quadrature(CellKind kind, int degree) {
  if (degree < 0 || degree > highest_degree)
    throw InputError("Quadrature rules have degree 0 to " + std::to_string(highest_degree) + ", not " + std::to_string(degree) + ".");
  static std::mutex mutex;
  static std::map<std::pair<CellKind, int>, Quadrature> known;
  const std::lock_guard lock(mutex);
  const auto key = std::pair(kind, degree);
  const auto it = known.find(key);
  return it != known.end() ? it->second : known.emplace(key, make(kind, degree)).first->second;
}

}  // namespace karcher
