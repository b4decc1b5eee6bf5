// Supports that are released or set in at a load step.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

/// A cantilever, clamped at the left; four load steps. What is done to its right edge is appended.
const std::string cantilever = R"toml(
[mesh]
generate = "rectangle"
size = [2, 1]
cells = [4, 2]
)toml" + soft_shell + R"toml([[dirichlet]]
on = "left"
support = "clamped"
[continuation]
steps = 4
[solver]
gradient_tolerance = 1e-12
[output]
report = false
vtu = false
[[probes]]
name = "tip"
field = "m"
at = [2, 0.5, 0]
quantity = "displacement"
)toml";

std::string right(const std::string& value, const std::string& more = "") {
  return "[[dirichlet]]\nfield = \"m\"\non = \"right\"\nvalue = " + value + "\n" + more;
}
const std::string load = "[[loads]]\ntype = \"traction\"\nfield = \"m\"\non = \"right\"\nvalue = [0, 0, \"1e-5*(t < 0.5 ? t : 1 - t)\"]\n";

double tip(const json& summary, std::size_t step) { return summary["load_steps"][step]["probes"]["tip"][2].get<double>(); }

TEST(ChangingSupports, ACantileverWhoseSupportIsReleasedSpringsBackToItsStressFreeState) {
  for (const std::string ranks : {"", "-n 2"}) {
    const Workshop shop;
    const json s = run(shop, cantilever + right("[\"free\", \"free\", \"0.4*t\"]", "to = 0.5\n"), ranks);
    EXPECT_NEAR(tip(s, 0), 0.1, 1e-15);
    EXPECT_NEAR(tip(s, 1), 0.2, 1e-15);
    EXPECT_GT(s["load_steps"][1]["energy"].get<double>(), 1e-7);
    EXPECT_NEAR(tip(s, 2), 0, 1e-7);
    EXPECT_NEAR(tip(s, 3), 0, 1e-7);
    EXPECT_NEAR(s["energy"].get<double>(), 0, 1e-15);
  }
}

TEST(ChangingSupports, ASupportOnTheCurrentPlaceHoldsWhatIsThereWhenItSetsIn) {
  const Workshop shop;
  const json free = run(shop, cantilever + load), held = run(shop, cantilever + load + right("\"current\"", "from = 0.5\n"));
  EXPECT_GT(tip(held, 1), 0.001);
  EXPECT_EQ(tip(held, 1), tip(free, 1)) << "at t = 0.5 it does not hold yet";
  EXPECT_EQ(tip(held, 2), tip(held, 1));
  EXPECT_EQ(tip(held, 3), tip(held, 1)) << "the load is gone, the edge stays";
  EXPECT_NEAR(tip(free, 3), 0, 1e-7);
}

TEST(ChangingSupports, AClampThatSetsInHoldsTheEdgeAsItIs) {
  const Workshop shop;
  const json held = run(shop, cantilever + load + "[[dirichlet]]\non = \"right\"\nsupport = \"clamped\"\nfrom = 0.5\n");
  EXPECT_GT(tip(held, 1), 0.001);
  EXPECT_EQ(tip(held, 3), tip(held, 1));
}

TEST(ChangingSupports, OneComponentMayStayWhereItIsWhileAnotherIsMoved) {
  const Workshop shop;
  const json s = run(shop, cantilever + load + right("[\"2 - 0.1*(t - 0.5)\", \"free\", \"current\"]", "from = 0.5\n"));
  EXPECT_EQ(tip(s, 3), tip(s, 1));
  EXPECT_NEAR(s["load_steps"][3]["probes"]["tip"][0].get<double>(), -0.05, 1e-15);
}

TEST(ChangingSupports, InitialValuesAreReachedByASupportThatSetsInLate) {
  const Workshop shop;
  const json s = run(shop, cantilever + load + right("\"initial\"", "from = 0.5\nto = 0.75\n"));
  EXPECT_GT(tip(s, 1), 0.001);
  EXPECT_EQ(tip(s, 2), 0);
  EXPECT_NEAR(tip(s, 3), 0, 1e-7) << "released, without load";
}

