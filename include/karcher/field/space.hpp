#pragma once
/// \file
/// Space: the Lagrange nodes of order p on a region of a mesh.
///
/// A node belongs to a mesh vertex, an edge (identified by its two vertices), a face (by its vertices) or a cell, so spaces on a solid and on a part
/// of its boundary share nodes where they touch, and the nodes of an entity are found from the entity's vertices alone.

#include <memory>
#include <vector>

#include "karcher/mesh/mesh.hpp"
#include "karcher/mesh/node_key.hpp"

namespace karcher {

class Space {
 public:
  /// Whether copies of a node of a periodic mesh are one node of the space.
  enum class Copies { joined, apart };
  /// \param order Lagrange order 1..3 \throws InputError for other orders or an empty region.
  Space(std::shared_ptr<const Mesh> mesh, Region region, int order, Copies copies = Copies::joined);

  const Mesh& mesh() const { return *mesh_; }
  std::shared_ptr<const Mesh> mesh_ptr() const { return mesh_; }
  const Region& region() const { return region_; }
  int order() const { return order_; }
  int node_count() const { return static_cast<int>(positions_.size()); }
  /// Nodes of cell c of the region, in the order of reference_cell.hpp.
  const std::vector<int>& cell_nodes(int c) const { return cell_nodes_[static_cast<std::size_t>(c)]; }
  /// Nodes of any entity (for instance a boundary facet), in the order of reference_cell.hpp; empty if the space does not carry it.
  std::vector<int> entity_nodes(const Cell& entity) const;
  /// Place of a node on the mesh's own (curved) geometry; of joined copies, one of them.
  const Vec3<double>& position(int node) const { return positions_[static_cast<std::size_t>(node)]; }
  /// Places of the entity's nodes on the entity itself, in the order of entity_nodes.
  std::vector<Vec3<double>> entity_positions(const Cell& entity) const;
  /// Whether nodes may have several places.
  bool joins_copies() const { return copies_ == Copies::joined && !mesh_->first_copies.empty(); }
  const NodeKey& key(int node) const { return numbering_.keys()[static_cast<std::size_t>(node)]; }

 private:
  std::shared_ptr<const Mesh> mesh_;
  Region region_;
  int order_;
  Copies copies_;
  std::vector<NodeKey> keys_of(const Cell& entity) const;
  bool carries(const Cell& entity, const std::vector<int>& nodes) const;

  NodeNumbering numbering_;
  std::vector<Vec3<double>> positions_;
  std::vector<std::vector<int>> cell_nodes_;
  std::vector<int> around_begin_, around_;  ///< cells of the region around every node that is a vertex, in compressed rows
};

}  // namespace karcher
