#include "karcher/problem/enclosure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "karcher/mesh/incidence.hpp"
#include "karcher/mesh/orientation.hpp"
#include "karcher/mesh/place_text.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The facets of a region's cells in which they do not close, each with geometry of order 1.
std::vector<Cell> rim(const Region& region, const Orientation& orientation) {
  struct Facet {
    Cell cell;
    int sum = 0;  ///< of the senses in which cells run through it
  };
  std::map<std::vector<int>, Facet> found;
  for (const Cell& cell : region.cells) {
    int end = -1;  // of a line: the first facet is its start
    for (const ReferenceFace& f : facets(cell.kind)) {
      Cell facet{f.kind, 1, {}, {}};
      for (const int v : f.vertices) facet.nodes.push_back(cell.nodes[at(v)]);
      std::vector<int> key = facet.nodes;
      std::ranges::sort(key);
      const int sense = region.dim == 1 ? std::exchange(end, 1) : facet.nodes == key ? 1 : -1;
      Facet& known = found[key];
      known.cell = std::move(facet);
      known.sum += orientation.sign(cell) * sense;
    }
  }
  std::vector<Cell> open;
  for (auto& entry : found)
    if (entry.second.sum != 0) open.push_back(std::move(entry.second.cell));
  return open;
}

/// What is known of the components of the deformation on the rim, at every load.
class HeldValues {
 public:
  HeldValues(const Discretisation& d, int field) : dim_(d.fields[at(field)].manifold->dim) {
    const auto& phases = d.constraints.phases();
    held_.assign(phases.front().fixed[at(field)].size(), 1);
    for (const Constraints::Phase& phase : phases)
      for (std::size_t k = 0; k < held_.size(); ++k) held_[k] = static_cast<char>(held_[k] && phase.fixed[at(field)][k]);
    Configuration u = d.initial;
    samples_.push_back(u.values[at(field)]);
    for (const Constraints::Phase& phase : phases)
      for (int k = 0; k <= samples_of_a_phase; ++k) {
        d.constraints.apply(phase.begin + (phase.end - phase.begin) * k / samples_of_a_phase, u);
        if (d.constraints.has_values()) samples_.push_back(u.values[at(field)]);
      }
  }
  bool held(int node, int i) const { return held_[index(node, i)] != 0; }
  bool held(const std::vector<int>& nodes, int i) const {
    return std::ranges::all_of(nodes, [&](int n) { return held(n, i); });
  }
  /// Held, and at every load the same for all the nodes.
  bool constant(const std::vector<int>& nodes, int i, double same) const {
    return held(nodes, i) && std::ranges::all_of(samples_, [&](const std::vector<double>& x) {
             return std::ranges::all_of(nodes, [&](int n) { return std::abs(x[index(n, i)] - x[index(nodes[0], i)]) <= same; });
           });
  }
  /// The value where the nodes are held at one that no load changes.
  std::optional<double> still(const std::vector<int>& nodes, int i, double same) const {
    if (!held(nodes, i)) return {};
    const double value = samples_.front()[index(nodes[0], i)];
    for (const std::vector<double>& x : samples_)
      for (const int n : nodes)
        if (std::abs(x[index(n, i)] - value) > same) return {};
    return value;
  }

 private:
  static constexpr int samples_of_a_phase = 7;
  std::size_t index(int node, int i) const { return at(node * dim_ + i); }

  int dim_;
  std::vector<char> held_;
  std::vector<std::vector<double>> samples_;
};

/// Mean of the vertices.
Vec3<double> centre(const std::vector<Cell>& cells, const Space& space, const std::vector<Vec3<double>>& positions) {
  Vec3<double> sum;
  double count = 0;
  for (const Cell& cell : cells) {
    const std::vector<int> nodes = space.entity_nodes(cell);
    for (int v = 0; v < vertex_count(cell.kind); ++v, ++count) sum += positions[at(nodes[at(v)])];
  }
  return (1 / count) * sum;
}

}  // namespace

Enclosure enclosure(const Problem& problem, const TermSpec& term, const Discretisation& d) {
  const int field = term.fields.front();
  const Space& space = *d.fields[at(field)].space;
  const int dim = d.fields[at(field)].manifold->dim;
  const Region& region = d.mesh->region(term.on);
  if (region.dim != dim - 1) return {};  // the term refuses it
  const Orientation orientation(*d.mesh, region);
  if (!orientation.exists())
    refuse(term.on_place, fmt::format("{}: a pressure needs a surface with two sides, of which \"{}\" is none: it has one side only, or three of its "
                                      "cells meet.",
                                      term.path, term.on));
  const std::vector<Cell> pieces = rim(region, orientation);
  const std::vector<Vec3<double>> positions = reference_positions(problem, space);
  Enclosure e;
  e.origin = centre(pieces.empty() ? region.cells : pieces, space, positions);
  const HeldValues values(d, field);
  const double size = diagonal(*d.mesh), same = 1e-9 * size;

  std::vector<int> usable;
  std::optional<Vec3<double>> spoiled;
  for (int i = 0; i < dim; ++i) {
    std::optional<double> origin;
    const auto bad = std::ranges::find_if(pieces, [&](const Cell& piece) {
      const std::vector<int> nodes = space.entity_nodes(piece);
      bool all = true;
      for (int j = 0; j < dim; ++j) {
        if (j == i) continue;
        if (values.constant(nodes, j, same)) return false;
        all = all && values.held(nodes, j);
      }
      if (all) return false;
      const std::optional<double> here = values.still(nodes, i, same);
      if (!here || (origin && std::abs(*origin - *here) > same)) return true;
      origin = here;
      return false;
    });
    if (bad != pieces.end()) {
      spoiled = middle(*d.mesh, *bad);
      continue;
    }
    usable.push_back(i);
    if (origin) e.origin[i] = *origin;
  }
  for (const int i : usable) e.share[i] = 1.0 / static_cast<double>(usable.size());
  if (!usable.empty()) return e;

  const std::string what = dim == 2 ? "end" : "rim";
  const auto force = term.choices.find("force");
  if (force == term.choices.end() || force->second != "true")
    refuse(term.place,
           fmt::format(
               "{}: the pressure on \"{}\" has no potential: its {} can move at {}. The surface must be closed, or its {} clamped, or held in planes "
               "normal to the axes, as by symmetry (docs/models.md); force = true accepts forces along the {} that are no pressure.",
               term.path, term.on, what, place_text(*spoiled, size), what, what));
  for (int i = 0; i < dim; ++i) e.share[i] = 1.0 / dim;
  e.warning = fmt::format(
      "the pressure on \"{}\" has no potential, since its {} can move at {}; force = true takes that of the volume between the surface and the point "
      "o = "
      "{}, which adds {} to the pressure.",
      term.on, what, place_text(*spoiled, size), place_text(e.origin, size),
      dim == 2 ? "the forces value/2 |m - o| at the ends, normal to m - o," : "the forces value/3 (m - o) x dm/ds along the rim");
  return e;
}

}  // namespace karcher
