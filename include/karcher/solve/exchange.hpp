#pragma once
/// \file
/// Exchange: vectors over owned and ghost dofs of a Layout, on all ranks. Sums are taken in the order of the ranks: same ranks, same bits. A rank sends messages
/// only to those with which it shares dofs.

#include <memory>
#include <span>
#include <vector>

#include "karcher/field/layout.hpp"

namespace karcher {

class StarForest;

class Exchange {
 public:
  explicit Exchange(const Layout& layout);
  /// Without a Layout: blocks owned_begin .. owned_begin + owned_blocks - 1 of this rank, first in local_to_global, then the ghosts. Collective.
  Exchange(int block_size, int owned_begin, int owned_blocks, std::vector<int> local_to_global);

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  int block_size() const { return block_size_; }
  int owned_dofs() const { return owned_blocks_ * block_size_; }
  int local_dofs() const { return static_cast<int>(local_to_global_.size()) * block_size_; }
  int global_dofs() const { return offsets_.back() * block_size_; }
  int owned_begin() const { return owned_begin_; }  ///< block
  const std::vector<int>& local_to_global() const { return local_to_global_; }
  /// First owned block of every rank, and the number of all blocks at the end.
  const std::vector<int>& offsets() const { return offsets_; }

  /// Adds what every rank holds at its ghosts to the owners' entries, then fills the ghosts with the sums. v: local_dofs().
  void sum(std::span<double> v) const;
  /// Fills the ghosts with the owners' entries.
  void update_ghosts(std::span<double> v) const;
  /// a . b over all ranks, each entry once.
  double dot(std::span<const double> a, std::span<const double> b) const;

 private:
  int rank_ = 0, ranks_ = 1, block_size_ = 1, owned_begin_ = 0, owned_blocks_ = 0;
  std::vector<int> local_to_global_, offsets_;
  std::shared_ptr<const StarForest> ghosts_;  ///< null on one rank
};

/// Fills every node that this rank does not see from its owner, so that all ranks hold the whole configuration (for output, probes and checkpoints). Collective.
void complete(const Layout& layout, Configuration& u);

}  // namespace karcher
