#pragma once
/// \file
/// Maps of a plane domain given by a formula: their interpolants, and the errors of finite element maps against them, derivatives by dual numbers.

#include <cmath>
#include <vector>

#include "karcher/field/field.hpp"
#include "karcher/interpolation/evaluate.hpp"
#include "karcher/math/functions.hpp"
#include "karcher/mesh/quadrature.hpp"

namespace karcher::testing {

struct MapError {
  double l2 = 0, h1 = 0;  ///< of ambient coordinates: |u - u_h| and |grad(u - u_h)|
};

/// Nodal values. \param map  Vec<S, ambient>(Vec<S, 2>) for any scalar S
template <class Map>
std::vector<double> nodal_values(const Space& space, const Map& map) {
  std::vector<double> values;
  for (int i = 0; i < space.node_count(); ++i)
    for (double x : map(Vec<double, 2>{{space.position(i)[0], space.position(i)[1]}}).e) values.push_back(x);
  return values;
}

template <class Map>
MapError error_of(const Field& field, const std::vector<double>& values, const Map& map) {
  using S = Dual<double, 2>;
  const Space& space = *field.space;
  const auto ambient = static_cast<std::size_t>(field.manifold->ambient);
  MapError error;
  for (std::size_t c = 0; c < space.region().cells.size(); ++c) {
    const Cell& cell = space.region().cells[c];
    std::vector<double> nodes;
    for (int n : space.cell_nodes(static_cast<int>(c)))
      for (std::size_t k = 0; k < ambient; ++k) nodes.push_back(values[static_cast<std::size_t>(n) * ambient + k]);
    const Quadrature& rule = quadrature(cell.kind, 2 * space.order() + 10);
    for (std::size_t q = 0; q < rule.weights.size(); ++q) {
      const GeometryJet g = geometry(space.mesh(), cell, rule.points[q]);
      Mat<double, 2, 2> jacobian;
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) jacobian(a, b) = g.d[static_cast<std::size_t>(b)][a];
      const double det = jacobian(0, 0) * jacobian(1, 1) - jacobian(0, 1) * jacobian(1, 0);
      const Mat<double, 2, 2> back{{jacobian(1, 1) / det, -jacobian(0, 1) / det, -jacobian(1, 0) / det, jacobian(0, 0) / det}};
      const Shape shape = lagrange(cell.kind, space.order(), rule.points[q]);
      std::vector<std::array<double, 3>> dl(shape.gradient.size());
      for (std::size_t n = 0; n < dl.size(); ++n)
        for (std::size_t a = 0; a < 2; ++a)
          dl[n][a] = shape.gradient[n][0] * back(0, static_cast<int>(a)) + shape.gradient[n][1] * back(1, static_cast<int>(a));
      const FieldAtPoint u = evaluate_field(*field.manifold, field.rule, nodes, shape.value, dl);
      if (!u.defined) return {NAN, NAN};
      Vec<S, 2> x;
      for (int a = 0; a < 2; ++a) {
        x[a].v = g.x[a];
        x[a].d[static_cast<std::size_t>(a)] = 1;
      }
      const auto exact = map(x);
      const double weight = rule.weights[q] * std::fabs(det);
      // p and -p are the same rotation
      double side = 0;
      for (std::size_t k = 0; k < ambient; ++k) side += u.value[k] * exact[static_cast<int>(k)].v;
      const double sign = field.manifold->name == "SO3" && side < 0 ? -1 : 1;
      for (std::size_t k = 0; k < ambient; ++k) {
        const S& e = exact[static_cast<int>(k)];
        error.l2 += weight * std::pow(sign * u.value[k] - e.v, 2);
        for (std::size_t a = 0; a < 2; ++a) error.h1 += weight * std::pow(sign * u.d[a][k] - e.d[a], 2);
      }
    }
  }
  return {std::sqrt(error.l2), std::sqrt(error.h1)};
}

/// (2x, 2y, r^2 - 1)/(r^2 + 1): harmonic.
struct InverseStereographic {
  template <class S>
  Vec<S, 3> operator()(const Vec<S, 2>& x) const {
    const S r2 = x[0] * x[0] + x[1] * x[1], f = 1.0 / (r2 + 1.0);
    return {{2.0 * f * x[0], 2.0 * f * x[1], f * (r2 - 1.0)}};
  }
};

}  // namespace karcher::testing
