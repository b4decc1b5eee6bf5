#include "solve/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "karcher/solve/collectives.hpp"

namespace karcher {

std::vector<double> boundary_increment(const Layout& layout, const Configuration& u, const Configuration& boundary) {
  std::vector<double> delta(static_cast<std::size_t>(layout.local_dofs()), 0.0);
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    const auto ambient = static_cast<std::size_t>(manifold.ambient), dim = static_cast<std::size_t>(manifold.dim);
    std::vector<double> frame(ambient * dim), column(ambient), a(ambient);
    for (int node : layout.local_nodes(f)) {
      const int first = layout.first_dof(f, node);
      bool any = false;
      for (int k = 0; k < manifold.dim; ++k) any = any || layout.fixed(first + k);
      const double *p = u.at(f, node, manifold.ambient), *q = boundary.at(f, node, manifold.ambient);
      if (!any || std::equal(p, p + ambient, q)) continue;
      manifold.log(p, q, a.data());
      manifold.frame(p, frame.data());
      for (std::size_t k = 0; k < dim; ++k) {
        if (!layout.fixed(first + static_cast<int>(k))) continue;
        for (std::size_t i = 0; i < ambient; ++i) column[i] = frame[i * dim + k];
        delta[static_cast<std::size_t>(first) + k] = manifold.inner(p, column.data(), a.data());
      }
    }
  }
  return delta;
}

double uniform_norm(const Layout& layout, std::span<const double> mass, std::span<const double> s) {
  double square = 0;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const int dim = layout.fields()[static_cast<std::size_t>(f)].manifold->dim;
    double farthest = 0, weight = 0;
    for (int node : layout.local_nodes(f)) {
      const auto first = static_cast<std::size_t>(layout.first_dof(f, node));
      double here = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) here += s[first + k] * s[first + k];
      farthest = std::max(farthest, here);
      if (layout.owns(f, node)) weight += mass[first];
    }
    square += sum_over_ranks(weight) * max_over_ranks(farthest);
  }
  return std::sqrt(square);
}

void retract_to_boundary(const Layout& layout, const Configuration& from, std::span<const double> step, const Configuration& boundary,
                         Configuration& to) {
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    for (int node : layout.local_nodes(f))
      manifold.retract(from.at(f, node, manifold.ambient), step.data() + layout.first_dof(f, node), to.at(f, node, manifold.ambient));
  }
  copy_fixed_nodes(layout, boundary, to);
}

void copy_fixed_nodes(const Layout& layout, const Configuration& boundary, Configuration& u) {
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    for (int node : layout.local_nodes(f)) {
      bool all = true;
      for (int k = 0; k < manifold.dim; ++k) all = all && layout.fixed(layout.first_dof(f, node) + k);
      if (all) std::copy_n(boundary.at(f, node, manifold.ambient), manifold.ambient, u.at(f, node, manifold.ambient));
    }
  }
}

}  // namespace karcher
