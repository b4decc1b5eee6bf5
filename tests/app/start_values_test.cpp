// Fields that start from earlier results.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

/// The strip with both fields from a result; its one load step goes to the load of that result's last one.
std::string started(const std::string& how) {
  std::string text = strip;
  text.replace(text.find("[fields.m]\n"), 11, "[fields.m]\ninitial = {" + how + "}\n");
  text.replace(text.find("[fields.Q]\n"), 11, "[fields.Q]\ninitial = {" + how + "}\n");
  return text;
}

class StartValues : public ::testing::Test {
 protected:
  void SetUp() override { earlier_ = run(shop_, strip, "--set output.report=false", "earlier"); }
  Workshop shop_;
  nlohmann::json earlier_;
};

TEST_F(StartValues, OfTheSameMeshAreTheEquilibriumInNoIteration) {
  const auto again = run(shop_, started("results = \"earlier\""), "--set continuation.steps=1");
  EXPECT_EQ(again["load_steps"][0]["iterations"], 0);
  EXPECT_EQ(again["energy"], earlier_["energy"]) << "bit for bit";
  EXPECT_EQ(again["load_steps"][0]["probes"], earlier_["load_steps"][1]["probes"]);
  const auto resolved = run(shop_, content(shop_.directory() / "out/problem.resolved.toml"), "", "resolved");
  EXPECT_EQ(resolved["load_steps"][0]["iterations"], 0) << "the resolved file says it, too";
}

TEST_F(StartValues, OfAnEarlierStepAreThatStep) {
  // At half of the load, which the first of the two load steps had.
  const auto half = run(shop_, started("results = \"earlier\", step = 1"), "--set continuation.to=0.5 --set continuation.steps=1");
  EXPECT_EQ(half["load_steps"][0]["iterations"], 0);
  EXPECT_EQ(half["energy"], earlier_["load_steps"][0]["energy"]);
  EXPECT_GT(
      run(shop_, started("results = \"earlier\", step = 0"), "--set continuation.to=0.5 --set continuation.steps=1")["load_steps"][0]["iterations"],
      0);
}

TEST_F(StartValues, OfAnotherMeshSaveIterationsAndEndInTheSamePoint) {
  for (const std::string other : {"mesh.cells=[6,3]", "mesh.shape=quadrilateral", "fields.m.order=3", "fields.Q.order=2"}) {
    const std::string arguments = "--set continuation.steps=1 --set " + other;
    const auto fresh = run(shop_, strip, arguments), warm = run(shop_, started("results = \"earlier\""), arguments);
    EXPECT_NEAR(warm["energy"].get<double>(), fresh["energy"].get<double>(), 1e-9 * std::abs(fresh["energy"].get<double>())) << other;
    EXPECT_LE(warm["load_steps"][0]["iterations"], fresh["load_steps"][0]["iterations"]) << other;
  }
}

TEST_F(StartValues, LeaveTheStressFreeFrameAndTheSupportsWhereTheInitialValuesPutThem) {
  // The left end keeps its initial values: those of `values`, not those of the result, in which it was moved.
  std::string moved = strip;
  moved.replace(moved.find("value = [\"x\", \"y\", \"z\"]"), 23, "value = [\"x\", \"y\", \"z + 0.1\"]");
  run(shop_, moved, "", "moved");
  std::string kept = started("results = \"moved\"");
  kept.replace(kept.find("value = [\"x\", \"y\", \"z\"]"), 23, "value = \"initial\"");
  const auto back = run(shop_, kept, "--set continuation.steps=1");
  EXPECT_NEAR(back["energy"].get<double>(), earlier_["energy"].get<double>(), 1e-9 * std::abs(earlier_["energy"].get<double>()));
}

TEST_F(StartValues, AreTheSameOnTwoRanks) {
  const auto two = run(shop_, started("results = \"earlier\""), "-n 2 --set continuation.steps=1");
  EXPECT_EQ(two["load_steps"][0]["iterations"], 0);
}

TEST_F(StartValues, ThatCannotBeHadAreRefusedWithTheirPlace) {
  const auto refused = [&](const std::string& how, const std::string& arguments = "") {
    shop_.write("bad.toml", started(how));
    const Outcome o = shop_.karcher("check bad.toml " + arguments);
    EXPECT_EQ(o.code, 2) << o.out;
    return o.err;
  };
  const auto has = [](const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << text; };
  has(refused("results = \"earlir\""), "there are no states in ");
  has(refused("results = \"earlier\", step = 3"), "has no step 3; it has 0, 1, 2.");
  has(refused("results = \"earlier\", stp = 1"), "step");
  has(refused("step = 1"), "results");
  has(refused("results = \"earlier\", field = \"n\""), "has no \"n\".");
  has(refused("results = \"earlier\", field = \"displacement\""), "has 3 components, points of SO3 have 4.");
  has(refused("results = \"earlier\"", "--set mesh.size=[3,1]"), "the node at (");
  has(refused("results = \"earlier\"", "--set mesh.size=[3,1]"), "bad.toml:");
  for (const auto& entry : std::filesystem::directory_iterator(shop_.directory() / "earlier"))
    if (entry.path().extension() == ".vtu") std::filesystem::resize_file(entry.path(), 1000);
  has(refused("results = \"earlier\""), "was not written by Karcher: it is no XML");
}

}  // namespace
}  // namespace karcher::testing
