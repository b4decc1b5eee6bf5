#pragma once
/// \file
/// Exchange: vectors over owned and ghost dofs of a Layout, and the few collective operations that solvers need. Sums are taken in the order of the ranks:
/// same ranks, same bits.

#include <span>
#include <string>
#include <vector>

#include "karcher/field/layout.hpp"

namespace karcher {

class Exchange {
 public:
  explicit Exchange(const Layout& layout);
  /// Without a Layout: blocks owned_begin .. owned_begin + owned_blocks - 1 of this rank, first in local_to_global, then the ghosts.
  Exchange(int block_size, int owned_begin, int owned_blocks, std::vector<int> local_to_global);

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  int block_size() const { return block_size_; }
  int owned_dofs() const { return owned_blocks_ * block_size_; }
  int local_dofs() const { return static_cast<int>(local_to_global_.size()) * block_size_; }
  int global_dofs() const { return global_blocks_ * block_size_; }
  int owned_begin() const { return owned_begin_; }  ///< block
  const std::vector<int>& local_to_global() const { return local_to_global_; }
  /// First owned block of every rank, and the number of all blocks at the end.
  const std::vector<int>& offsets() const { return offsets_; }

  /// Adds what every rank holds at its ghosts to the owners' entries, then fills the ghosts with the sums. v: local_dofs().
  void sum(std::span<double> v) const;
  /// Fills the ghosts with the owners' entries.
  void update_ghosts(std::span<double> v) const;

  double sum(double x) const;
  /// Entry by entry over all ranks, in place.
  void sum_all(std::span<double> values) const;
  double dot(std::span<const double> a, std::span<const double> b) const;
  bool any(bool x) const;
  double max(double x) const;
  /// Text of the lowest rank that has one; empty if none has.
  std::string first_text(const std::string& text) const;

 private:
  void connect();

  int rank_ = 0, ranks_ = 1, block_size_ = 1, owned_begin_ = 0, owned_blocks_ = 0, global_blocks_ = 0;
  std::vector<int> local_to_global_, offsets_;
  // Ghosts by owner: counts and displacements in doubles, and their local blocks in that order; for owners: which owned blocks others see.
  std::vector<int> ghost_counts_, ghost_begin_, ghost_blocks_, shared_counts_, shared_begin_, shared_blocks_;
};

/// Fills every node that this rank does not see from its owner, so that all ranks hold the whole configuration (for output, probes and checkpoints). Collective.
void complete(const Layout& layout, Configuration& u);

}  // namespace karcher
