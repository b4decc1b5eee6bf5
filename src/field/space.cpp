#include "karcher/field/space.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <string>

#include "karcher/error.hpp"

namespace karcher {
namespace {

/// Values of the geometry's basis at the Lagrange nodes of the space, for one kind and geometry order.
std::vector<std::vector<double>> geometry_values(CellKind kind, int geometry_order, int order) {
  std::vector<std::vector<double>> values;
  for (const Vec3<double>& xi : lagrange_nodes(kind, order)) values.push_back(lagrange(kind, geometry_order, xi).value);
  return values;
}

/// About as many as a large mesh has: order^dim in a cube, dim! times fewer in a simplex.
std::size_t expected_nodes(const Region& region, int order) {
  const Cell& cell = region.cells.front();
  double nodes = static_cast<double>(region.cells.size()) * reference_measure(cell.kind);
  for (int d = 0; d < dimension(cell.kind); ++d) nodes *= order;
  return static_cast<std::size_t>(nodes);
}

}  // namespace

Space::Space(std::shared_ptr<const Mesh> mesh, Region region, int order, Copies copies)
    : mesh_(std::move(mesh)), region_(std::move(region)), order_(order), copies_(copies) {
  if (order < 1 || order > 3) throw InputError("A field has order 1, 2 or 3, not " + std::to_string(order) + ".");
  if (region_.cells.empty()) throw InputError("The region \"" + region_.name + "\" has no cells to carry a field.");
  numbering_ = NodeNumbering(expected_nodes(region_, order));
  cell_nodes_.reserve(region_.cells.size());
  std::map<std::pair<CellKind, int>, std::vector<std::vector<double>>> values;
  for (const Cell& cell : region_.cells) {
    auto& value = values[{cell.kind, cell.order}];
    if (value.empty()) value = geometry_values(cell.kind, cell.order, order);
    std::vector<int>& nodes = cell_nodes_.emplace_back();
    const std::vector<NodeKey> keys = keys_of(cell);
    nodes.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto found = numbering_.insert(keys[i]);
      nodes.push_back(found.number);
      if (!found.inserted) continue;
      Vec3<double> x;
      for (std::size_t j = 0; j < cell.nodes.size(); ++j) x += value[i][j] * mesh_->nodes[static_cast<std::size_t>(cell.nodes[j])];
      positions_.push_back(x);
    }
  }

  around_begin_.assign(positions_.size() + 1, 0);
  const auto for_vertices = [&](auto visit) {
    for (std::size_t c = 0; c < cell_nodes_.size(); ++c)
      for (int v = 0; v < vertex_count(region_.cells[c].kind); ++v)
        visit(static_cast<std::size_t>(cell_nodes_[c][static_cast<std::size_t>(v)]), static_cast<int>(c));
  };
  for_vertices([&](std::size_t node, int) { ++around_begin_[node + 1]; });
  std::partial_sum(around_begin_.begin(), around_begin_.end(), around_begin_.begin());
  around_.resize(static_cast<std::size_t>(around_begin_.back()));
  std::vector<int> next(around_begin_.begin(), around_begin_.end() - 1);
  for_vertices([&](std::size_t node, int cell) { around_[static_cast<std::size_t>(next[node]++)] = cell; });
}

/// Whether the entity is a cell of the region or a part of one. Its vertices alone do not tell: three edges may surround a hole.
bool Space::carries(const Cell& entity, const std::vector<int>& nodes) const {
  const int vertices = vertex_count(entity.kind);
  const auto first = static_cast<std::size_t>(nodes[0]);
  for (int i = around_begin_[first]; i < around_begin_[first + 1]; ++i) {
    const auto c = static_cast<std::size_t>(around_[static_cast<std::size_t>(i)]);
    const CellKind kind = region_.cells[c].kind;
    const auto begin = cell_nodes_[c].begin(), end = begin + vertex_count(kind);
    unsigned local = 0;  // bit set of the cell's vertices that are the entity's
    for (int v = 0; v < vertices; ++v) {
      const auto found = std::find(begin, end, nodes[static_cast<std::size_t>(v)]);
      if (found != end) local |= 1u << (found - begin);
    }
    if (std::popcount(local) != vertices) continue;
    if (vertices == 1 || vertices == vertex_count(kind)) return true;
    for (const auto& e : edges(kind))
      if (local == (1u << e[0] | 1u << e[1])) return true;
    for (const ReferenceFace& f : faces(kind)) {
      unsigned face = 0;
      for (int v : f.vertices) face |= 1u << v;
      if (local == face) return true;
    }
  }
  return false;
}

std::vector<NodeKey> Space::keys_of(const Cell& entity) const {
  return joins_copies() ? joined_lattice_keys(*mesh_, entity, order_) : lattice_keys(entity, order_);
}

std::vector<Vec3<double>> Space::entity_positions(const Cell& entity) const {
  std::vector<Vec3<double>> positions;
  for (const std::vector<double>& value : geometry_values(entity.kind, entity.order, order_)) {
    Vec3<double>& x = positions.emplace_back();
    for (std::size_t j = 0; j < entity.nodes.size(); ++j) x += value[j] * mesh_->nodes[static_cast<std::size_t>(entity.nodes[j])];
  }
  return positions;
}

std::vector<int> Space::entity_nodes(const Cell& entity) const {
  std::vector<int> nodes;
  for (const NodeKey& key : keys_of(entity)) {
    nodes.push_back(numbering_.find(key));
    if (nodes.back() < 0) return {};
  }
  return carries(entity, nodes) ? nodes : std::vector<int>{};
}

}  // namespace karcher
