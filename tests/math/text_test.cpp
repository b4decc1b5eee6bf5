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
  EXPECT_EQ(nearest_name("SO(3)", std::vector<std::string>{"S2", "SO3"}), "SO3");
  EXPECT_EQ(nearest_name("Cosserat Shell", names), "cosserat-shell");
  EXPECT_EQ(nearest_name("SO4", std::vector<std::string>{"S2", "SO3"}), "SO3");
}

TEST(Text, Utf8IsWhatTheStandardAllows) {
  for (const char* good :
       {"", "a", "\x7f", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf", "Wände"})
    EXPECT_TRUE(is_utf8(good)) << good;
  // A lone continuation, too long ways to write a character, half of a pair, beyond the last character, cut off.
  for (const char* bad : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xff", "a\xc2", "\xe2\x82",
                          "\xe4"
                          "a"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
  EXPECT_EQ(fault_of_name("W\xe4nde"), "is not UTF-8");
}

TEST(Text, OfVeryManyNamesTheFirstAreListed) {
  EXPECT_EQ(join_names(std::vector<std::string>(3, "a")), "a, a, a");
  const std::string list = join_names(std::vector<std::string>(1000, "a"));
  EXPECT_EQ(list.substr(list.size() - 23), "a, a, ... (1000 in all)");
}

TEST(Text, NearNamesOfLongNamesAreNotSought) {
  const std::vector<std::string> names{std::string(1000000, 'a')};
  EXPECT_EQ(nearest_name(std::string(1000000, 'b'), names), "");
}

TEST(Text, SuggestionNamesTheNearestAndAll) {
  const std::vector<std::string> names{"S1", "S2"};
  EXPECT_EQ(suggestion("S22", names), "Did you mean \"S2\"? Known: S1, S2.");
  EXPECT_EQ(suggestion("quaternions", names, "Known manifolds"), "Known manifolds: S1, S2.");
}
