#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace karcher {

/// Sets of the numbers 0 .. size - 1 that grow together: at first each is one of its own.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The smallest number of the set of i.
  int root(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(int i, int j) {
    const auto [low, high] = std::minmax({root(i), root(j)});
    parent(high) = low;
  }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<int> parent_;
};

}  // namespace karcher
