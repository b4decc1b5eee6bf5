#include "solve/seed.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"

namespace karcher {
namespace {

/// Two fields of different order on a square, as every one of `ranks` sees them.
std::vector<Layout> layouts(int ranks) {
  const auto mesh = std::make_shared<Mesh>(generate({"rectangle", {{"cells", {5, 4}}}, {}}));
  const auto field = [&](const char* name, int order) {
    return Field{name, &manifold_ops<Sphere<2>>(), Rule::projection, std::make_shared<Space>(mesh, mesh->region("all"), order)};
  };
  const std::vector<Field> fields = {field("u", 2), field("v", 1)};
  std::vector<std::vector<char>> fixed;
  for (const Field& f : fields) fixed.emplace_back(static_cast<std::size_t>(2 * f.space->node_count()), 0);
  std::vector<Layout> result;
  for (int rank = 0; rank < ranks; ++rank) result.emplace_back(fields, fixed, partition_cells(*mesh, ranks), rank, ranks);
  return result;
}

TEST(Seed, NumbersTellFieldNodeAndComponentOnAnyNumberOfRanks) {
  std::map<std::uint64_t, std::array<int, 3>> meaning;
  for (int ranks : {1, 2, 3})
    for (const Layout& layout : layouts(ranks)) {
      const std::vector<std::uint64_t> numbers = seed_numbers(layout);
      ASSERT_EQ(static_cast<int>(numbers.size()), layout.local_dofs());
      for (int f : {0, 1})
        for (int node : layout.local_nodes(f))
          for (int k : {0, 1}) {
            const std::array<int, 3> place{f, node, k};
            const auto [found, is_new] = meaning.emplace(numbers[static_cast<std::size_t>(layout.first_dof(f, node) + k)], place);
            EXPECT_EQ(found->second, place);
            EXPECT_TRUE(!is_new || ranks == 1);
          }
    }
}

TEST(Seed, EntriesOfDifferentSeedsAreUncorrelated) {
  constexpr int n = 10000;
  for (int a : {0, 1, 2})
    for (int b : {0, 1, 2}) {
      double product = 0;
      for (std::uint64_t i = 0; i < n; ++i) product += seed_entry(a, i) * seed_entry(b, i);
      EXPECT_NEAR(product / n, a == b ? 1.0 / 3 : 0.0, 4 / std::sqrt(9.0 * n));  // uniform in [-1, 1]
    }
}

}  // namespace
}  // namespace karcher
