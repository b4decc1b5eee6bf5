#include "karcher/problem/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "karcher/mesh/place_text.hpp"
#include "karcher/problem/carried_parts.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/problem/mesh_points.hpp"

namespace karcher {
namespace {

struct NodeAtPlace {
  int node = 0;
  Vec3<double> place;
};

/// Nodes of the field on the entities of a region and on their edges and vertices, ascending. Where copies of a node are joined, one entry for every copy in the region.
std::vector<NodeAtPlace> nodes_on(const Space& space, const Region& region) {
  std::map<int, std::vector<Vec3<double>>> found;
  for (const Cell& c : carried_parts(space, region)) {
    const std::vector<int> nodes = space.entity_nodes(c);
    const std::vector<Vec3<double>> places = space.joins_copies() ? space.entity_positions(c) : std::vector<Vec3<double>>();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<Vec3<double>>& known = found[nodes[i]];
      const Vec3<double>& x = places.empty() ? space.position(nodes[i]) : places[i];
      const auto same = [&](const Vec3<double>& y) { return norm2(x - y) <= 1e-20 * (1 + norm2(x)); };
      if (places.empty() ? known.empty() : std::ranges::none_of(known, same)) known.push_back(x);
    }
  }
  std::vector<NodeAtPlace> list;
  for (const auto& [node, places] : found)
    for (const Vec3<double>& x : places) list.push_back({node, x});
  return list;
}

std::string point_text(const double* p, int n) {
  std::string s;
  for (int i = 0; i < n; ++i) s += fmt::format("{}{}", i ? ", " : "", p[i]);
  return n == 1 ? s : "(" + s + ")";
}

char axis_name(int axis) { return static_cast<char>('x' + axis); }

/// A mirror plane or a diaphragm is one: all nodes have the same coordinate along its normal in the stress-free configuration.
void require_plane(const DirichletSpec& spec, const std::vector<NodeAtPlace>& nodes, const std::vector<Vec3<double>>& positions) {
  Vec3<double> lower = positions.front(), upper = lower;
  for (const Vec3<double>& x : positions)
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], x[i]);
      upper[i] = std::max(upper[i], x[i]);
    }
  const double size = std::sqrt(norm2(upper - lower));
  const Vec3<double>& first = positions[static_cast<std::size_t>(nodes.front().node)];
  for (const NodeAtPlace& n : nodes) {
    const Vec3<double>& x = positions[static_cast<std::size_t>(n.node)];
    if (std::abs(x[spec.normal] - first[spec.normal]) <= 1e-6 * size) continue;
    refuse(spec.on_place, fmt::format("{}: the region \"{}\" lies in no plane normal to {}: it has nodes at {} and {}.", spec.path, spec.on,
                                      axis_name(spec.normal), place_text(first, size), place_text(x, size)));
  }
}

/// The components that leave points of a manifold with body axes free to turn about an axis of space and no other. exp(s e) Q has the body axis Q^T e for all s, so
/// one component does it exactly where that is one of the body's three axes.
std::vector<DirichletSpec::Component> turning_about(const DirichletSpec& spec, const Field& field, const double* point, const Vec3<double>& place) {
  using Component = DirichletSpec::Component;
  for (std::size_t k = 0; k < field.manifold->arrays.size(); ++k) {
    std::array<double, 3> d{};
    field.manifold->arrays[k].value(point, d.data());
    d[static_cast<std::size_t>(spec.normal)] = 0;
    if (std::hypot(d[0], d[1], d[2]) > 1e-9) continue;
    std::vector<Component> components(3, Component::initial);
    components[k] = Component::free;
    return components;
  }
  refuse(spec.place,
         fmt::format("{}: the field \"{}\" can be left free to turn about {} alone only where one of the axes of its initial rotation lies along {}; "
                     "that is not so at {}.",
                     spec.path, field.name, axis_name(spec.normal), axis_name(spec.normal), place_text(place, 1)));
}

/// The components that leave a direction of space free to turn in the mirror plane in which it lies, and no other: where the tangent coordinates at the point have one along
/// the normal of the plane, that one is held.
std::vector<DirichletSpec::Component> staying_in_plane(const DirichletSpec& spec, const Field& field, const double* point,
                                                       const Vec3<double>& place) {
  using Component = DirichletSpec::Component;
  constexpr double step = 1e-4;
  const auto axis = static_cast<std::size_t>(spec.normal);
  const ManifoldOps& m = *field.manifold;
  if (std::abs(point[axis]) > 1e-9)
    refuse(spec.place,
           fmt::format(
               "{}: the initial value of the field \"{}\" must lie in the plane of symmetry, normal to {}; at {} it is ({:.6g}, {:.6g}, {:.6g}).",
               spec.path, field.name, axis_name(spec.normal), place_text(place, 1), point[0], point[1], point[2]));
  std::vector<Component> components(static_cast<std::size_t>(m.dim), Component::free);
  for (std::size_t k = 0; k < components.size(); ++k) {
    std::vector<double> v(components.size(), 0.0), moved(static_cast<std::size_t>(m.ambient));
    v[k] = step;
    m.retract(point, v.data(), moved.data());
    if (std::abs(moved[axis] - point[axis]) < (1 - 1e-6) * step) continue;
    components[k] = Component::initial;
    return components;
  }
  refuse(spec.place,
         fmt::format("{}: the field \"{}\" cannot be held in a plane normal to {} at {}; turn the body, so that the plane is normal to x or y.",
                     spec.path, field.name, axis_name(spec.normal), place_text(place, 1)));
}

}  // namespace

