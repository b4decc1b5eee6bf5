#include "karcher/mesh/refine.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "karcher/mesh/node_key.hpp"
#include "mesh/elevate.hpp"
#include "mesh/lattice.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

using Corners = std::vector<Vec3<double>>;
/// The children of a reference cell by their corners.
using Pattern = std::vector<Corners>;

Vec3<double> middle(CellKind kind, int a, int b) {
  Vec3<double> x;
  for (int i = 0; i < 3; ++i) x[i] = 0.5 * (corners(kind)[at(a)][at(i)] + corners(kind)[at(b)][at(i)]);
  return x;
}

/// Lines, quadrilaterals, hexahedra: a copy of half the size at every corner.
Pattern halves(CellKind kind) {
  Pattern pattern;
  for (int v = 0; v < vertex_count(kind); ++v) {
    Corners& child = pattern.emplace_back();
    for (int w = 0; w < vertex_count(kind); ++w) {
      Vec3<double> x;
      for (int i = 0; i < 3; ++i) x[i] = 0.5 * (corners(kind)[at(v)][at(i)] + corners(kind)[at(w)][at(i)]);
      child.push_back(x);
    }
  }
  return pattern;
}

Pattern triangle_pattern() {
  Pattern pattern = halves(CellKind::triangle);
  const auto m = [](int a, int b) { return middle(CellKind::triangle, a, b); };
  pattern.push_back({m(0, 1), m(1, 2), m(2, 0)});
  return pattern;
}

/// The diagonals of the octahedron inside a tetrahedron join the middles of opposite edges (a, b), (c, d).
constexpr std::array<std::array<int, 4>, 3> diagonals = {{{0, 2, 1, 3}, {0, 1, 2, 3}, {0, 3, 1, 2}}};

Pattern tetrahedron_pattern(std::size_t diagonal) {
  Pattern pattern = halves(CellKind::tetrahedron);
  const auto m = [](int a, int b) { return middle(CellKind::tetrahedron, a, b); };
  const auto& [a, b, c, d] = diagonals[diagonal];
  const std::array<Vec3<double>, 4> equator = {m(a, c), m(a, d), m(b, d), m(b, c)};
  for (std::size_t i = 0; i < 4; ++i) {
    Corners child = {m(a, b), m(c, d), equator[i], equator[(i + 1) % 4]};
    if (dot(cross(child[1] - child[0], child[2] - child[0]), child[3] - child[0]) < 0) std::swap(child[2], child[3]);
    pattern.push_back(std::move(child));
  }
  return pattern;
}

const Pattern& children_of(CellKind kind, std::size_t diagonal) {
  static const std::array<Pattern, 3> tetrahedra = {tetrahedron_pattern(0), tetrahedron_pattern(1), tetrahedron_pattern(2)};
  static const std::array<Pattern, 6> others = {
      halves(CellKind::vertex), halves(CellKind::line), triangle_pattern(), halves(CellKind::quadrilateral), Pattern{}, halves(CellKind::hexahedron)};
  return kind == CellKind::tetrahedron ? tetrahedra[diagonal] : others[at(static_cast<int>(kind))];
}

std::size_t shortest_diagonal(const Mesh& mesh, const Cell& cell) {
  std::size_t best = 0;
  double shortest = 0;
  for (std::size_t i = 0; i < diagonals.size(); ++i) {
    const auto x = [&](std::size_t corner) { return mesh.nodes[at(cell.nodes[at(diagonals[i][corner])])]; };
    const double length2 = norm2(x(0) + x(1) - x(2) - x(3));
    if (i == 0 || length2 < shortest * (1 - 1e-9)) {
      best = i;
      shortest = length2;
    }
  }
  return best;
}

/// Everything about refining cells of one kind and order (and diagonal) that does not depend on the cell.
struct Plan {
  const Pattern* pattern = nullptr;
  std::vector<std::vector<int>> nodes;       ///< [child][node]: index in the parent's lattice of order 2 p
  std::vector<std::vector<double>> weights;  ///< [lattice point]: vertex functions, for parameters
  std::vector<std::vector<double>> values;   ///< [lattice point]: Lagrange functions of order p, for positions
};

Plan make_plan(CellKind kind, int order, std::size_t diagonal) {
  Plan plan;
  plan.pattern = &children_of(kind, diagonal);
  const int q = 2 * order;
  const auto& points = lattice(kind, q);
  for (const Corners& child : *plan.pattern) {
    std::vector<int>& nodes = plan.nodes.emplace_back();
    for (const Vec3<double>& xi : lagrange_nodes(kind, order)) {
      const Vec3<double> x = combine(vertex_functions(kind, xi), child);
      const LatticePoint point = {static_cast<int>(std::lround(q * x[0])), static_cast<int>(std::lround(q * x[1])),
                                  static_cast<int>(std::lround(q * x[2]))};
      nodes.push_back(static_cast<int>(std::find(points.begin(), points.end(), point) - points.begin()));
    }
  }
  for (const LatticePoint& point : points) {
    const Vec3<double> xi{{static_cast<double>(point[0]) / q, static_cast<double>(point[1]) / q, static_cast<double>(point[2]) / q}};
    plan.weights.push_back(vertex_functions(kind, point, q));
    plan.values.push_back(lagrange(kind, order, xi).value);
    for (double& value : plan.values.back())  // functions that vanish on a face must not leak across it by rounding
      if (std::abs(value) < 1e-14) value = 0;
  }
  return plan;
}

