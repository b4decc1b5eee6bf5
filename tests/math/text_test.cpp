#include "karcher/text.hpp"

#include <gtest/gtest.h>

using namespace karcher;

TEST(Text, EditDistanceCountsLettersToChange) {
  EXPECT_EQ(edit_distance("mesh", "mesh"), 0);
  EXPECT_EQ(edit_distance("mesh", "mehs"), 1);  // neighbours swapped
  EXPECT_EQ(edit_distance("Mesh", "mesh"), 0);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("", "abc"), 3);
}

TEST(Text, NearestNameForgivesAThirdOfTheLetters) {
  const std::vector<std::string> names{"harmonic", "cosserat-shell", "volume", "traction"};
  EXPECT_EQ(nearest_name("harmonc", names), "harmonic");
  EXPECT_EQ(nearest_name("coserat-shel", names), "cosserat-shell");
  EXPECT_EQ(nearest_name("Volume", names), "volume");
  EXPECT_EQ(nearest_name("banana", names), "");
  EXPECT_EQ(nearest_name("x", std::vector<std::string>{"y"}), "");
  EXPECT_EQ(nearest_name("SO4", std::vector<std::string>{"S2", "SO3"}), "SO3");
}

TEST(Text, SuggestionNamesTheNearestAndAll) {
  const std::vector<std::string> names{"S1", "S2"};
  EXPECT_EQ(suggestion("S22", names), "Did you mean \"S2\"? Known: S1, S2.");
  EXPECT_EQ(suggestion("quaternions", names, "Known manifolds"), "Known manifolds: S1, S2.");
}
