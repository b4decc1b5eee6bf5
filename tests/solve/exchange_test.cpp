#include "karcher/solve/exchange.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "karcher/solve/collectives.hpp"
#include "solve/distributed.hpp"
#include "solve/share.hpp"

namespace karcher {
namespace {

/// Blocks of three on all ranks; with one block, all ranks but the last own nothing. Every rank sees all blocks.
class ExchangeOf : public ::testing::TestWithParam<int> {
 protected:
  Exchange exchange = testing::Distributed::make_exchange(3, GetParam());
  std::size_t n = static_cast<std::size_t>(3 * GetParam());
  std::vector<double> local(const std::function<double(std::size_t)>& f) const {
    std::vector<double> v;
    for (const int block : exchange.local_to_global())
      for (std::size_t k = 0; k < 3; ++k) v.push_back(f(3 * static_cast<std::size_t>(block) + k));
    return v;
  }
};
INSTANTIATE_TEST_SUITE_P(Blocks, ExchangeOf, ::testing::Values(1, 2, 7));

TEST_P(ExchangeOf, KnowsWhatEveryRankOwns) {
  EXPECT_EQ(exchange.global_dofs(), static_cast<int>(n));
  EXPECT_EQ(exchange.local_dofs(), static_cast<int>(n));
  EXPECT_EQ(exchange.offsets()[static_cast<std::size_t>(exchange.rank())], exchange.owned_begin());
  EXPECT_EQ(sum_over_ranks(exchange.owned_dofs()), static_cast<double>(n));
}

TEST_P(ExchangeOf, SumsOwnedAndGhostEntriesInOneOrderAndFillsTheGhosts) {
  using testing::share;
  std::vector<double> v = local([&](std::size_t i) { return share(exchange.rank(), i); });
  exchange.sum(v);
  const std::vector<double> expected = local([&](std::size_t i) {
    // The owner's own share is there first, then the others' rank after rank.
    const int block = static_cast<int>(i / 3);
    int owner = 0;
    while (exchange.offsets()[static_cast<std::size_t>(owner) + 1] <= block) ++owner;
    double sum = share(owner, i);
    for (int r = 0; r < exchange.ranks(); ++r)
      if (r != owner) sum += share(r, i);
    return sum;
  });
  EXPECT_EQ(v, expected);
}

TEST_P(ExchangeOf, GhostsAreTheOwnersEntries) {
  std::vector<double> v = local([](std::size_t i) { return 0.25 * static_cast<double>(i); });
  const std::vector<double> expected = v;
  for (std::size_t d = static_cast<std::size_t>(exchange.owned_dofs()); d < v.size(); ++d) v[d] = NAN;
  exchange.update_ghosts(v);
  EXPECT_EQ(v, expected);
}

TEST_P(ExchangeOf, ADotProductCountsEachEntryOnce) {
  const std::vector<double> a = local([](std::size_t) { return 2.0; }), b = local([](std::size_t i) { return static_cast<double>(i); });
  EXPECT_EQ(exchange.dot(a, b), static_cast<double>(n * (n - 1)));
}

}  // namespace
}  // namespace karcher
