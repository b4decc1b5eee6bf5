// Runs that are broken off and go on.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

TEST(Resume, GoesOnAfterTheLastFinishedLoadStepToTheSameEnd) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml -q --set continuation.steps=4 -o whole").code, 0);
  ASSERT_EQ(shop.karcher("run strip.toml -q --set continuation.steps=4 -o part").code, 0);
  const json whole = summary(shop, "whole");
  EXPECT_EQ(shop.karcher("run strip.toml --resume --set continuation.steps=4 -o part").code, 0) << "nothing is left to do";
  EXPECT_EQ(summary(shop, "part")["energy"], whole["energy"]);
  EXPECT_EQ(shop.karcher("run strip.toml --resume --set continuation.steps=4 --set parameters.load=1e-5 -o part").code, 2) << "another problem";
  EXPECT_EQ(shop.karcher("run strip.toml --resume -o nowhere").code, 2);
}

TEST(Resume, HasTheBitsOfTheRunThatWasNotBrokenOffAtEveryLoadStep) {
  const Workshop shop;
  // A cylinder wrinkles when its rim is turned: another way to factorise or to judge is another minimum.
  shop.write("twist.toml", R"toml(
[mesh]
generate = "cylinder"
cells = [12, 4]
height = 2
shape = "triangle"
order = 2
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 2
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.02
mu = 1e6
lambda = 1e6
mu_c = 1e6
L_c = 0.001
[[dirichlet]]
field = "m"
on = "bottom"
value = "initial"
[[dirichlet]]
field = "Q"
on = "bottom"
value = "initial"
[[dirichlet]]
field = "m"
on = "top"
value = ["x*cos(0.16*t) - y*sin(0.16*t)", "x*sin(0.16*t) + y*cos(0.16*t)", "z"]
[[dirichlet]]
field = "Q"
on = "top"
value = [0, 0, "0.16*t"]
[output]
report = false
)toml");
  constexpr int steps = 8;  // so that t is a binary fraction, whatever the range is cut into
  ASSERT_EQ(shop.karcher(fmt::format("run twist.toml -q --set continuation.steps={} -o whole", steps)).code, 0);
  for (int k = 1; k < steps; ++k) {
    const std::string part = fmt::format("part{}", k);
    ASSERT_EQ(shop.karcher(fmt::format("run twist.toml -q --set continuation.steps={} --set continuation.to={} -o {}", k, k / 8.0, part)).code, 0);
    const Outcome o = shop.karcher(fmt::format("run twist.toml --resume --set continuation.steps={} -o {}", steps, part));
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find(fmt::format("Load step {} of 8, t = {:.6g}", k + 1, (k + 1) / 8.0)), std::string::npos) << o.out;
    for (int step = 1; step <= steps; ++step) {
      const std::string file = fmt::format("solution_{:04}.vtu", step);
      EXPECT_TRUE(content(shop.directory() / part / file) == content(shop.directory() / "whole" / file)) << part << "/" << file;
    }
    const json whole = summary(shop, "whole")["load_steps"], resumed = summary(shop, part)["load_steps"];
    for (std::size_t step = 0; step < steps; ++step)
      for (const char* key : {"energy", "gradient_norm", "iterations", "negative_eigenvalues"})
        EXPECT_EQ(resumed.at(step)[key], whole.at(step)[key]) << part << ", load step " << step + 1 << ", " << key;
  }
}

TEST(Resume, TakesAnotherLoadScheduleThatGoesOnFromThere) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml -q -o results --set continuation.to=0.5").code, 0);
  // Finer, and further: t = 0.5 lies between the loads 0.4 and 0.6.
  const Outcome o = shop.karcher("run strip.toml --resume -o results --set continuation.steps=5");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("resumed after load step 2 (t = 0.5)\n"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("\n\nLoad step 3 of 5, t = 0.6\n"), std::string::npos) << o.out;
  const json steps = summary(shop, "results")["load_steps"];
  ASSERT_EQ(steps.size(), 5u);
  for (std::size_t k = 2; k < 5; ++k) EXPECT_EQ(steps[k]["t"], static_cast<double>(k + 1) / 5);
  ASSERT_EQ(shop.karcher("run strip.toml -q -o whole --set continuation.steps=5").code, 0);
  EXPECT_NEAR(steps[4]["energy"].get<double>() / summary(shop, "whole")["energy"].get<double>(), 1, 1e-8);
  EXPECT_NE(shop.karcher("run strip.toml --resume -o results --set continuation.to=0.7").out.find("is finished"), std::string::npos);
  const Outcome before = shop.karcher("run strip.toml --resume -o results --set continuation.from=2 --set continuation.to=3");
  EXPECT_EQ(before.code, 2);
  EXPECT_NE(before.err.find("stands at t = 1, before the first load step of this problem (continuation.from = 2)"), std::string::npos) << before.err;
}

