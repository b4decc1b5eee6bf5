#include "solve/multiply.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace karcher {
namespace {

template <std::size_t size>
void multiply_rows(const BlockMatrix& h, const double* x, double* y) {
  const std::size_t bs = size ? size : static_cast<std::size_t>(h.block_size);
  for (std::size_t i = 0; i + 1 < h.row_begin.size(); ++i) {
    const double* xi = x + i * bs;
    double* yi = y + i * bs;
    for (int k = h.row_begin[i]; k < h.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(h.column[static_cast<std::size_t>(k)]);
      const double* block = h.values.data() + static_cast<std::size_t>(k) * bs * bs;
      const double* xj = x + j * bs;
      double* yj = y + j * bs;
      for (std::size_t c = 0; c < bs; ++c) {
        for (std::size_t r = 0; r < bs; ++r) yi[r] += block[c * bs + r] * xj[c];
      }
      if (i == j) continue;
      for (std::size_t c = 0; c < bs; ++c) {
        double sum = 0;
        for (std::size_t r = 0; r < bs; ++r) sum += block[c * bs + r] * xi[r];
        yj[c] += sum;
      }
    }
  }
}

}  // namespace

void multiply(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> x, std::span<double> y) {
  std::vector<double> masked(x.begin(), x.end());
  for (std::size_t d = 0; d < fixed.size(); ++d)
    if (fixed[d]) masked[d] = 0;
  std::fill(y.begin(), y.end(), 0.0);
  switch (h.block_size) {
    case 1:
      multiply_rows<1>(h, masked.data(), y.data());
      break;
    case 2:
      multiply_rows<2>(h, masked.data(), y.data());
      break;
    case 3:
      multiply_rows<3>(h, masked.data(), y.data());
      break;
    case 6:
      multiply_rows<6>(h, masked.data(), y.data());
      break;
    default:
      multiply_rows<0>(h, masked.data(), y.data());
  }
  exchange.sum(y);
  for (std::size_t d = 0; d < fixed.size(); ++d)
    if (fixed[d]) y[d] = 0;
}

}  // namespace karcher
