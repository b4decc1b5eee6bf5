#include "solve/rounding.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "karcher/solve/collectives.hpp"

namespace karcher {

std::vector<double> sizes_of(const Layout& layout, const Configuration& u) {
  std::vector<double> sizes(static_cast<std::size_t>(layout.local_dofs()), 1.0);
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    const auto ambient = static_cast<std::size_t>(manifold.ambient), dim = static_cast<std::size_t>(manifold.dim);
    std::vector<double> frame(ambient * dim);
    for (int node : layout.local_nodes(f)) {
      const double* p = u.at(f, node, manifold.ambient);
      manifold.frame(p, frame.data());
      for (std::size_t k = 0; k < dim; ++k) {
        if (!manifold.lengths[k]) continue;
        double along = 0;
        for (std::size_t i = 0; i < ambient; ++i) along += frame[i * dim + k] * p[i];
        sizes[static_cast<std::size_t>(layout.first_dof(f, node)) + k] = std::abs(along);
      }
    }
  }
  return sizes;
}

Rounding rounding_of(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> mass,
                     std::span<const double> sizes) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  const auto bs = static_cast<std::size_t>(h.block_size);
  std::vector<double> squares(sizes.size(), 0.0), diagonal(sizes.size(), 0.0);
  for (std::size_t i = 0; i + 1 < h.row_begin.size(); ++i)
    for (int k = h.row_begin[i]; k < h.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(h.column[static_cast<std::size_t>(k)]);
      const double* block = h.values.data() + static_cast<std::size_t>(k) * bs * bs;
      for (std::size_t c = 0; c < bs; ++c)
        for (std::size_t r = 0; r < bs; ++r) {
          const double entry = block[c * bs + r], by_column = entry * sizes[j * bs + c], by_row = entry * sizes[i * bs + r];
          squares[i * bs + r] += by_column * by_column;
          if (i != j) squares[j * bs + c] += by_row * by_row;
          if (i == j && r == c) diagonal[i * bs + r] = std::abs(entry);
        }
    }
  exchange.sum(squares);
  exchange.sum(diagonal);
  Rounding result;
  result.gradient.resize(sizes.size());
  double sums[2] = {0, 0};
  for (std::size_t d = 0; d < sizes.size(); ++d) {
    result.gradient[d] = fixed[d] ? 0 : rounding * std::sqrt(squares[d]);
    if (d >= static_cast<std::size_t>(exchange.owned_dofs())) continue;
    sums[0] += result.gradient[d] * result.gradient[d] / mass[d];
    sums[1] += 0.5 * rounding * rounding * diagonal[d] * sizes[d] * sizes[d];
  }
  sum_over_ranks(sums);
  // An estimate that overflows must not pass for one by which everything is rounding.
  if (!std::isfinite(sums[0]) || !std::isfinite(sums[1])) return {std::vector<double>(sizes.size(), 0.0)};
  result.gradient_norm = std::sqrt(sums[0]);
  result.energy = sums[1];
  return result;
}

}  // namespace karcher
