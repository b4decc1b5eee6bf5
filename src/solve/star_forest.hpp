#pragma once
/// \file
/// StarForest: entries of vectors that one rank owns (roots) and other ranks hold (leaves), and the messages between them: PETSc's PetscSF, in which a rank talks
/// to those alone with which it shares something. At a root contributions are added in the order of the ranks: same ranks, same bits.

#include <memory>
#include <span>
#include <vector>

namespace karcher {

class StarForest {
 public:
  /// \param leaves   global numbers of the entries that this rank holds
  /// \param offsets  first owned entry of every rank, and the number of all entries at the end
  /// \param width    numbers in an entry
  /// Collective.
  StarForest(std::span<const int> leaves, const std::vector<int>& offsets, int width);

  // Vectors of roots: the entries that this rank owns; vectors of leaves: in the order of the constructor. They must not overlap. Collective.
  void copy_to_leaves(const double* roots, double* leaves) const;
  void add_to_roots(const double* leaves, double* roots) const;
  /// For entries that are held once; roots without a leaf keep their value.
  void copy_to_roots(const double* leaves, double* roots) const;

 private:
  struct Graph;
  std::shared_ptr<const Graph> graph_;
};

}  // namespace karcher
