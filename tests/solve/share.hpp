#pragma once
// Numbers whose sum over the ranks depends on the order of the terms.

#include <cstddef>

namespace karcher::testing {

/// What a rank contributes to entry i. (No product is added to anything, so that all compilers round it alike.)
inline double share(int rank, std::size_t i) {
  const double size = 1e16 / (rank + 1) + static_cast<double>(i);
  return rank % 2 == 0 ? size : -size;
}

}  // namespace karcher::testing
