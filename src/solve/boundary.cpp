#include "solve/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "karcher/solve/collectives.hpp"
#include "karcher/solve/spread.hpp"

namespace karcher {
namespace {

bool any_fixed(const Layout& layout, int field, int node) {
  const int first = layout.first_dof(field, node), dim = layout.fields()[static_cast<std::size_t>(field)].manifold->dim;
  bool any = false;
  for (int k = 0; k < dim; ++k) any = any || layout.fixed(first + k);
  return any;
}

}  // namespace

std::vector<double> boundary_increment(const Layout& layout, const Configuration& u, const Configuration& boundary) {
  std::vector<double> delta(static_cast<std::size_t>(layout.local_dofs()), 0.0);
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    const auto ambient = static_cast<std::size_t>(manifold.ambient), dim = static_cast<std::size_t>(manifold.dim);
    std::vector<double> frame(ambient * dim), column(ambient), a(ambient);
    for (int node : layout.local_nodes(f)) {
      const int first = layout.first_dof(f, node);
      const double *p = u.at(f, node, manifold.ambient), *q = boundary.at(f, node, manifold.ambient);
      if (!any_fixed(layout, f, node) || std::equal(p, p + ambient, q)) continue;
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

std::string far_turn(const Layout& layout, const Configuration& u, const Configuration& boundary) {
  double largest = 0;
  std::string sentence;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const Field& field = layout.fields()[static_cast<std::size_t>(f)];
    const ManifoldOps& m = *field.manifold;
    if (m.linear) continue;
    for (const int node : layout.local_nodes(f)) {
      if (!any_fixed(layout, f, node)) continue;
      const double ratio = m.cut_ratio(u.at(f, node, m.ambient), boundary.at(f, node, m.ambient));
      if (!(ratio > std::max(largest, Spread::wide))) continue;
      largest = ratio;
      const Vec3<double>& x = field.space->position(node);
      sentence = fmt::format(
          "the boundary data of the field \"{}\" turn by {:.0f} degrees in this load step, at ({:.4g}, {:.4g}, {:.4g}): which way is open. Angles "
          "are in radians; more load steps or initial values that fit tell the way",
          field.name, ratio * m.injectivity_radius * 180 / std::numbers::pi, x[0], x[1], x[2]);
    }
  }
  const double farthest = max_over_ranks(largest);
  return first_text(largest == farthest ? sentence : "");
}

double uniform_norm(const Layout& layout, std::span<const double> mass, std::span<const double> s) {
  double square = 0;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const int dim = layout.fields()[static_cast<std::size_t>(f)].manifold->dim;
    double farthest = 0, weight = 0;
    for (int node : layout.local_nodes(f)) {
      const auto first = static_cast<std::size_t>(layout.first_dof(f, node));
      double here = 0;  // in units of the first component, which need not be those of the others
      for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) here += mass[first + k] / mass[first] * s[first + k] * s[first + k];
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
