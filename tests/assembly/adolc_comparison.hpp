#pragma once
/// \file
/// A term of one field against ADOL-C on the same elements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "assembly/adolc.hpp"
#include "assembly/density_oracle.hpp"
#include "assembly/map_problem.hpp"

namespace karcher::testing {

struct Difference {
  double energy = 0, gradient = 0, hessian = 0;  // relative to the largest entry
};

/// Sums ADOL-C's element by element and compares with what the functional assembles.
template <class G, int D, class Density>
Difference compare(const MapProblem& p, int degree, const Density& density) {
  const Dense k(p);
  EXPECT_FALSE(k.evaluation.failure) << k.evaluation.failure->sentence();
  const auto n = p.dofs();
  double energy = 0;
  std::vector<double> gradient(n);
  std::vector<std::vector<double>> hessian(n, std::vector<double>(n));
  const auto ambient = static_cast<std::size_t>(p.manifold().ambient), dim = static_cast<std::size_t>(p.manifold().dim);
  for (const Cell& cell : p.input.region.cells) {
    auto e = density_oracle::element<D>(*p.input.mesh, cell, p.space().order(), degree);
    e.rule = p.input.all_fields.front().rule;
    e.dim = dim;
    std::vector<std::size_t> dof;
    for (int node : p.space().entity_nodes(cell)) {
      const double* x = p.u.at(0, node, p.manifold().ambient);
      e.nodes.emplace_back(x, x + ambient);
      e.frames.emplace_back(ambient * dim);
      p.manifold().frame(x, e.frames.back().data());
      for (std::size_t c = 0; c < dim; ++c) dof.push_back(static_cast<std::size_t>(p.layout->first_dof(0, node)) + c);
    }
    const auto d = adolc::differentiate(e.unknowns(), [&](const adouble* v) { return density_oracle::energy<G, D, adouble>(e, v, density); });
    energy += d.energy;
    for (std::size_t r = 0; r < dof.size(); ++r) {
      gradient[dof[r]] += d.gradient[r];
      for (std::size_t c = 0; c <= r; ++c) {
        hessian[dof[r]][dof[c]] += d.hessian[r][c];
        if (c != r) hessian[dof[c]][dof[r]] += d.hessian[r][c];
      }
    }
  }
  Difference difference;
  double largest_gradient = 0, largest_hessian = 0;
  difference.energy = std::fabs(energy - k.evaluation.energy) / std::fabs(energy);
  for (std::size_t r = 0; r < n; ++r) {
    largest_gradient = std::max(largest_gradient, std::fabs(gradient[r]));
    difference.gradient = std::max(difference.gradient, std::fabs(gradient[r] - k.gradient[r]));
    for (std::size_t c = 0; c < n; ++c) {
      largest_hessian = std::max(largest_hessian, std::fabs(hessian[r][c]));
      difference.hessian = std::max(difference.hessian, std::fabs(hessian[r][c] - k.hessian[r][c]));
    }
  }
  difference.gradient /= largest_gradient;
  difference.hessian /= largest_hessian;
  return difference;
}

inline void expect_small(const Difference& d, double tolerance = 1e-10) {
  EXPECT_LT(d.energy, tolerance);
  EXPECT_LT(d.gradient, tolerance);
  EXPECT_LT(d.hessian, tolerance);
}

/// Every kind of cell, few cells that are neither equal nor affine where the kind allows it.
inline std::shared_ptr<const Mesh> cells_of(CellKind kind) {
  switch (kind) {
    case CellKind::line:
      return moved_mesh("interval", {{"cells", {3}}, {"order", {2}}}, "", 0.05, 3);
    case CellKind::triangle:
    case CellKind::quadrilateral:
      return moved_mesh("rectangle", {{"cells", {1, 2}}, {"order", {1}}}, std::string(name(kind)), 0.1, 2);
    default:
      return moved_mesh("box", {{"cells", {1, 1, 1}}, {"order", {1}}}, std::string(name(kind)), 0.1, 3);
  }
}

}  // namespace karcher::testing
