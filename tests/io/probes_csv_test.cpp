#include "karcher/io/probes_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/io/atomic_file.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

LoadStepSummary step(double t, double tip) {
  LoadStepSummary s;
  s.t = t;
  s.probes = {{"a, \"b\"", {tip, 1.0 / 3, std::nan("")}}, {"tip", {-tip}}};
  return s;
}

TEST(ProbesCsv, HasARowForEveryLoadStepAndTheSameOnesAfterAResume) {
  const TemporaryDirectory directory;
  const std::string head = "load_step,t,\"a, \"\"b\"\".0\",\"a, \"\"b\"\".1\",\"a, \"\"b\"\".2\",tip\n";
  const std::string one = "1,0.1,2.5,0.3333333333333333,nan,-2.5\n", two = "2,0.2,1e-300,0.3333333333333333,nan,-1e-300\n";
  ProbesCsv csv(directory / "probes.csv", {});
  EXPECT_FALSE(std::filesystem::exists(directory / "probes.csv"));
  csv.add(1, step(0.1, 2.5));
  csv.add(2, step(0.2, 1e-300));
  EXPECT_EQ(read_whole(directory / "probes.csv"), head + one + two);
  ProbesCsv resumed(directory / "probes.csv", {step(0.1, 2.5)});
  EXPECT_EQ(read_whole(directory / "probes.csv"), head + one);
  resumed.add(2, step(0.2, 1e-300));
  EXPECT_EQ(read_whole(directory / "probes.csv"), head + one + two);
}

TEST(ProbesCsv, WithoutProbesThereIsNoFile) {
  const TemporaryDirectory directory;
  ProbesCsv csv(directory / "probes.csv", {});
  csv.add(1, {});
  EXPECT_FALSE(std::filesystem::exists(directory / "probes.csv"));
}

}  // namespace
}  // namespace karcher
