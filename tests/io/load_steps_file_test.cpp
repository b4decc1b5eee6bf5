#include "karcher/io/load_steps_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "karcher/error.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

LoadStepSummary step(double t) {
  LoadStepSummary s;
  s.t = t;
  s.status = Status::converged;
  s.energy = 1 / t;
  s.probes = {{"tip", {t, -t}}};
  s.largest_strain = LargestStrain{"shell", 0.25, {{1, 2, t}}};
  s.warnings = {"a\nb"};
  return s;
}

TEST(LoadStepsFile, GivesBackEveryLoadStepToTheLastBit) {
  const TemporaryDirectory directory;
  LoadStepsFile file(directory.path(), {step(0.1)});
  file.add(step(1.0 / 3));
  const auto back = read_load_steps(directory.path());
  ASSERT_EQ(back.size(), 2U);
  for (const std::size_t k : {0U, 1U}) {
    const LoadStepSummary is = back[k], was = step(k == 0 ? 0.1 : 1.0 / 3);
    EXPECT_EQ(to_json_line(is), to_json_line(was));
    EXPECT_EQ(is.t, was.t);
    EXPECT_EQ(is.energy, was.energy);
    EXPECT_EQ(is.probes, was.probes);
  }
}

TEST(LoadStepsFile, TellsTheLoadStepsThatTheSummaryDoesNotHoldYet) {
  const TemporaryDirectory directory;
  Summary summary;
  summary.load_steps = {step(1)};
  write_summary(directory / "summary.json", summary);
  EXPECT_EQ(read_results(directory.path()).load_steps.size(), 1U);
  const LoadStepsFile file(directory.path(), {step(1), step(2), step(3)});
  const Summary all = read_results(directory.path());
  ASSERT_EQ(all.load_steps.size(), 3U);
  EXPECT_EQ(all.load_steps.back().t, 3);
}

TEST(LoadStepsFile, WhatIsNoLoadStepIsRefusedWithItsLineAndHalfALineIsNone) {
  const TemporaryDirectory directory;
  { const LoadStepsFile file(directory.path(), {step(1)}); }
  std::ofstream(directory / "load_steps.jsonl", std::ios::app) << "{\"t\": 1";
  EXPECT_EQ(read_load_steps(directory.path()).size(), 1U);
  std::ofstream(directory / "load_steps.jsonl", std::ios::app) << "}\n";
  try {
    read_load_steps(directory.path());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("load_steps.jsonl, line 2 is not a load step of a run"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace karcher
