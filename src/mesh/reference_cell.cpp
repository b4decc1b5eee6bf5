#include "karcher/mesh/reference_cell.hpp"

#include <algorithm>

#include "karcher/error.hpp"
#include "mesh/lattice.hpp"

namespace karcher {
namespace {

constexpr int highest_order = 3;
constexpr std::size_t kinds = 6;

std::size_t index(CellKind kind) { return static_cast<std::size_t>(kind); }

void check_order(int order) {
  if (order < 1 || order > highest_order) throw InputError("Lagrange cells have order 1, 2 or 3, not " + std::to_string(order) + ".");
}

/// A factor of a basis function and its first two derivatives.
struct Factor {
  double value = 1, d = 0, dd = 0;
};

/// Equispaced Lagrange polynomial of order p on [0, 1] that is one at k / p.
Factor lagrange_1d(int p, int k, double t) {
  Factor f;
  for (int j = 0; j <= p; ++j) {
    if (j == k) continue;
    const double scale = 1.0 / (k - j), g = (p * t - j) * scale, dg = p * scale;
    f = {f.value * g, f.d * g + f.value * dg, f.dd * g + 2 * f.d * dg};
  }
  return f;
}

/// prod_{j < k} (p t - j) / (k - j): a Lagrange function on a simplex is the product of these over its barycentric coordinates (Silvester 1969).
Factor silvester(int p, int k, double t) {
  Factor f;
  for (int j = 0; j < k; ++j) {
    const double scale = 1.0 / (k - j), g = (p * t - j) * scale, dg = p * scale;
    f = {f.value * g, f.d * g + f.value * dg, f.dd * g + 2 * f.d * dg};
  }
  return f;
}

constexpr std::array<std::array<int, 2>, 6> pairs = {{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

Shape tensor_product_shape(CellKind kind, int order, const Vec3<double>& xi) {
  const auto dim = static_cast<std::size_t>(dimension(kind));
  Shape shape;
  for (const LatticePoint& point : lattice(kind, order)) {
    std::array<Factor, 3> f;
    for (std::size_t a = 0; a < dim; ++a) f[a] = lagrange_1d(order, point[a], xi[static_cast<int>(a)]);
    shape.value.push_back(f[0].value * f[1].value * f[2].value);
    const auto derivative = [&](std::size_t a, std::size_t b) {
      double product = 1;
      for (std::size_t c = 0; c < 3; ++c) {
        const int times = (a == c) + (b == c);
        product *= times == 0 ? f[c].value : times == 1 ? f[c].d : f[c].dd;
      }
      return product;
    };
    auto& g = shape.gradient.emplace_back();
    for (std::size_t a = 0; a < dim; ++a) g[a] = derivative(a, 3);
    auto& h = shape.hessian.emplace_back();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto a = static_cast<std::size_t>(pairs[i][0]), b = static_cast<std::size_t>(pairs[i][1]);
      if (b < dim) h[i] = derivative(a, b);
    }
  }
  return shape;
}

Shape simplex_shape(CellKind kind, int order, const Vec3<double>& xi) {
  const auto dim = static_cast<std::size_t>(dimension(kind));
  const std::vector<double> barycentric = vertex_functions(kind, xi);
  Shape shape;
  for (const LatticePoint& point : lattice(kind, order)) {
    std::array<Factor, 4> f;  // of the barycentric coordinates; the first one is 1 - sum of the others
    f[0] = silvester(order, order - point[0] - point[1] - point[2], barycentric[0]);
    for (std::size_t a = 0; a < dim; ++a) f[a + 1] = silvester(order, point[a], barycentric[a + 1]);
    const auto product = [&](std::size_t a, std::size_t b) {  // derivative by barycentric coordinates a and b (4: none)
      double value = 1;
      for (std::size_t c = 0; c <= dim; ++c) {
        const int times = (a == c) + (b == c);
        value *= times == 0 ? f[c].value : times == 1 ? f[c].d : f[c].dd;
      }
      return value;
    };
    shape.value.push_back(product(4, 4));
    auto& g = shape.gradient.emplace_back();
    for (std::size_t a = 0; a < dim; ++a) g[a] = product(a + 1, 4) - product(0, 4);
    auto& h = shape.hessian.emplace_back();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto a = static_cast<std::size_t>(pairs[i][0]), b = static_cast<std::size_t>(pairs[i][1]);
      if (b < dim) h[i] = product(a + 1, b + 1) - product(a + 1, 0) - product(0, b + 1) + product(0, 0);
    }
  }
  return shape;
}

std::vector<int> find_facet_nodes(CellKind kind, int order, const ReferenceFace& facet) {
  const auto& points = lattice(kind, order);
  std::vector<int> nodes;
  for (const LatticePoint& on_facet : lattice(facet.kind, order)) {
    const Vec3<double> xi{{static_cast<double>(on_facet[0]) / order, static_cast<double>(on_facet[1]) / order, 0.0}};
    const std::vector<double> weight = vertex_functions(facet.kind, xi);
    std::array<double, 3> wanted{};
    for (std::size_t v = 0; v < facet.vertices.size(); ++v)
      for (std::size_t i = 0; i < 3; ++i) wanted[i] += order * weight[v] * corners(kind)[static_cast<std::size_t>(facet.vertices[v])][i];
    const auto found = std::find_if(points.begin(), points.end(), [&](const LatticePoint& p) {
      double distance2 = 0;
      for (std::size_t i = 0; i < 3; ++i) distance2 += (p[i] - wanted[i]) * (p[i] - wanted[i]);
      return distance2 < 1e-12;
    });
    nodes.push_back(static_cast<int>(found - points.begin()));
  }
  return nodes;
}

template <class T, class Make>
std::array<std::array<T, highest_order>, kinds> for_all_cells(Make make) {
  std::array<std::array<T, highest_order>, kinds> table;
  for (std::size_t k = 0; k < kinds; ++k)
    for (int order = 1; order <= highest_order; ++order) table[k][static_cast<std::size_t>(order - 1)] = make(static_cast<CellKind>(k), order);
  return table;
}

}  // namespace

std::string_view name(CellKind kind) {
  static constexpr std::array<std::string_view, kinds> names = {"vertex", "line", "triangle", "quadrilateral", "tetrahedron", "hexahedron"};
  return names[index(kind)];
}

int dimension(CellKind kind) {
  static constexpr std::array<int, kinds> dimensions = {0, 1, 2, 2, 3, 3};
  return dimensions[index(kind)];
}

int vertex_count(CellKind kind) {
  static constexpr std::array<int, kinds> counts = {1, 2, 3, 4, 4, 8};
  return counts[index(kind)];
}

int node_count(CellKind kind, int order) {
  const int p = order;
  switch (kind) {
    case CellKind::vertex:
      return 1;
    case CellKind::line:
      return p + 1;
    case CellKind::triangle:
      return (p + 1) * (p + 2) / 2;
    case CellKind::quadrilateral:
      return (p + 1) * (p + 1);
    case CellKind::tetrahedron:
      return (p + 1) * (p + 2) * (p + 3) / 6;
    case CellKind::hexahedron:
      break;
  }
  return (p + 1) * (p + 1) * (p + 1);
}

double reference_measure(CellKind kind) {
  static constexpr std::array<double, kinds> measures = {1.0, 1.0, 0.5, 1.0, 1.0 / 6.0, 1.0};
  return measures[index(kind)];
}

const std::vector<std::array<int, 2>>& edges(CellKind kind) {
  static const std::array<std::vector<std::array<int, 2>>, kinds> table = {{
      {},
      {{0, 1}},
      {{0, 1}, {1, 2}, {2, 0}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
  }};
  return table[index(kind)];
}

const std::vector<ReferenceFace>& faces(CellKind kind) {
  constexpr CellKind tri = CellKind::triangle, quad = CellKind::quadrilateral;
  static const std::array<std::vector<ReferenceFace>, kinds> table = {{
      {},
      {},
      {},
      {},
      {{tri, {0, 2, 1}}, {tri, {0, 1, 3}}, {tri, {0, 3, 2}}, {tri, {1, 2, 3}}},
      {{quad, {0, 3, 2, 1}}, {quad, {4, 5, 6, 7}}, {quad, {0, 1, 5, 4}}, {quad, {2, 3, 7, 6}}, {quad, {0, 4, 7, 3}}, {quad, {1, 2, 6, 5}}},
  }};
  return table[index(kind)];
}

const std::vector<ReferenceFace>& facets(CellKind kind) {
  static const auto table = [] {
    std::array<std::vector<ReferenceFace>, kinds> all;
    for (std::size_t k = 0; k < kinds; ++k) {
      const auto cell = static_cast<CellKind>(k);
      if (dimension(cell) == 3) all[k] = faces(cell);
      if (dimension(cell) == 2)
        for (const auto& e : edges(cell)) all[k].push_back({CellKind::line, {e[0], e[1]}});
      if (dimension(cell) == 1) all[k] = {{CellKind::vertex, {0}}, {CellKind::vertex, {1}}};
    }
    return all;
  }();
  return table[index(kind)];
}

const std::vector<Vec3<double>>& lagrange_nodes(CellKind kind, int order) {
  check_order(order);
  static const auto table = for_all_cells<std::vector<Vec3<double>>>([](CellKind cell, int p) {
    std::vector<Vec3<double>> nodes;
    for (const LatticePoint& point : lattice(cell, p)) {
      auto& x = nodes.emplace_back();
      for (int i = 0; i < 3; ++i) x[i] = static_cast<double>(point[static_cast<std::size_t>(i)]) / p;
    }
    return nodes;
  });
  return table[index(kind)][static_cast<std::size_t>(order - 1)];
}

const std::vector<int>& facet_nodes(CellKind kind, int order, int f) {
  check_order(order);
  static const auto table = for_all_cells<std::vector<std::vector<int>>>([](CellKind cell, int p) {
    std::vector<std::vector<int>> all;
    for (const ReferenceFace& facet : facets(cell)) all.push_back(find_facet_nodes(cell, p, facet));
    return all;
  });
  return table[index(kind)][static_cast<std::size_t>(order - 1)][static_cast<std::size_t>(f)];
}

Shape lagrange(CellKind kind, int order, const Vec3<double>& xi) {
  check_order(order);
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  return simplex ? simplex_shape(kind, order, xi) : tensor_product_shape(kind, order, xi);
}

}  // namespace karcher
