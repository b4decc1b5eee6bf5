#pragma once
/// \file
/// Space: the Lagrange nodes of order p on a region of a mesh.
///
/// A node belongs to a mesh vertex, an edge (identified by its two vertices), a face (by its vertices) or a cell, so spaces on a solid and on a part of its
/// boundary share nodes where they touch, and the nodes of an entity are found from the entity's vertices alone.

#include <array>
#include <compare>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// Identity of a Lagrange node, equal for spaces of different regions (and orders, where the places coincide) of one mesh: the sorted vertices of the smallest
/// entity that holds it and its place there in sixths of the edge lengths, in a canonical orientation of the entity.
struct NodeKey {
  std::array<int, 8> vertices{-1, -1, -1, -1, -1, -1, -1, -1};
  std::array<int, 3> place{0, 0, 0};
  auto operator<=>(const NodeKey&) const = default;
};

class Space {
 public:
  /// \param order Lagrange order 1..3 \throws InputError for other orders or an empty region.
  Space(std::shared_ptr<const Mesh> mesh, Region region, int order);

  const Mesh& mesh() const { return *mesh_; }
  std::shared_ptr<const Mesh> mesh_ptr() const { return mesh_; }
  const Region& region() const { return region_; }
  int order() const { return order_; }
  int node_count() const { return static_cast<int>(keys_.size()); }
  /// Nodes of cell c of the region, in the order of reference_cell.hpp.
  const std::vector<int>& cell_nodes(int c) const { return cell_nodes_[static_cast<std::size_t>(c)]; }
  /// Nodes of any entity (for instance a boundary facet), in the order of reference_cell.hpp; empty if the space does not carry it.
  std::vector<int> entity_nodes(const Cell& entity) const;
  /// Place of a node on the mesh's own (curved) geometry.
  const Vec3<double>& position(int node) const { return positions_[static_cast<std::size_t>(node)]; }
  const NodeKey& key(int node) const { return keys_[static_cast<std::size_t>(node)]; }

 private:
  std::shared_ptr<const Mesh> mesh_;
  Region region_;
  int order_;
  std::vector<NodeKey> keys_;
  std::vector<Vec3<double>> positions_;
  std::vector<std::vector<int>> cell_nodes_;
  std::map<NodeKey, int> index_;
};

}  // namespace karcher
