#pragma once
// A dense symmetric matrix as BlockMatrix on any number of ranks: every rank owns a range of blocks, sees all others as ghosts, and contributes its share of
// every entry, so that sums over ranks matter.

#include <algorithm>
#include <vector>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/petsc.hpp"

namespace karcher::testing {

struct Distributed {
  int block_size, blocks;
  Exchange exchange;
  BlockMatrix matrix;

  static Exchange make_exchange(int block_size, int blocks) {
    const int ranks = world_size(), rank = world_rank();
    const int begin = blocks * rank / ranks, end = blocks * (rank + 1) / ranks;
    std::vector<int> local_to_global;
    for (int b = begin; b < end; ++b) local_to_global.push_back(b);
    for (int b = 0; b < blocks; ++b)
      if (b < begin || b >= end) local_to_global.push_back(b);
    return Exchange(block_size, begin, end - begin, local_to_global);
  }

  /// dense: n x n with n = block_size * blocks. sparse: blocks off the diagonal that are zero are no part of the matrix.
  Distributed(int bs, const std::vector<double>& dense, int n, bool sparse = false)
      : block_size(bs), blocks(n / bs), exchange(make_exchange(bs, n / bs)) {
    const std::vector<int>& global = exchange.local_to_global();
    std::vector<int> local(global.size());
    for (std::size_t i = 0; i < global.size(); ++i) local[static_cast<std::size_t>(global[i])] = static_cast<int>(i);
    const int ranks = world_size();
    matrix.block_size = bs;
    matrix.row_begin.push_back(0);
    for (int g : global) {
      for (int c = g; c < blocks; ++c) {
        std::vector<double> block;
        for (int j = 0; j < bs; ++j)
          for (int i = 0; i < bs; ++i) block.push_back(dense[static_cast<std::size_t>((g * bs + i) * n + c * bs + j)] / ranks);
        if (sparse && c != g && std::all_of(block.begin(), block.end(), [](double x) { return x == 0; })) continue;
        matrix.column.push_back(local[static_cast<std::size_t>(c)]);
        matrix.values.insert(matrix.values.end(), block.begin(), block.end());
      }
      matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
    }
  }

  /// Entries of a global vector in local order.
  std::vector<double> local(const std::vector<double>& v) const {
    std::vector<double> result;
    for (int b : exchange.local_to_global())
      for (int k = 0; k < block_size; ++k) result.push_back(v[static_cast<std::size_t>(b * block_size + k)]);
    return result;
  }
  /// The whole vector from local entries (ghosts filled).
  std::vector<double> global(const std::vector<double>& v) const {
    std::vector<double> result(v.size());
    std::size_t at = 0;
    for (int b : exchange.local_to_global())
      for (int k = 0; k < block_size; ++k) result[static_cast<std::size_t>(b * block_size + k)] = v[at++];
    return result;
  }
};

}  // namespace karcher::testing
