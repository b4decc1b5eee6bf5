#include "karcher/problem/start_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "karcher/error.hpp"
#include "karcher/interpolation/evaluate.hpp"
#include "karcher/io/vtu.hpp"
#include "karcher/mesh/locate.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/text.hpp"

namespace karcher {
namespace {

std::string text_of(const Vec3<double>& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]); }

const OutputArray* array_of(const OutputPart& part, const std::string& name) {
  const auto found = std::ranges::find(part.point_data, name, &OutputArray::name);
  return found == part.point_data.end() ? nullptr : &*found;
}

/// The first part of a state that has the field: the largest one.
OutputPart find_part(const StartSpec& start) {
  const std::filesystem::path collection = start.results / "solution.pvd";
  if (!std::filesystem::exists(collection))
    throw InputError(fmt::format("there are no states in {} (no solution.pvd; runs with output.vtu = false write none).", start.results.string()));
  const std::vector<VtuEntry> entries = read_collection(collection);
  std::set<int> states;
  for (const VtuEntry& e : entries) states.insert(e.state);
  if (states.empty()) throw InputError(fmt::format("there are no states in {}.", collection.string()));
  const int step = start.step.value_or(*states.rbegin());
  if (!states.contains(step)) {
    std::vector<std::string> known;
    for (const int s : states) known.push_back(std::to_string(s));
    throw InputError(fmt::format("{} has no step {}; it has {}.", start.results.string(), step, join_names(known)));
  }
  std::vector<std::string> names;
  for (const VtuEntry& e : entries) {
    if (e.state != step) continue;
    OutputPart part = read_vtu(start.results / std::filesystem::path(e.file).filename());
    if (array_of(part, start.field)) return part;
    for (const OutputArray& a : part.point_data) names.push_back(a.name);
  }
  throw InputError(fmt::format("step {} of {} has no \"{}\". {}", step, start.results.string(), start.field, suggestion(start.field, names)));
}

/// The mesh of a part in the stress-free configuration; its nodes are those of the part.
Mesh mesh_of(const OutputPart& part) {
  Mesh mesh;
  mesh.dim = part.dim;
  mesh.nodes = part.points;
  if (const OutputArray* reference = array_of(part, "reference"); reference && reference->components == 3)
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      mesh.nodes[n] = {{reference->values[3 * n], reference->values[3 * n + 1], reference->values[3 * n + 2]}};
  for (const OutputCell& c : part.cells) mesh.cells.push_back({c.kind, part.order, c.nodes, {}});
  mesh.regions["all"] = {"all", part.dim, mesh.cells};
  return mesh;
}

/// A field of earlier results.
class EarlierField {
 public:
  EarlierField(const OutputPart& part, const StartSpec& start, const FieldSpec& field)
      : start_(start), field_(field), values_(array_of(part, start.field)->values), mesh_(mesh_of(part)), locator_(mesh_, mesh_.region("all")) {
    const int components = array_of(part, start.field)->components, wanted = field.manifold->ambient;
    if (components != wanted)
      throw InputError(fmt::format("the field \"{}\" of {} has {} components, points of {} have {}.", start.field, start.results.string(), components,
                                   field.manifold->name, wanted));
    for (const Cell& c : mesh_.cells) middles_.push_back(middle(mesh_, c));
  }

  /// \param near  a place in the node's own cell
  void value_at(const Vec3<double>& x, const Vec3<double>& near, double* value) const {
    const std::vector<Location> places = locator_.all_nearest(x);
    const auto best = std::ranges::min_element(places, {}, [&](const Location& l) { return norm2(middles_[at(l.cell)] - near); });
    if (best == places.end() || best->distance > 0.1 * best->cell_diameter)
      throw InputError(fmt::format("the node at {} lies outside the mesh of {}{}.", text_of(x), start_.results.string(),
                                   best == places.end() ? "" : fmt::format(", at a distance of {:.3g}", best->distance)));
    const Cell& cell = mesh_.cells[at(best->cell)];
    const std::vector<double> weights = lagrange(cell.kind, cell.order, best->xi).value;
    const auto ambient = static_cast<std::size_t>(field_.manifold->ambient);
    if (const auto own = std::ranges::find_if(weights, [](double w) { return std::abs(w - 1) < 1e-9; }); own != weights.end()) {
      const std::size_t node = at(cell.nodes[static_cast<std::size_t>(own - weights.begin())]);
      std::copy_n(values_.data() + node * ambient, ambient, value);
    } else {
      std::vector<double> nodes;
      for (const int n : cell.nodes) nodes.insert(nodes.end(), values_.data() + at(n) * ambient, values_.data() + (at(n) + 1) * ambient);
      const FieldAtPoint found = evaluate_field(*field_.manifold, field_.rule, nodes, weights);
      if (!found.defined)
        throw InputError(
            fmt::format("the values of \"{}\" in {} are too far apart at {} to be interpolated.", start_.field, start_.results.string(), text_of(x)));
      std::ranges::copy(found.value, value);
    }
    require_point(value, x);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  void require_point(const double* value, const Vec3<double>& x) const {
    const auto ambient = static_cast<std::size_t>(field_.manifold->ambient);
    std::vector<double> point(ambient);
    bool good = field_.manifold->make_point(value, point.data());
    for (std::size_t i = 0; i < ambient && good; ++i) good = std::abs(point[i] - value[i]) <= 1e-9 * (1 + std::abs(value[i]));
    if (!good)
      throw InputError(fmt::format("the value of \"{}\" in {} at {} is no point of {}.", start_.field, start_.results.string(), text_of(x),
                                   field_.manifold->name));
  }

  const StartSpec& start_;
  const FieldSpec& field_;
  std::vector<double> values_;
  Mesh mesh_;
  Locator locator_;
  std::vector<Vec3<double>> middles_;
};

}  // namespace

std::vector<double> start_values(const Problem& problem, const FieldSpec& field, const StartSpec& start, const Space& space) {
  const auto ambient = static_cast<std::size_t>(field.manifold->ambient);
  std::vector<double> values(static_cast<std::size_t>(space.node_count()) * ambient);
  at_place(start.place, [&] {
    const EarlierField earlier(find_part(start), start, field);
    const std::vector<Vec3<double>> positions = reference_positions(problem, space);
    std::vector<char> known(positions.size(), 0);
    for (std::size_t c = 0; c < space.region().cells.size(); ++c) {
      const std::vector<int>& nodes = space.cell_nodes(static_cast<int>(c));
      const auto corners = static_cast<std::size_t>(vertex_count(space.region().cells[c].kind));
      Vec3<double> near;
      for (std::size_t i = 0; i < corners; ++i) near += (1.0 / static_cast<double>(corners)) * positions[static_cast<std::size_t>(nodes[i])];
      for (const int node : nodes) {
        const auto n = static_cast<std::size_t>(node);
        if (!known[n]) earlier.value_at(positions[n], near, values.data() + n * ambient);
        known[n] = 1;
      }
    }
  });
  return values;
}

}  // namespace karcher
