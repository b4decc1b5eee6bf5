#include "karcher/mesh/node_key.hpp"

#include <algorithm>
#include <cassert>

#include "mesh/lattice.hpp"

namespace karcher {
namespace {

std::uint64_t hash(const NodeKey& key) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  const auto mix = [&](std::uint64_t word) {
    h ^= word;
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  };
  const auto pair = [](int a, int b) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b); };
  for (std::size_t i = 0; i < 8 && key.vertices[i] >= 0; i += 2) mix(pair(key.vertices[i], key.vertices[i + 1]));
  mix(pair(key.place[0], key.place[1] + 64 * key.place[2]));
  return h;
}

/// Vertices ascending, with the barycentric coordinates that belong to them.
NodeKey simplex_key(std::span<const int> vertices, const LatticePoint& point, int q) {
  struct Corner {
    int vertex, weight;
  };
  std::array<Corner, 4> corner{};
  const std::size_t n = vertices.size();
  corner[0] = {vertices[0], q};
  for (std::size_t v = 1; v < n; ++v) {
    corner[v] = {vertices[v], point[v - 1]};
    corner[0].weight -= point[v - 1];
  }
  std::sort(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(n), [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
  NodeKey key;
  for (std::size_t v = 0; v < n; ++v) {
    key.vertices[v] = corner[v].vertex;
    if (v > 0) key.place[v - 1] = corner[v].weight * (NodeKey::denominator / q);
  }
  return key;
}

/// Distances from the lowest vertex along its edges, the axes ordered by the vertices at their ends.
NodeKey cube_key(CellKind kind, std::span<const int> vertices, const LatticePoint& point, int q) {
  const auto& corner = corners(kind);
  const auto origin = static_cast<std::size_t>(std::min_element(vertices.begin(), vertices.end()) - vertices.begin());
  struct Axis {
    int end, distance;
  };
  std::array<Axis, 3> axis{};
  const auto dim = static_cast<std::size_t>(dimension(kind));
  for (std::size_t a = 0; a < dim; ++a) {
    LatticePoint other = corner[origin];
    other[a] = 1 - other[a];
    const auto end = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), other) - corner.begin());
    axis[a] = {vertices[end], corner[origin][a] == 0 ? point[a] : q - point[a]};
  }
  std::sort(axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(dim), [](const Axis& a, const Axis& b) { return a.end < b.end; });
  NodeKey key = entity_key(vertices);
  for (std::size_t a = 0; a < dim; ++a) key.place[a] = axis[a].distance * (NodeKey::denominator / q);
  return key;
}

}  // namespace

std::vector<NodeKey> lattice_keys(const Cell& cell, int q) {
  assert(NodeKey::denominator % q == 0);
  const auto& places = lattice_places(cell.kind, q);
  std::vector<NodeKey> keys;
  keys.reserve(places.size());
  for (const LatticePlace& place : places) {
    std::array<int, 8> vertices;
    const auto n = static_cast<std::size_t>(vertex_count(place.entity));
    for (std::size_t v = 0; v < n; ++v) vertices[v] = cell.nodes[static_cast<std::size_t>(place.vertices[v])];
    const std::span<const int> used(vertices.data(), n);
    switch (place.entity) {
      case CellKind::vertex:
        keys.emplace_back().vertices[0] = vertices[0];
        break;
      case CellKind::line:
      case CellKind::triangle:
      case CellKind::tetrahedron:
        keys.push_back(simplex_key(used, place.point, q));
        break;
      case CellKind::quadrilateral:
      case CellKind::hexahedron:
        keys.push_back(cube_key(place.entity, used, place.point, q));
        break;
    }
  }
  return keys;
}

std::vector<NodeKey> joined_lattice_keys(const Mesh& mesh, const Cell& cell, int q) {
  if (mesh.first_copies.empty()) return lattice_keys(cell, q);
  Cell first;
  first.kind = cell.kind;
  for (int v = 0; v < vertex_count(cell.kind); ++v)
    first.nodes.push_back(mesh.first_copies[static_cast<std::size_t>(cell.nodes[static_cast<std::size_t>(v)])]);
  return lattice_keys(first, q);
}

NodeKey entity_key(std::span<const int> vertices) {
  NodeKey key;
  for (std::size_t v = 0; v < vertices.size(); ++v) {  // insertion sort
    std::size_t at = v;
    for (; at > 0 && key.vertices[at - 1] > vertices[v]; --at) key.vertices[at] = key.vertices[at - 1];
    key.vertices[at] = vertices[v];
  }
  return key;
}

NodeNumbering::NodeNumbering(std::size_t expected) {
  keys_.reserve(expected);
  std::size_t slots = 64;
  while (slots < 2 * expected) slots *= 2;
  slots_.assign(slots, -1);
}

std::size_t NodeNumbering::slot_of(const NodeKey& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(key) & mask;
  while (slots_[slot] >= 0 && keys_[static_cast<std::size_t>(slots_[slot])] != key) slot = (slot + 1) & mask;
  return slot;
}

void NodeNumbering::grow(std::size_t slots) {
  slots_.assign(slots, -1);
  for (std::size_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = static_cast<int>(i);
}

NodeNumbering::Found NodeNumbering::insert(const NodeKey& key) {
  std::size_t slot = slot_of(key);
  if (slots_[slot] >= 0) return {slots_[slot], false};
  const int number = static_cast<int>(keys_.size());
  keys_.push_back(key);
  slots_[slot] = number;
  if (2 * keys_.size() > slots_.size()) grow(2 * slots_.size());
  return {number, true};
}

int NodeNumbering::find(const NodeKey& key) const { return slots_[slot_of(key)]; }

}  // namespace karcher
