#pragma once
/// \file
/// The identity of a place of a mesh that does not depend on the cell through which it is seen, and a numbering of such places.
///
/// Spaces use it for their nodes, refinement and generators for geometry nodes, so that all of them agree where cells touch, whatever their
/// orientation.

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Identity of a Lagrange node, equal for spaces of different regions (and orders, where the places coincide) of one mesh: the vertices of the
/// smallest entity that holds it, ascending, and its place there in twelfths, in a canonical orientation of the entity. On simplices: the
/// barycentric coordinates of the second, third, ... vertex in ascending order. On quadrilaterals and hexahedra: the distances from the vertex of
/// lowest number along the edges to its neighbours, these in ascending order.
struct NodeKey {
  static constexpr int denominator = 12;
  std::array<int, 8> vertices{-1, -1, -1, -1, -1, -1, -1, -1};
  std::array<int, 3> place{0, 0, 0};
  auto operator<=>(const NodeKey&) const = default;
};

/// Keys of all points of the lattice of order q on a cell, in the order of lagrange_nodes (q = 1, 2, 3; also 4, 6 with face and cell interiors x
/// fastest).
std::vector<NodeKey> lattice_keys(const Cell& cell, int q);

/// The same where copies of a node (Mesh::first_copies) are one: equal for the copies of an entity.
std::vector<NodeKey> joined_lattice_keys(const Mesh& mesh, const Cell& cell, int q);

/// Identity of a whole entity by its vertices (at most 8); its place is zero.
NodeKey entity_key(std::span<const int> vertices);

/// Gives every new key the next number. Open addressing with linear probing; no erasing.
class NodeNumbering {
 public:
  /// \param expected  number of keys to make room for
  explicit NodeNumbering(std::size_t expected = 0);

  /// Number of the key and whether it is new.
  struct Found {
    int number;
    bool inserted;
  };
  Found insert(const NodeKey& key);
  /// -1 if unknown.
  int find(const NodeKey& key) const;
  /// The keys in the order of their numbers.
  const std::vector<NodeKey>& keys() const { return keys_; }

 private:
  std::size_t slot_of(const NodeKey& key) const;
  void grow(std::size_t slots);

  std::vector<NodeKey> keys_;
  std::vector<int> slots_;
};

}  // namespace karcher
