// Ranks that do not start, that die, that others have started; signals and limits from outside.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "problems.hpp"

namespace karcher::testing {
namespace {

/// So many load steps that there is time to do something to the run.
const std::string long_run = "run strip.toml --set continuation.steps=2000 --set output.vtu=false";

bool has_checkpoint_after_a_load_step(const Workshop& shop) {
  return content(shop.directory() / "strip/summary.json").find("\"t\"") != std::string::npos && shop.files().contains("strip/checkpoint.bin");
}

/// The ranks that a launcher has started, as mpiexec numbers them.
std::vector<pid_t> ranks_of(pid_t launcher) {
  std::vector<pid_t> ranks;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string(), environment = content(entry.path() / "environ");
    if (environment.find("KARCHER_LAUNCHER=" + std::to_string(launcher) + " ") == std::string::npos) continue;
    const std::size_t rank = environment.find(std::string(1, '\0') + "OMPI_COMM_WORLD_RANK=");
    if (rank == std::string::npos || content(entry.path() / "comm") != "karcher\n") continue;
    const auto k = static_cast<std::size_t>(std::atoi(environment.c_str() + rank + 22));
    ranks.resize(std::max(ranks.size(), k + 1));
    ranks[k] = std::atoi(name.c_str());
  }
  return ranks;
}

/// A program for a PATH with this directory.
void write_program(const Workshop& shop, const std::string& name, const std::string& script) {
  std::filesystem::permissions(shop.write(name, "#!/bin/sh\n" + script), std::filesystem::perms::all);
}

TEST(Launch, ARankThatIsKilledIsToldWithWhatIsLeft) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.meanwhile(
      long_run + " -q -n 2", [&] { return has_checkpoint_after_a_load_step(shop); },
      [](pid_t launcher) {
        const std::vector<pid_t> ranks = ranks_of(launcher);
        ASSERT_EQ(ranks.size(), 2u);
        kill(ranks[1], SIGKILL);
      });
  EXPECT_EQ(o.code, 3);
  EXPECT_EQ(
      o.err,
      "error: Rank 1 was ended by signal 9 (Killed; often the machine has no memory left); the results up to the last finished load step are in " +
          (shop.directory() / "strip").string() + ".\n");
  EXPECT_EQ(shop.karcher("run strip.toml -q --resume --set continuation.to=0.01 --set continuation.steps=20 --set output.vtu=false").code, 0);
}

TEST(Launch, RanksThatDoNotStartAreToldWithTheWordsOfMpiexec) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("run strip.toml -n 2", "OMPI_MCA_orte_default_hostfile=/nonexistent");
  EXPECT_EQ(o.code, 3);
  EXPECT_EQ(o.err.find("error: The ranks could not be started; mpiexec says:\n"), 0u) << o.err;
  EXPECT_EQ(o.err.find("mpiexec says:\n\n"), std::string::npos) << o.err;
  EXPECT_FALSE(shop.files().contains("strip"));

  write_program(shop, "mpiexec", "exit 1");
  const Outcome silent = shop.karcher("run strip.toml -n 2", "PATH=.:$PATH");
  EXPECT_EQ(silent.code, 3) << "not mpiexec's own 1, which means that a load step did not converge";
  EXPECT_EQ(silent.err, "error: The ranks could not be started; mpiexec says nothing.\n");
}

TEST(Launch, NeedsNothingFromTheEnvironment) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  for (const char* ranks : {"", " -n 2"}) {
    const Outcome o = shop.karcher(std::string("run strip.toml -q") + ranks, "env -i");
    EXPECT_EQ(o.code, 0);
    EXPECT_EQ(o.err, "");
  }
}

TEST(Launch, ATemporaryDirectoryThatIsMissingIsNamedByItsVariable) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("run strip.toml -n 2", "TMPDIR=nowhere");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(
      o.err,
      "error: The environment variable TMPDIR names nowhere, which is no directory that can be written to; mpiexec needs one. Make it, or unset "
      "TMPDIR.\n");
}

TEST(Launch, OneRankMakesNothingInTheTemporaryDirectoryThatAnotherRunCouldRemove) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const std::filesystem::path temporary = shop.directory() / "tmp";
  std::filesystem::create_directory(temporary);
  const auto long_ago = std::filesystem::last_write_time(temporary) - std::chrono::hours(1);
  std::filesystem::last_write_time(temporary, long_ago);
  EXPECT_EQ(shop.karcher("evaluate strip.toml", "TMPDIR=" + temporary.string()).code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(temporary), long_ago);
}

TEST(Launch, AnotherNumberOfRanksThanTheLaunchersIsTold) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  const Outcome o = shop.karcher("evaluate strip.toml -n 2", "PMI_SIZE=1");
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(o.err, "warning: -n 2 is ignored: by PMI_SIZE in its environment, this process belongs to a launcher, which has started 1 rank.\n");
  EXPECT_EQ(shop.karcher("evaluate strip.toml -n 1", "PMI_SIZE=1").err, "");
  EXPECT_EQ(shop.karcher("evaluate strip.toml", "PMI_SIZE=1").err, "");
}

TEST(Launch, LeavesNoFileWhenItIsKilled) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  std::filesystem::create_directory(shop.directory() / "tmp");
  setenv("TMPDIR", (shop.directory() / "tmp").c_str(), 1);
  const Outcome o = shop.meanwhile(
      long_run + " -q -n 2", [&] { return has_checkpoint_after_a_load_step(shop); }, [](pid_t launcher) { kill(launcher, SIGKILL); });
  unsetenv("TMPDIR");
  EXPECT_EQ(o.code, 128 + SIGKILL);
  for (const std::string& file : shop.files()) EXPECT_EQ(file.find("tmp/karcher"), std::string::npos) << file;
}

TEST(Signals, ATerminalThatIsClosedEndsTheRunAfterTheIterationWithItsResults) {
  for (const char* ranks : {"", " -n 2"}) {
    const Workshop shop;
    shop.write("strip.toml", strip);
    const Outcome o = shop.meanwhile(
        long_run + ranks, [&] { return has_checkpoint_after_a_load_step(shop); }, [](pid_t process) { kill(process, SIGHUP); });
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_EQ(summary(shop, "strip")["status"], "interrupted");
    EXPECT_TRUE(shop.files().contains("strip/report.html"));
  }
}

#ifndef __SANITIZE_ADDRESS__  // which wants 15 TB of addresses, so that the limit stops it before the program starts
TEST(Memory, ThatIsUsedUpIsAnErrorNotAWait) {
  const Workshop shop;
  shop.write("strip.toml", strip);
  // From too little for the BLAS to enough: each ends, and within the time.
  bool refused = false, solved = false;
  for (int limit = 250; limit <= 550; limit += 100) {
    const Outcome o = shop.karcher("run strip.toml -q --set mesh.cells=[32,16]", "ulimit -v " + std::to_string(limit) + "000 && timeout -s KILL 60");
    EXPECT_TRUE(o.code == 0 || o.code == 3) << limit << " MB: " << o.code;
    if (o.code == 0) solved = true;
    if (o.code != 3) continue;
    refused = true;
    EXPECT_EQ(o.err.find("error: "), 0u) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_NE(o.err.find("memory"), std::string::npos) << o.err;
  }
  EXPECT_TRUE(refused && solved);
}
#endif

}  // namespace
}  // namespace karcher::testing