bool Constraints::holds(const DirichletSpec& spec, const Phase& phase) const {
  return spec.from <= phase.begin + same_ && spec.to >= phase.end - same_;
}

std::size_t Constraints::phase(double t) const {
  const auto ends = std::ranges::find_if(phases_, [&](const Phase& p) { return t <= p.end + same_; });
  return ends == phases_.end() ? phases_.size() - 1 : static_cast<std::size_t>(ends - phases_.begin());
}

/// Cuts the load range where an entry sets in or ends.
void Constraints::find_phases(const Problem& problem) {
  const double first = problem.continuation.from, last = problem.continuation.to;
  same_ = 1e-9 * std::abs(last - first);
  std::vector<double> cuts;
  for (const DirichletSpec& spec : specs_) {
    if (!std::isfinite(spec.from) && !std::isfinite(spec.to)) continue;
    const auto wrong = [&](const std::string& sentence) { refuse(spec.place, spec.path + ": " + sentence); };
    if (!(last > first))
      wrong("a condition that holds for some load steps only needs a load parameter that grows: continuation.from < continuation.to.");
    if (!(spec.from < spec.to)) wrong(fmt::format("it holds where {} < t <= {}, which is nowhere.", spec.from, spec.to));
    if (spec.from >= last - same_ || spec.to <= first + same_)
      wrong(fmt::format("it holds where {} < t <= {}, but the load steps end at values of t from {} to {}.", spec.from, spec.to, first, last));
    for (const double cut : {spec.from, spec.to})
      if (cut > first + same_ && cut < last - same_) cuts.push_back(cut);
  }
  std::ranges::sort(cuts);
  double begin = first;
  for (const double cut : cuts)
    if (cut > begin + same_) {
      phases_.push_back({begin, cut, {}});
      begin = cut;
    }
  phases_.push_back({begin, last, {}});
}

/// The point that an entry wants at a node, at t; components that it leaves alone are those of u.
std::vector<double> Constraints::wanted(const NodeValue& v, double t, const Configuration& u) const {
  const int ambient = ambient_[static_cast<std::size_t>(v.field)];
  const double* from = u.at(v.field, v.node, ambient);
  std::vector<double> p(from, from + ambient);
  write(v, t, p.data());
  return p;
}

void Constraints::write(const NodeValue& v, double t, double* point) const {
  const DirichletSpec& spec = specs_[static_cast<std::size_t>(v.spec)];
  if (v.initial.size() == spec.components.size()) {
    for (std::size_t i = 0; i < v.initial.size(); ++i)
      if (spec.components[i] == DirichletSpec::Component::initial) point[i] = v.initial[i];
  } else if (!v.initial.empty()) {
    std::ranges::copy(v.initial, point);
  }
  if (spec.value) spec.value.value(v.place, t, point);
}

