#include "karcher/solve/collectives.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "karcher/solve/petsc.hpp"
#include "solve/share.hpp"

namespace karcher {
namespace {

using testing::share;

TEST(Collectives, AddInTheOrderOfTheRanks) {
  constexpr std::size_t n = 70000;  // longer than one piece
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(share(world_rank(), i));
  sum_over_ranks(values);
  for (std::size_t i = 0; i < n; ++i) {
    double expected = 0;
    for (int r = 0; r < world_size(); ++r) expected += share(r, i);
    ASSERT_EQ(values[i], expected) << i;
  }
  EXPECT_EQ(sum_over_ranks(world_rank() + 1.0), 0.5 * world_size() * (world_size() + 1));
}

TEST(Collectives, TheLargestNumberIsThatOfAnyRank) {
  EXPECT_EQ(max_over_ranks(-3.0 + world_rank()), world_size() - 4.0);
  EXPECT_EQ(max_over_ranks(-3.0 - world_rank()), -3.0);
}

TEST(Collectives, NumbersOfTheFirstRankBecomeThoseOfAll) {
  std::vector<double> values{1.0 + world_rank(), -2.0 * world_rank()};
  take_from_first_rank(values);
  EXPECT_EQ(values, (std::vector<double>{1, 0}));
}

TEST(Collectives, OneRankIsEnoughForTruth) {
  for (int speaker = 0; speaker < world_size(); ++speaker) EXPECT_TRUE(on_any_rank(world_rank() == speaker));
  EXPECT_FALSE(on_any_rank(false));
}

TEST(Collectives, TheTextIsThatOfTheLowestRankThatHasOne) {
  const int last = world_size() - 1;
  EXPECT_EQ(first_text(world_rank() == last ? "last" : ""), "last");
  EXPECT_EQ(first_text("rank " + std::to_string(world_rank())), "rank 0");
  EXPECT_EQ(first_text(""), "");
}

}  // namespace
}  // namespace karcher
