#include "karcher/io/iterations.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/summary.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

IterationRecord record(int load_step, int iteration) {
  IterationRecord r;
  r.load_step = load_step;
  r.iteration = iteration;
  r.energy = 1.0 / 3 * iteration - 0.1;
  r.gradient_norm = 1e-9 / (1 + iteration);
  r.step_norm = 0.3;
  r.radius = 1e300;
  r.shift = 5e-324;
  r.ratio = -22.5;
  r.accepted = iteration % 2 == 0;
  r.seconds = 0.1 * iteration;
  return r;
}

TEST(Iterations, ReadBackBitForBit) {
  const TemporaryDirectory directory;
  IterationsCsv csv(directory / "iterations.csv");
  for (int i = 0; i < 5; ++i) csv.iteration(record(1, i));
  const auto rows = read_iterations(directory / "iterations.csv");  // while the file is still open for more
  ASSERT_EQ(rows.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const IterationRecord &a = rows[static_cast<std::size_t>(i)], b = record(1, i);
    EXPECT_EQ(a.load_step, 1);
    EXPECT_EQ(a.iteration, i);
    EXPECT_EQ(a.energy, b.energy);
    EXPECT_EQ(a.gradient_norm, b.gradient_norm);
    EXPECT_EQ(a.step_norm, b.step_norm);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.shift, b.shift);
    EXPECT_EQ(a.ratio, b.ratio);
    EXPECT_EQ(a.accepted, b.accepted);
    EXPECT_EQ(a.seconds, b.seconds);
  }
}

TEST(Iterations, TheHeadlineNamesTheColumns) {
  const TemporaryDirectory directory;
  { const IterationsCsv csv(directory / "iterations.csv"); }
  EXPECT_EQ(read_whole(directory / "iterations.csv"), "load_step,iteration,energy,gradient_norm,step_norm,radius,shift,ratio,accepted,seconds\n");
}

TEST(Iterations, NumbersThatAreNotFiniteAreWrittenAsWhatTheyAre) {
  const TemporaryDirectory directory;
  IterationsCsv csv(directory / "iterations.csv");
  IterationRecord r = record(1, 1);
  r.energy = std::numeric_limits<double>::infinity();
  r.ratio = -std::numeric_limits<double>::infinity();
  r.radius = std::numeric_limits<double>::quiet_NaN();
  csv.iteration(r);
  const auto rows = read_iterations(directory / "iterations.csv");
  EXPECT_EQ(rows[0].energy, r.energy);
  EXPECT_EQ(rows[0].ratio, r.ratio);
  EXPECT_TRUE(std::isnan(rows[0].radius));
}

TEST(Iterations, AResumedRunKeepsTheFinishedLoadStepsAndDropsTheBrokenOne) {
  const TemporaryDirectory directory;
  {
    IterationsCsv csv(directory / "iterations.csv");
    for (const int step : {1, 2, 3})
      for (int i = 0; i < 3; ++i) csv.iteration(record(step, i));
  }
  IterationsCsv csv(directory / "iterations.csv", 3);
  csv.iteration(record(3, 0));
  const auto rows = read_iterations(directory / "iterations.csv");
  ASSERT_EQ(rows.size(), 7U);
  EXPECT_EQ(rows[5].load_step, 2);
  EXPECT_EQ(rows[6].load_step, 3);
  EXPECT_EQ(rows[5].energy, record(2, 2).energy);
}

TEST(Iterations, AForeignFileIsRefusedWithItsLine) {
  const TemporaryDirectory directory;
  const auto file = directory / "iterations.csv";
  for (const std::string bad : {"1,2,3", "1,2,3,4,5,6,7,8,1,9,10", "1,2,x,4,5,6,7,8,1,9"}) {
    { const IterationsCsv csv(file); }
    std::ofstream(file, std::ios::app) << bad << "\n";
    try {
      read_iterations(file);
      FAIL() << bad;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(", line 2:"), std::string::npos);
    }
  }
}

TEST(Interruption, AProgramKilledAtAnyMomentLeavesWholeFiles) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    const TemporaryDirectory directory;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      IterationsCsv csv(directory / "iterations.csv");
      Summary summary;
      for (int i = 0;; ++i) {
        csv.iteration(record(1, i));
        summary.load_steps.emplace_back();
        if (i % 8 == 0) write_summary(directory / "summary.json", summary);
      }
    }
    while (!std::filesystem::exists(directory / "summary.json") || std::filesystem::file_size(directory / "iterations.csv") < 1000) ::usleep(1000);
    ::usleep(static_cast<useconds_t>(3000 * attempt));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    const auto rows = read_iterations(directory / "iterations.csv");
    EXPECT_GE(rows.size(), 5U);
    EXPECT_EQ(rows.back().iteration, static_cast<int>(rows.size()) - 1);
    EXPECT_GE(read_summary(directory / "summary.json").load_steps.size(), 1U);
  }
}

}  // namespace
}  // namespace karcher