TEST(ChangingSupports, OneSupportTakesOverFromAnother) {
  const Workshop shop;
  const json s = run(shop, cantilever + right("[\"free\", \"free\", \"0.4*t\"]", "to = 0.5\n") + right("[\"free\", \"free\", 0.3]", "from = 0.5\n"));
  EXPECT_NEAR(tip(s, 1), 0.2, 1e-15);
  EXPECT_NEAR(tip(s, 2), 0.3, 1e-15);
}

TEST(ChangingSupports, AdaptiveLoadStepsEndWhereASupportChanges) {
  const Workshop shop;
  const json s =
      run(shop, cantilever + right("[\"free\", \"free\", \"0.4*t\"]", "to = 0.3\n"), "--set continuation.steps=1 --set continuation.adaptive=true");
  EXPECT_EQ(s["load_steps"][0]["t"], 0.3);
  EXPECT_NEAR(tip(s, 0), 0.12, 1e-15);
  EXPECT_EQ(s["load_steps"].back()["t"], 1.0);
  EXPECT_NEAR(s["energy"].get<double>(), 0, 1e-15);
}

TEST(ChangingSupports, AResumedRunHasTheBitsOfTheWholeOne) {
  const Workshop shop;
  const std::string problem = cantilever + load + right("[\"free\", \"free\", \"0.4*t\"]", "to = 0.25\n") + right("\"current\"", "from = 0.5\n");
  const json whole = run(shop, problem);
  for (const std::string part : {"0.75", "1"}) {
    if (part == "0.75") run(shop, problem, "--set continuation.steps=3 --set continuation.to=0.75", "part");
    const Outcome o = shop.karcher("run problem.toml -q --resume -o part");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(summary(shop, "part")["energy"], whole["energy"]);
    EXPECT_EQ(tip(summary(shop, "part"), 3), tip(whole, 3));
  }
}

TEST(ChangingSupports, WhatNothingHoldsAfterAReleaseIsTold) {
  const Workshop shop;
  std::string problem = cantilever;
  problem.replace(problem.find("support = \"clamped\""), 19, "support = \"clamped\"\nto = 0.5");
  shop.write("problem.toml", problem);
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 0);
  EXPECT_NE((o.out + o.err).find("where 0.5 < t <= 1, nothing holds the field \"m\" completely"), std::string::npos) << o.out << o.err;
}

TEST(ChangingSupports, TwoValuesAtOneNodeAreRefusedOnlyWhereBothHold) {
  const std::string first = right("[\"free\", \"free\", 0]", "to = 0.5\n");
  EXPECT_NE(refusal(cantilever + first + right("[\"free\", \"free\", 0.1]", "from = 0.25\n")).find("different values"), std::string::npos);
  const Workshop shop;
  shop.write("problem.toml", cantilever + first + right("[\"free\", \"free\", 0.1]", "from = 0.5\n"));
  EXPECT_EQ(shop.karcher("check problem.toml").code, 0);
}

TEST(ChangingSupports, ThatNeverHoldAreRefused) {
  EXPECT_NE(refusal(cantilever + right("\"initial\"", "from = 0.6\nto = 0.4\n")).find("dirichlet.1: it holds where 0.6 < t <= 0.4, which is nowhere"),
            std::string::npos);
  EXPECT_NE(refusal(cantilever + right("\"initial\"", "from = 5\n")).find("the load steps end at values of t from 0 to 1"), std::string::npos);
  std::string backwards = cantilever + right("\"initial\"", "to = 0.5\n");
  backwards.replace(backwards.find("steps = 4"), 9, "from = 1\nto = 0");
  EXPECT_NE(refusal(backwards).find("needs a load parameter that grows"), std::string::npos);
}

}  // namespace
}  // namespace karcher::testing
