// Standard output that is full, closed, or read by nobody any more.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

/// "karcher ARGUMENTS" with another standard output; what it prints there is lost. \param where e.g. ">/dev/full" or "| true"
Outcome with_output(const Workshop& shop, const std::string& arguments, const std::string& where) {
  // A group has the runner's redirections, and passes on the exit code of the program, not of the pipe's end.
  return shop.karcher(arguments + " " + where + "; echo $? >code; }", "{");
}

class StandardOutput : public ::testing::TestWithParam<const char*> {};

TEST_P(StandardOutput, ThatCannotBeWrittenDoesNotTouchARun) {
  for (const char* ranks : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("strip.toml", strip);
    const Outcome o = with_output(shop, std::string("run strip.toml") + ranks, GetParam());
    EXPECT_EQ(content(shop.directory() / "code"), "0\n") << o.err;
    EXPECT_EQ(o.err.find("warning: standard output cannot be written: "), 0u) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    const nlohmann::json s = summary(shop, "strip");
    EXPECT_EQ(s["status"], "converged");
    EXPECT_EQ(s["load_steps"].size(), 2u);
    EXPECT_TRUE(shop.files().contains("strip/report.html"));
    const std::string rows = content(shop.directory() / "strip/iterations.csv");
    EXPECT_EQ(rows.find("Load step"), std::string::npos) << "no file of ours is standard output";
  }
}

TEST_P(StandardOutput, ThatCannotBeWrittenIsAnErrorOfWhatIsOnlyPrinted) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  for (const char* verb : {"evaluate strip.toml --json", "evaluate strip.toml -n 2", "check strip.toml", "doc", "list", "version", "--help"}) {
    const Outcome o = with_output(shop, verb, GetParam());
    EXPECT_EQ(content(shop.directory() / "code"), "3\n") << verb;
    EXPECT_EQ(o.err.find("error: standard output cannot be written: "), 0u) << verb << ": " << o.err;
  }
}

INSTANTIATE_TEST_SUITE_P(OfAProgram, StandardOutput, ::testing::Values(">/dev/full", ">&-"));

TEST(StandardOutputOfAProgram, MayBeAPipeThatEnds) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  for (const char* ranks : {"", " -n 2"}) {
    shop.karcher(std::string("run strip.toml") + ranks + "; echo $? >code; } 2>/dev/null | head -n 1 >seen; true", "{");
    EXPECT_EQ(content(shop.directory() / "code"), "0\n") << "not SIGPIPE's 141";
    EXPECT_EQ(content(shop.directory() / "seen").find("A strip: "), 0u);
    EXPECT_EQ(summary(shop, "strip")["status"], "converged");
  }
}

}  // namespace
}  // namespace karcher::testing
