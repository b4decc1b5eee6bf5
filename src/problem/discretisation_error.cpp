#include "karcher/problem/discretisation_error.hpp"

#include <cmath>
#include <limits>

#include "karcher/interpolation/evaluate.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/together.hpp"

namespace karcher {

Metric::Metric(const GeometryJet& g, int dim) {
  std::array<std::array<double, 3>, 3> a{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          i < dim && j < dim ? dot(g.d[static_cast<std::size_t>(i)], g.d[static_cast<std::size_t>(j)]) : (i == j ? 1.0 : 0.0);
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
  };
  const double det = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
  measure = std::sqrt(std::max(0.0, det));
  for (std::size_t i = 0; i < static_cast<std::size_t>(dim); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(dim); ++j) inverse[i][j] = minor(i, j) / det;
}

FieldSample sample_field(const Field& field, const std::vector<double>& nodal_values, int cell, const Vec3<double>& xi) {
  const ManifoldOps& m = *field.manifold;
  const Cell& c = field.space->region().cells[static_cast<std::size_t>(cell)];
  const Shape shape = lagrange(c.kind, field.space->order(), xi);
  std::vector<double> nodes;
  for (const int n : field.space->cell_nodes(cell))
    nodes.insert(nodes.end(), nodal_values.begin() + n * m.ambient, nodal_values.begin() + (n + 1) * m.ambient);
  const FieldAtPoint at = evaluate_field(m, field.rule, nodes, shape.value, shape.gradient);
  FieldSample s;
  s.defined = at.defined;
  if (!at.defined) return s;
  const auto size = static_cast<std::size_t>(m.error_size);
  s.value.resize(size);
  m.error_coordinates(at.value.data(), s.value.data());
  for (std::size_t a = 0; a < 3; ++a) {
    s.d[a].resize(size);
    m.error_derivative(at.value.data(), at.d[a].data(), s.d[a].data());
  }
  return s;
}

std::map<std::string, Summary::Error> errors_against_exact(const Problem& problem, const DiscreteProblem& model, const Configuration& u) {
  std::map<std::string, Summary::Error> errors;
  std::vector<double> sums;
  together([&] {
    for (const auto& [index, exact] : problem.exact) {
      const Field& field = model.fields()[static_cast<std::size_t>(index)];
      const Space& space = *field.space;
      double l2 = 0, h1 = 0;
      for (std::size_t c = 0; c < space.region().cells.size(); ++c) {
        const Cell& cell = space.region().cells[c];
        if (model.layout->ranks() > 1 && model.layout->cell_rank(cell) != model.layout->rank()) continue;
        const int dim = dimension(cell.kind);
        const Quadrature& rule = quadrature(cell.kind, 2 * space.order() + 10);
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
          const GeometryJet g = geometry(*model.discretisation.mesh, cell, rule.points[q]);
          const Metric metric(g, dim);
          const FieldSample s = sample_field(field, u.values[static_cast<std::size_t>(index)], static_cast<int>(c), rule.points[q]);
          if (!s.defined) {
            l2 = h1 = std::numeric_limits<double>::quiet_NaN();
            continue;
          }
          const std::vector<Dual<double, 3>> known = exact.with_derivatives(g.x, u.t);
          double value = 0, slope = 0;
          std::array<double, 3> e{};
          for (std::size_t i = 0; i < known.size(); ++i) {
            value += (s.value[i] - known[i].v) * (s.value[i] - known[i].v);
            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
              e[a] = s.d[a][i];
              for (int k = 0; k < 3; ++k) e[a] -= known[i].d[static_cast<std::size_t>(k)] * g.d[a][k];
            }
            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
              for (std::size_t b = 0; b < static_cast<std::size_t>(dim); ++b) slope += metric.inverse[a][b] * e[a] * e[b];
          }
          l2 += rule.weights[q] * metric.measure * value;
          h1 += rule.weights[q] * metric.measure * slope;
        }
      }
      sums.insert(sums.end(), {l2, h1});
    }
  });
  sum_over_ranks(sums);
  std::size_t k = 0;
  for (const auto& entry : problem.exact) {
    errors[problem.fields[static_cast<std::size_t>(entry.first)].name] = {std::sqrt(sums[k]), std::sqrt(sums[k + 1])};
    k += 2;
  }
  return errors;
}

}  // namespace karcher