Constraints::Constraints(const Problem& problem, std::span<const Field> fields, const Configuration& initial) : specs_(problem.dirichlet) {
  using Component = DirichletSpec::Component;
  find_phases(problem);
  for (const Field& f : fields) ambient_.push_back(f.manifold->ambient);

  struct Held {
    NodeValue value;
    std::vector<Component> components;
  };
  std::vector<std::vector<Held>> held;  // by entry
  for (std::size_t k = 0; k < specs_.size(); ++k) {
    const DirichletSpec& spec = specs_[k];
    const Field& f = fields[static_cast<std::size_t>(spec.field)];
    const Region& region = at_place(spec.on_place, [&]() -> const Region& { return f.space->mesh().region(spec.on); });
    const std::vector<NodeAtPlace> nodes = nodes_on(*f.space, region);
    if (nodes.empty() && spec.may_be_absent) {
      held.emplace_back();
      continue;
    }
    if (nodes.empty())
      refuse(spec.on_place, fmt::format("{}: the field \"{}\" lives on \"{}\" and has no node on the region \"{}\".", spec.path, f.name,
                                        f.space->region().name, spec.on));
    if (spec.normal >= 0) require_plane(spec, nodes, reference_positions(problem, *f.space));
    const std::vector<MeshPoint> places = spec.value.asks_for_normal ? mesh_points(*f.space, true) : std::vector<MeshPoint>();
    const bool back = spec.from > problem.continuation.from && std::ranges::find(spec.components, Component::initial) != spec.components.end();
    const bool whole = std::ranges::all_of(spec.components, [](Component c) { return c == Component::initial; });
    const bool kept = problem.fields[static_cast<std::size_t>(spec.field)].start && holds(spec, phases_.front()) &&
                      (f.manifold->linear ? std::ranges::find(spec.components, Component::initial) != spec.components.end() : whole);
    std::vector<Held>& list = held.emplace_back();
    for (const auto& [node, place] : nodes) {
      const double* point = initial.at(spec.field, node, f.manifold->ambient);
      NodeValue value{static_cast<int>(k), spec.field, node, {place, {}}, {}};
      if (!places.empty()) value.place.normal = places[static_cast<std::size_t>(node)].normal;
      if (back) value.initial.assign(point, point + f.manifold->ambient);
      list.push_back({value, spec.normal < 0          ? spec.components
                             : f.manifold->body_axes  ? turning_about(spec, f, point, place)
                             : f.manifold->directions ? staying_in_plane(spec, f, point, place)
                                                      : spec.components});
      if (spec.value || back) values_.push_back(value);
      if (!kept) continue;
      kept_.push_back(value);
      kept_.back().initial.assign(point, point + f.manifold->ambient);
    }
  }

  for (Phase& phase : phases_) {
    std::vector<std::vector<const Held*>> owners;
    for (const Field& f : fields) {
      const auto size = static_cast<std::size_t>(f.space->node_count() * f.manifold->dim);
      phase.fixed.emplace_back(size, 0);
      owners.emplace_back(size, nullptr);
    }
    for (std::size_t k = 0; k < specs_.size(); ++k) {
      const DirichletSpec& spec = specs_[k];
      if (!holds(spec, phase)) continue;
      const Field& f = fields[static_cast<std::size_t>(spec.field)];
      const auto field = static_cast<std::size_t>(spec.field);
      for (const Held& h : held[k])
        for (std::size_t i = 0; i < h.components.size(); ++i) {
          if (h.components[i] == Component::free) continue;
          const std::size_t dof = static_cast<std::size_t>(h.value.node) * h.components.size() + i;
          const Held*& owner = owners[field][dof];
          if (owner) {
            if (h.components[i] == Component::current) continue;
            for (const double t : {phase.begin, phase.end}) {
              if (owner->components[i] == Component::current) break;
              const std::vector<double> a = wanted(owner->value, t, initial), b = wanted(h.value, t, initial);
              const double distance = f.manifold->linear ? std::abs(a[i] - b[i]) : f.manifold->dist(a.data(), b.data());
              const double size = f.manifold->linear ? 1 + std::abs(a[i]) : 1.0;
              if (distance <= 1e-9 * size) continue;
              const DirichletSpec& other = specs_[static_cast<std::size_t>(owner->value.spec)];
              const Vec3<double>&x = h.value.place.x, &y = owner->value.place.x;
              const int n = f.manifold->linear ? 1 : f.manifold->ambient;
              const std::size_t first = n == 1 ? i : 0;
              if (&other == &spec)
                refuse(spec.place,
                       fmt::format(
                           "{} gives the field \"{}\" different values at ({}, {}, {}) and ({}, {}, {}), which are one node of the periodic mesh, "
                           "t = {}: {} and {}.",
                           spec.path, f.name, y[0], y[1], y[2], x[0], x[1], x[2], t, point_text(&a[first], n), point_text(&b[first], n)));
              refuse(spec.place,
                     fmt::format("{} and {} ({}) give the field \"{}\" different values at ({}, {}, {}), t = {}: {} and {}.", spec.path, other.path,
                                 other.place.text(), f.name, x[0], x[1], x[2], t, point_text(&b[first], n), point_text(&a[first], n)));
            }
            if (h.components[i] == Component::initial) continue;
          }
          owner = &h;
          phase.fixed[field][dof] = 1;
        }
    }
    // What cannot be evaluated is told before anything is done.
    for (const NodeValue& v : values_)
      if (holds(specs_[static_cast<std::size_t>(v.spec)], phase))
        for (const double t : {phase.begin, phase.end}) wanted(v, t, initial);
  }
}

void Constraints::apply(double t, Configuration& u) const {
  const Phase& now = phases_[phase(t)];
  for (const NodeValue& v : values_)
    if (holds(specs_[static_cast<std::size_t>(v.spec)], now)) write(v, t, u.at(v.field, v.node, ambient_[static_cast<std::size_t>(v.field)]));
}

void Constraints::restore(Configuration& u) const {
  for (const NodeValue& v : kept_) write(v, u.t, u.at(v.field, v.node, ambient_[static_cast<std::size_t>(v.field)]));
}

}  // namespace karcher
