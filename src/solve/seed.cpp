#include "solve/seed.hpp"

namespace karcher {

std::vector<std::uint64_t> seed_numbers(const Layout& layout) {
  std::vector<std::uint64_t> numbers(static_cast<std::size_t>(layout.local_dofs()), 0);
  std::uint64_t before = 0;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const Field& field = layout.fields()[static_cast<std::size_t>(f)];
    const auto dim = static_cast<std::size_t>(field.manifold->dim);
    for (int node : layout.local_nodes(f))
      for (std::size_t k = 0; k < dim; ++k)
        numbers[static_cast<std::size_t>(layout.first_dof(f, node)) + k] = before + static_cast<std::uint64_t>(node) * dim + k;
    before += static_cast<std::uint64_t>(field.space->node_count()) * dim;
  }
  return numbers;
}

double seed_entry(int seed, std::uint64_t number) {
  // splitmix64 (Steele, Lea, Flood, OOPSLA 2014)
  std::uint64_t n = number + (static_cast<std::uint64_t>(seed) << 40) + 0x9e3779b97f4a7c15ULL;
  n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9ULL;
  n = (n ^ (n >> 27)) * 0x94d049bb133111ebULL;
  n ^= n >> 31;
  return static_cast<double>(n >> 11) * 0x1.0p-52 - 1.0;
}

}  // namespace karcher
