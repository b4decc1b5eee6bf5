#pragma once
/// \file
/// Layout: where the tangent coordinates of every node of every field stand in the vectors and matrices of the solver, on this rank.
///
/// Unknowns that sit at the same place of the mesh (equal NodeKey) are neighbours, so a shell of equal orders has 6 x 6 blocks. Blocks are numbered
/// rank after rank; within a rank in a fill-reducing order. A rank has its owned blocks first, then the ghosts that its cells touch. Fixed components
/// keep their place; their rows are replaced by the identity and do not count in the inertia.

#include <span>
#include <vector>

#include "karcher/field/field.hpp"
#include "karcher/mesh/incidence.hpp"

namespace karcher {

/// Entities per rank, one number for each cell of the mesh (see mesh/partition.hpp); all zero on one rank.
using CellRanks = std::vector<int>;

class Layout {
 public:
  /// \param fixed  fixed[field][node * dim + component] != 0 where a tangent component does not move
  Layout(std::span<const Field> fields, const std::vector<std::vector<char>>& fixed, const CellRanks& cell_ranks, int rank, int ranks);

  /// Other fixed components, as the constructor takes them; places in vectors and matrices stay. What copied them before (a Minimizer) keeps the old ones.
  void fix(const std::vector<std::vector<char>>& fixed);

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  int block_size() const { return block_size_; }
  int global_blocks() const { return global_blocks_; }
  int owned_begin() const { return owned_begin_; }  ///< first owned block, global number
  int owned_blocks() const { return owned_blocks_; }
  int local_blocks() const { return static_cast<int>(local_to_global_.size()); }  ///< owned, then ghosts
  int owned_dofs() const { return owned_blocks() * block_size_; }
  int local_dofs() const { return local_blocks() * block_size_; }
  int global_dofs() const { return global_blocks_ * block_size_; }
  int free_dofs() const { return free_dofs_; }                                  ///< over all ranks
  const std::vector<int>& local_to_global() const { return local_to_global_; }  ///< blocks

  /// First local dof of a node of a field; its `dim` coordinates follow one another. -1 if this rank does not see the node.
  int first_dof(int field, int node) const { return first_dof_[static_cast<std::size_t>(field)][static_cast<std::size_t>(node)]; }
  bool owns(int field, int node) const {
    const int d = first_dof(field, node);
    return d >= 0 && d < owned_dofs();
  }
  /// Nodes of a field that this rank sees (owned and ghost), and all ranks' owner of a node.
  const std::vector<int>& local_nodes(int field) const { return local_nodes_[static_cast<std::size_t>(field)]; }
  int owner(int field, int node) const { return owner_[static_cast<std::size_t>(field)][static_cast<std::size_t>(node)]; }
  bool fixed(int local_dof) const { return fixed_[static_cast<std::size_t>(local_dof)] != 0; }

  /// Rank that evaluates an entity: that of the first mesh cell that has all its vertices. This rank sees all nodes on such entities.
  int cell_rank(const Cell& entity) const;

  const std::vector<Field>& fields() const { return fields_; }
  /// trial = retract(configuration, step) on the nodes that this rank sees; step in local dofs (ghost entries filled), fixed components ignored.
  void retract(const Configuration& from, std::span<const double> step, Configuration& trial) const;

 private:
  std::vector<Field> fields_;
  int rank_ = 0, ranks_ = 1, block_size_ = 1, global_blocks_ = 0, owned_begin_ = 0, owned_blocks_ = 0, free_dofs_ = 0;
  std::vector<int> local_to_global_;
  std::vector<std::vector<int>> first_dof_, local_nodes_, owner_;
  std::vector<char> fixed_;
  CellRanks cell_ranks_;
  std::shared_ptr<const VertexCells> around_;
};

}  // namespace karcher
