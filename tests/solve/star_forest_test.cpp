#include "solve/star_forest.hpp"

#include <gtest/gtest.h>

#include "karcher/solve/petsc.hpp"
#include "solve/share.hpp"

namespace karcher {
namespace {

/// Five entries of two numbers; the last rank owns them all, every rank holds them all, in descending order.
struct Shared {
  static constexpr int entries = 5;
  std::vector<int> offsets;
  std::vector<int> leaves{4, 3, 2, 1, 0};
  bool owner = world_rank() == world_size() - 1;
  Shared() : offsets(static_cast<std::size_t>(world_size()), 0) { offsets.push_back(entries); }
  std::size_t owned() const { return owner ? 2 * entries : 0; }
};

TEST(StarForest, AddsAtTheRootsInTheOrderOfTheRanks) {
  const Shared s;
  const StarForest forest(s.leaves, s.offsets, 2);
  std::vector<double> leaves, roots(s.owned(), 3.0);
  for (const int entry : s.leaves)
    for (std::size_t k = 0; k < 2; ++k) leaves.push_back(testing::share(world_rank(), 2 * static_cast<std::size_t>(entry) + k));
  forest.add_to_roots(leaves.data(), roots.data());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    double expected = 3.0;
    for (int r = 0; r < world_size(); ++r) expected += testing::share(r, i);
    EXPECT_EQ(roots[i], expected);
  }
}

TEST(StarForest, CopiesRootsToAllTheirLeaves) {
  const Shared s;
  const StarForest forest(s.leaves, s.offsets, 2);
  std::vector<double> roots, leaves(10, 0.0);
  for (std::size_t i = 0; i < s.owned(); ++i) roots.push_back(1.5 * static_cast<double>(i));
  forest.copy_to_leaves(roots.data(), leaves.data());
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(leaves[i], 1.5 * static_cast<double>(2 * (4 - i / 2) + i % 2));
}

TEST(StarForest, CopiesASingleLeafToItsRootAndLeavesOtherRootsAlone) {
  // Every rank owns two entries and holds the second one of the next rank.
  std::vector<int> offsets;
  for (int r = 0; r <= world_size(); ++r) offsets.push_back(2 * r);
  const int next = (world_rank() + 1) % world_size();
  const StarForest forest(std::vector<int>{2 * next + 1}, offsets, 1);
  const double leaf = 10.0 + next;
  std::vector<double> roots{-1, -2};
  forest.copy_to_roots(&leaf, roots.data());
  EXPECT_EQ(roots, (std::vector<double>{-1, 10.0 + world_rank()}));
}

}  // namespace
}  // namespace karcher
