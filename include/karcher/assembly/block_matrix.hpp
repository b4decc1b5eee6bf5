#pragma once
/// \file
/// BlockMatrix: the upper triangle of a symmetric matrix in compressed block rows, local to a rank.
///
/// Rows and columns are local blocks of the Layout; block (i, j) is stored in the row whose global number is smaller. Blocks are column-major
/// (as PETSc's SBAIJ stores them), diagonal blocks whole. On one rank the arrays are exactly those of a MATSEQSBAIJ matrix.

#include <vector>

namespace karcher {

struct BlockMatrix {
  int block_size = 1;
  std::vector<int> row_begin;  ///< local_blocks + 1
  std::vector<int> column;     ///< local block numbers, ascending by global number within a row
  std::vector<double> values;  ///< column.size() * block_size^2
};

}  // namespace karcher
