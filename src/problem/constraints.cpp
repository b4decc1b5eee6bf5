#include "karcher/problem/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "karcher/problem/mesh_points.hpp"

namespace karcher {
namespace {

/// Nodes of the field on the entities of a region, ascending.
std::vector<int> nodes_on(const Space& space, const Region& region) {
  std::set<int> nodes;
  for (const Cell& c : region.cells)
    for (const int n : space.entity_nodes(c)) nodes.insert(n);
  return {nodes.begin(), nodes.end()};
}

std::string point_text(const double* p, int n) {
  std::string s;
  for (int i = 0; i < n; ++i) s += fmt::format("{}{}", i ? ", " : "", p[i]);
  return n == 1 ? s : "(" + s + ")";
}

}  // namespace

Constraints::Constraints(const Problem& problem, std::span<const Field> fields, const Configuration& initial) : specs_(problem.dirichlet) {
  struct Owner {
    int spec = -1;
  };
  std::vector<std::vector<Owner>> owners;
  for (const Field& f : fields) {
    const auto size = static_cast<std::size_t>(f.space->node_count() * f.manifold->dim);
    fixed_.emplace_back(size, 0);
    owners.emplace_back(size);
    ambient_.push_back(f.manifold->ambient);
  }

  // The point that spec k wants at a node, at t; components that it leaves alone keep the initial values.
  const auto wanted = [&](int k, int field, const MeshPoint& place, int node, double t) {
    const DirichletSpec& spec = specs_[static_cast<std::size_t>(k)];
    const int ambient = fields[static_cast<std::size_t>(field)].manifold->ambient;
    const double* from = initial.at(field, node, ambient);
    std::vector<double> p(from, from + ambient);
    if (spec.value) spec.value.value(place, t, p.data());
    return p;
  };

  for (std::size_t k = 0; k < specs_.size(); ++k) {
    const DirichletSpec& spec = specs_[k];
    const Field& f = fields[static_cast<std::size_t>(spec.field)];
    const auto field = static_cast<std::size_t>(spec.field);
    const Region& region = at_place(spec.on_place, [&]() -> const Region& { return f.space->mesh().region(spec.on); });
    const std::vector<int> nodes = nodes_on(*f.space, region);
    if (nodes.empty())
      refuse(spec.on_place, fmt::format("{}: the field \"{}\" lives on \"{}\" and has no node on the region \"{}\".", spec.path, f.name,
                                        f.space->region().name, spec.on));
    const std::vector<MeshPoint> places = spec.value ? mesh_points(*f.space, spec.value.asks_for_normal) : std::vector<MeshPoint>();
    for (const int node : nodes) {
      const MeshPoint place = places.empty() ? MeshPoint{f.space->position(node), {}} : places[static_cast<std::size_t>(node)];
      for (std::size_t i = 0; i < spec.components.size(); ++i) {
        if (spec.components[i] == DirichletSpec::Component::free) continue;
        const std::size_t dof = static_cast<std::size_t>(node) * spec.components.size() + i;
        Owner& owner = owners[field][dof];
        if (owner.spec >= 0) {
          for (const double t : {problem.continuation.from, problem.continuation.to}) {
            const std::vector<double> a = wanted(owner.spec, spec.field, place, node, t), b = wanted(static_cast<int>(k), spec.field, place, node, t);
            const double distance = f.manifold->linear ? std::abs(a[i] - b[i]) : f.manifold->dist(a.data(), b.data());
            const double size = f.manifold->linear ? 1 + std::abs(a[i]) : 1.0;
            if (distance <= 1e-9 * size) continue;
            const DirichletSpec& other = specs_[static_cast<std::size_t>(owner.spec)];
            const Vec3<double>& x = f.space->position(node);
            const int n = f.manifold->linear ? 1 : f.manifold->ambient;
            const std::size_t first = n == 1 ? i : 0;
            refuse(spec.place,
                   fmt::format("{} and {} ({}) give the field \"{}\" different values at ({}, {}, {}), t = {}: {} and {}.", spec.path, other.path,
                               other.place.text(), f.name, x[0], x[1], x[2], t, point_text(&b[first], n), point_text(&a[first], n)));
          }
          if (spec.components[i] == DirichletSpec::Component::initial) continue;
        }
        owner.spec = static_cast<int>(k);
        fixed_[field][dof] = 1;
      }
      if (spec.value) values_.push_back({static_cast<int>(k), spec.field, node, place});
    }
  }
  // What cannot be evaluated is told before anything is done.
  Configuration scratch = initial;
  for (const double t : {problem.continuation.from, problem.continuation.to}) apply(t, scratch);
}

void Constraints::apply(double t, Configuration& u) const {
  for (const NodeValue& v : values_)
    specs_[static_cast<std::size_t>(v.spec)].value.value(v.place, t, u.at(v.field, v.node, ambient_[static_cast<std::size_t>(v.field)]));
}

}  // namespace karcher