/// sum_i N_i x_i
Vec3<double> interpolate(const Mesh& mesh, const Cell& cell, const std::vector<double>& values) {
  std::vector<Vec3<double>> x;
  x.reserve(cell.nodes.size());
  for (int n : cell.nodes) x.push_back(mesh.nodes[at(n)]);
  return combine(values, x);
}

class Refiner {
 public:
  explicit Refiner(const Mesh& coarse) : coarse_(coarse), numbering_(4 * coarse.nodes.size()) {
    fine_.dim = coarse.dim;
    fine_.parametrisation = coarse.parametrisation;
    fine_.left_out = coarse.left_out;
    fine_.warnings = coarse.warnings;
  }

  std::vector<Cell> cells(const std::vector<Cell>& parents, std::vector<Child>& children) {
    std::vector<Cell> result;
    for (std::size_t c = 0; c < parents.size(); ++c) {
      const Cell& parent = parents[c];
      const Plan& plan = plan_for(parent);
      const std::vector<int> numbers = lattice_numbers(parent, plan);
      for (std::size_t k = 0; k < plan.nodes.size(); ++k) {
        const Corners& child_corners = (*plan.pattern)[k];
        Cell& child = result.emplace_back();
        child.kind = parent.kind;
        child.order = parent.order;
        child.nodes.reserve(plan.nodes[k].size());
        for (int n : plan.nodes[k]) child.nodes.push_back(numbers[at(n)]);
        if (!parent.parameters.empty())
          for (const Vec3<double>& xi : child_corners) child.parameters.push_back(combine(vertex_functions(parent.kind, xi), parent.parameters));
        children.push_back({static_cast<int>(c), &child_corners});
      }
    }
    return result;
  }

  Mesh& fine() { return fine_; }

 private:
  const Plan& plan_for(const Cell& cell) {
    const std::size_t diagonal = cell.kind == CellKind::tetrahedron ? shortest_diagonal(coarse_, cell) : 0;
    const auto key = std::tuple(cell.kind, cell.order, diagonal);
    const auto it = plans_.find(key);
    return it != plans_.end() ? it->second : plans_.emplace(key, make_plan(cell.kind, cell.order, diagonal)).first->second;
  }

  std::vector<int> lattice_numbers(const Cell& cell, const Plan& plan) {
    std::vector<int> numbers;
    const bool exact = coarse_.parametrisation && !cell.parameters.empty();
    const std::vector<NodeKey> keys = lattice_keys(cell, 2 * cell.order);
    const bool periodic = !coarse_.first_copies.empty();
    const std::vector<NodeKey> joined = periodic ? joined_lattice_keys(coarse_, cell, 2 * cell.order) : std::vector<NodeKey>();
    numbers.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto found = numbering_.insert(keys[i]);
      numbers.push_back(found.number);
      if (!found.inserted) continue;
      if (periodic) {
        const auto first = joined_.insert(joined[i]);
        if (first.inserted) first_copies_.push_back(found.number);
        fine_.first_copies.push_back(first_copies_[at(first.number)]);
      }
      const bool vertex = i < at(vertex_count(cell.kind));
      if (exact && !vertex)
        fine_.nodes.push_back(coarse_.parametrisation(combine(plan.weights[i], cell.parameters)));
      else
        fine_.nodes.push_back(interpolate(coarse_, cell, plan.values[i]));
    }
    return numbers;
  }

  const Mesh& coarse_;
  Mesh fine_;
  NodeNumbering numbering_, joined_;
  std::vector<int> first_copies_;  ///< of every number of joined_
  std::map<std::tuple<CellKind, int, std::size_t>, Plan> plans_;
};

}  // namespace

Refinement refine(const Mesh& mesh) {
  Refinement result;
  Refiner refiner(mesh);
  refiner.fine().cells = refiner.cells(mesh.cells, result.children["all"]);
  for (const auto& [name, region] : mesh.regions) {
    if (name == "all") continue;
    refiner.fine().regions[name] = {name, region.dim, refiner.cells(region.cells, result.children[name])};
  }
  result.mesh = std::move(refiner.fine());
  result.mesh.regions["all"] = {"all", result.mesh.dim, result.mesh.cells};
  return result;
}

Vec3<double> in_parent(const Child& child, CellKind kind, const Vec3<double>& xi) { return combine(vertex_functions(kind, xi), *child.corners); }

}  // namespace karcher
