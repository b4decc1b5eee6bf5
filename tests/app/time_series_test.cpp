// Parameters from columns of CSV files.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

/// A spring to the value P(t): u = P at every load step.
const std::string follower = R"toml(
[parameters]
P = {csv = "load.csv", column = "P"}
twice = "2*P"
[mesh]
generate = "interval"
cells = [1]
[fields.u]
manifold = "R1"
[[energies]]
type = "l2-distance"
field = "u"
target = ["twice"]
[continuation]
steps = 8
[[probes]]
name = "u"
field = "u"
at = [0.5, 0, 0]
[output]
report = false
)toml";

const std::string series = "# a measured load\nt, P ,temperature\n0,0,20\n0.25, 1 ,21\n\n0.5,-1e0,22\r\n1,3,25\n";

TEST(TimeSeries, AreTheLinesOfTheFileAndLinearBetweenThem) {
  const Workshop shop;
  shop.write("load.csv", "\xEF\xBB\xBF" + series);
  shop.write("problem.toml", follower);
  const Outcome o = shop.karcher("run problem.toml -q -o out");
  ASSERT_EQ(o.code, 0) << o.err;
  const json s = summary(shop, "out");
  const double expected[] = {0.5, 1, 0, -1, 0, 1, 2, 3};
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(s["load_steps"][k]["probes"]["u"].front().get<double>(), 2 * expected[k], 1e-14) << k;
}

TEST(TimeSeries, StandInTheResolvedProblemAndMayBeOverridden) {
  const Workshop shop;
  shop.write("load.csv", series);
  shop.write("problem.toml", follower);
  ASSERT_EQ(shop.karcher("run problem.toml -q -o out --set P=5").code, 0);
  EXPECT_NEAR(summary(shop, "out")["load_steps"][7]["probes"]["u"].front().get<double>(), 10, 1e-13);
  ASSERT_EQ(shop.karcher("run problem.toml -q -o out --set parameters.P.column=temperature").code, 0);
  EXPECT_NEAR(summary(shop, "out")["load_steps"][7]["probes"]["u"].front().get<double>(), 50, 1e-13);
  const Outcome again = shop.karcher("run out/problem.resolved.toml -q -o again");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(summary(shop, "again")["energy"], summary(shop, "out")["energy"]);
}

TEST(TimeSeries, AnotherFileIsAnotherProblem) {
  const Workshop shop;
  shop.write("load.csv", series);
  shop.write("problem.toml", follower);
  ASSERT_EQ(shop.karcher("run problem.toml -q -o out --set continuation.to=0.5 --set continuation.steps=4").code, 0);
  shop.write("load.csv", series + "2,4,26\n");
  EXPECT_EQ(shop.karcher("run problem.toml -q -o out --resume").code, 2);
}

TEST(TimeSeries, AreRefusedWithTheLineOfTheirFile) {
  const auto says = [](const std::string& csv, const std::string& text, const std::string& arguments = "") {
    const Workshop shop;
    if (!csv.empty()) shop.write("load.csv", csv);
    shop.write("problem.toml", follower);
    const Outcome o = shop.karcher("check problem.toml " + arguments);
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find(text), std::string::npos) << o.err;
  };
  says("", "load.csv cannot be read");
  says("t,P\n0,0\n0.5,1\n0.5,2\n1,3\n", "load.csv:4:1: parameters.P: t must increase from line to line, but 0.5 follows 0.5 of line 3.");
  says("t,P\n0,0\n0.5,1 N\n", "load.csv:3:1: parameters.P: \"1 N\" in the column \"P\" is no number.");
  says("t,P\n0,0\n0.5\n", "load.csv:3:1: parameters.P: 2 columns are expected, as in the line of names, not 1.");
  says("t,p\n0,0\n", "load.csv:1:1: parameters.P: there is no column \"P\". Did you mean \"p\"?");
  says("t,P\n0,0\n", "a series needs at least two lines of numbers; there is one.");
  says("t,P\n0,0\n0.8,1\n", "problem.toml:3:5: parameters.P: ");
  says("t,P\n0,0\n0.8,1\n", "load.csv ends at t = 0.8 (line 3), but the load parameter goes from 0 to 1.");
  says("t,P\n0.1,0\n1,1\n", "load.csv begins at t = 0.1 (line 2)");
  says(series, "in parameters.P: unknown key \"colum\". Did you mean \"column\"?", "--set parameters.P.colum=P");
}

}  // namespace
}  // namespace karcher::testing