TEST(Resume, NeedsTheLoadStepsThatTheCheckpointCounts) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  ASSERT_EQ(shop.karcher("run strip.toml -q -o results --set continuation.to=0.5").code, 0);
  // A summary that was not written any more is no matter.
  std::filesystem::remove(shop.directory() / "results/summary.json");
  ASSERT_EQ(shop.karcher("run strip.toml -q --resume -o results --set continuation.to=0.75 --set continuation.steps=3").code, 0);
  EXPECT_EQ(summary(shop, "results")["load_steps"].size(), 3u);
  std::filesystem::remove(shop.directory() / "results/load_steps.jsonl");
  const Outcome o = shop.karcher("run strip.toml --resume -o results");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("load_steps.jsonl holds 0 load steps, but the checkpoint was written after 3."), std::string::npos) << o.err;
}

TEST(Resume, ACheckpointDoesNotGrowWithTheLoadSteps) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const auto size_after = [&](int steps) {
    EXPECT_EQ(shop.karcher(fmt::format("run strip.toml -q -o results --set continuation.steps={} --set output.report=false", steps)).code, 0);
    return std::filesystem::file_size(shop.directory() / "results/checkpoint.bin");
  };
  const auto few = static_cast<double>(size_after(2));
  EXPECT_NEAR(static_cast<double>(size_after(20)), few, 100) << "digits of the numbers in the summary";
}

TEST(Resume, GivesAdaptiveLoadStepsTheLengthThatTheyHad) {
  const Workshop shop;
  // Beyond t = 0.6 every load step fails.
  shop.write("arc.toml", arc("t > 0.6 ? pi : t") + "steps = 2\nadaptive = true\nsmallest = 0.02\n");
  ASSERT_EQ(shop.karcher("run arc.toml -q").code, 1);
  // 1/2, then 1/2 + 1/16 after halving, then 1/32 more of twice that; the next one is tried with 1/16 again, not with 1/2.
  const json steps = summary(shop, "arc")["load_steps"];
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[2]["t"], 0.59375);
  const Outcome o = shop.karcher("run arc.toml --resume");
  EXPECT_EQ(o.code, 1) << o.err;
  EXPECT_NE(o.out.find("resumed after load step 3 (t = 0.59375)\n\nLoad step 4, t = 0.65625\n"), std::string::npos) << o.out;
  EXPECT_EQ(summary(shop, "arc")["load_steps"].size(), 4u);
}

TEST(Resume, IsWhatAnInterruptedRunWaitsFor) {
  const std::string settings =
      " --set continuation.steps=100000 --set mesh.cells=[4,2] --set output.vtu=false --set output.report=false -q -o results";
  for (const char* ranks : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("strip.toml", strip);
    const auto finished = [&] {
      try {
        return summary(shop, "results")["load_steps"].size();
      } catch (const json::exception&) {
        return std::size_t{0};
      }
    };
    EXPECT_EQ(shop.interrupted("run strip.toml" + settings + ranks, [&] { return finished() >= 3; }), 130);
    EXPECT_EQ(summary(shop, "results")["status"], "interrupted") << ranks;
    EXPECT_TRUE(shop.files().contains("results/checkpoint.bin"));
    const std::size_t before = finished();
    EXPECT_EQ(shop.interrupted("run strip.toml --resume" + settings + ranks, [&] { return finished() >= before + 3; }), 130);
    const json s = summary(shop, "results");
    ASSERT_GE(s["load_steps"].size(), before + 3);
    for (std::size_t k = 0; k + 1 < s["load_steps"].size(); ++k) {
      EXPECT_EQ(s["load_steps"][k]["status"], "converged");
      EXPECT_EQ(s["load_steps"][k]["t"].get<double>(), static_cast<double>(k + 1) / 100000);
    }
  }
}

}  // namespace
}  // namespace karcher::testing
