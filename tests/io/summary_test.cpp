#include "karcher/io/summary.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

Summary example() {
  Summary s;
  s.title = "A \"bottle\" </script> ü";
  s.version = "0.1.0";
  s.status = Status::not_converged;
  s.mesh = {3072, 6144, 2};
  s.unknowns = 36864;
  s.free_unknowns = 36000;
  s.ranks = 2;
  s.energy = 1.25;
  s.energies = {{"volume-load", -0.25}, {"cosserat-shell", 1.5}};
  s.parts["cosserat-shell"] = {{"membrane", 1.0}, {"bending", 0.5}};
  LoadStepSummary step;
  step.t = 0.1;
  step.status = Status::converged;
  step.iterations = 7;
  step.energy = 1.1;
  step.gradient_norm = 1e-9;
  step.negative_eigenvalues = 0;
  step.neutral_eigenvalues = 1;
  step.probes = {{"tip", {0.1, 0.0, 0.2}}, {"angle", {0.3}}};
  step.seconds = 0.8;
  step.reason = "The gradient norm 1e-9 is below 1e-8.";
  step.work = {9, 8, 10, 12, 11};
  s.load_steps = {step, step};
  s.load_steps[1].status = Status::interrupted;
  s.load_steps[1].negative_eigenvalues = -1;
  s.errors["m"] = {1e-4, 1e-2};
  s.seconds = {3.1, 0.2, 2.1, 0.3, 0.2, 0.3};
  s.peak_memory_mb = 210;
  s.reason = "Load step 2 did not converge.";
  s.work = {18, 16, 20, 24, 22};
  return s;
}

TEST(Summary, HasTheKeysOfTheContractAndTheirValues) {
  const auto j = nlohmann::json::parse(to_json(example()));
  EXPECT_EQ(j["title"], "A \"bottle\" </script> ü");
  EXPECT_EQ(j["version"], "0.1.0");
  EXPECT_EQ(j["status"], "not-converged");
  EXPECT_EQ(j["mesh"], nlohmann::json({{"cells", 3072}, {"nodes", 6144}, {"order", 2}}));
  EXPECT_EQ(j["unknowns"], 36864);
  EXPECT_EQ(j["ranks"], 2);
  EXPECT_EQ(j["energy"], 1.25);
  EXPECT_EQ(j["energies"], nlohmann::json({{"cosserat-shell", 1.5}, {"volume-load", -0.25}}));
  EXPECT_EQ(j["errors"], nlohmann::json({{"m", {{"l2", 1e-4}, {"h1", 1e-2}}}}));
  EXPECT_EQ(j["peak_memory_mb"], 210.0);
  EXPECT_EQ(j["seconds"],
            nlohmann::json({{"total", 3.1}, {"assembly", 0.2}, {"factorisation", 2.1}, {"solve", 0.3}, {"output", 0.2}, {"setup", 0.3}}));
  ASSERT_EQ(j["load_steps"].size(), 2U);
  const auto& step = j["load_steps"][0];
  EXPECT_EQ(step["t"], 0.1);
  EXPECT_EQ(step["status"], "converged");
  EXPECT_EQ(step["iterations"], 7);
  EXPECT_EQ(step["energy"], 1.1);
  EXPECT_EQ(step["gradient_norm"], 1e-9);
  EXPECT_EQ(step["negative_eigenvalues"], 0);
  EXPECT_EQ(step["probes"], nlohmann::json({{"tip", {0.1, 0.0, 0.2}}, {"angle", {0.3}}}));
  EXPECT_EQ(step["seconds"], 0.8);
  EXPECT_TRUE(j["load_steps"][1]["negative_eigenvalues"].is_null());
}

TEST(Summary, IsReadBackAsItWasWritten) {
  const TemporaryDirectory directory;
  write_summary(directory / "summary.json", example());
  const Summary s = read_summary(directory / "summary.json");
  EXPECT_EQ(to_json(s), to_json(example()));
  EXPECT_EQ(s.energies[0].first, "volume-load");  // the order of the problem file is kept
  EXPECT_EQ(s.load_steps[1].negative_eigenvalues, -1);
}

TEST(Summary, EveryDoubleReadsBackToTheSameBits) {
  std::mt19937_64 random(3);
  std::vector<double> values = {5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1, 1.0 / 3, -0.0,
                                1e23,   9007199254740993.0,      123456789012345680.0};
  while (values.size() < 5000) {
    const double x = std::bit_cast<double>(random());
    if (std::isfinite(x)) values.push_back(x);
  }
  Summary s = example();
  s.load_steps[0].probes["all"] = values;
  const std::string text = to_json(s);
  const Summary back = summary_from_json(text, "text");
  const auto& read = back.load_steps[0].probes.at("all");
  ASSERT_EQ(read.size(), values.size());
  // Once through our reader, once through the C library as any other program would.
  const std::size_t begin = text.find('[', text.find("\"all\""));
  const char* at = text.c_str() + begin + 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read[i]), std::bit_cast<std::uint64_t>(values[i]));
    char* end = nullptr;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(at, &end)), std::bit_cast<std::uint64_t>(values[i]));
    at = end + 1;  // over the comma
  }
}

TEST(Summary, NumbersThatAreNotFiniteAreNull) {
  Summary s = example();
  s.energy = std::numeric_limits<double>::infinity();
  s.load_steps[0].gradient_norm = std::numeric_limits<double>::quiet_NaN();
  const std::string text = to_json(s);
  const auto j = nlohmann::json::parse(text);
  EXPECT_TRUE(j["energy"].is_null());
  EXPECT_TRUE(j["load_steps"][0]["gradient_norm"].is_null());
  EXPECT_TRUE(std::isnan(summary_from_json(text, "text").energy));
}

TEST(Summary, ATitleThatIsNoUnicodeDoesNotSpoilTheFile) {
  Summary s = example();
  s.title = "caf\xe9";
  EXPECT_EQ(nlohmann::json::parse(to_json(s))["title"], "caf\xef\xbf\xbd");
}

TEST(Summary, AFileThatIsNoneIsRefusedByName) {
  const TemporaryDirectory directory;
  for (const std::string text : {"", "{\"title\": \"x\"}", "[1, 2", "{\"title\": 3}"}) {
    std::ofstream(directory / "summary.json") << text;
    try {
      read_summary(directory / "summary.json");
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find((directory / "summary.json").string()), std::string::npos);
    }
  }
  EXPECT_THROW(read_summary(directory / "missing.json"), InputError);
}

TEST(Summary, IsReadableAtEveryMomentWhileItIsRewritten) {
  const TemporaryDirectory directory;
  const auto file = directory / "summary.json";
  Summary s = example();
  write_summary(file, s);
  std::atomic<bool> done = false;
  int reads = 0, changes = 0;
  std::size_t steps = 0;
  std::thread reader([&] {
    while (!done || reads < 20) {
      const Summary seen = read_summary(file);  // a torn file throws, which ends the test program
      changes += seen.load_steps.size() != steps;
      steps = seen.load_steps.size();
      ++reads;
    }
  });
  for (int i = 0; i < 100; ++i) {
    s.load_steps.push_back(s.load_steps[0]);
    write_summary(file, s);
  }
  done = true;
  reader.join();
  EXPECT_GE(reads, 20);
  EXPECT_GE(changes, 1);
  EXPECT_EQ(read_summary(file).load_steps.size(), 102U);
}

TEST(Summary, ALoadStepIsToldAsTheSolverReportsIt) {
  StepReport r;
  r.t = 0.5;
  r.status = Status::converged;
  r.reason = "why";
  r.iterations = 3;
  r.energy = -2;
  r.gradient_norm = 1e-7;
  r.negative_eigenvalues = 2;
  r.neutral_eigenvalues = 1;
  r.work.factorisations = 4;
  r.seconds = 0.25;
  const LoadStepSummary s = summarize(r);
  EXPECT_EQ(s.t, 0.5);
  EXPECT_EQ(s.status, Status::converged);
  EXPECT_EQ(s.reason, "why");
  EXPECT_EQ(s.iterations, 3);
  EXPECT_EQ(s.energy, -2);
  EXPECT_EQ(s.gradient_norm, 1e-7);
  EXPECT_EQ(s.negative_eigenvalues, 2);
  EXPECT_EQ(s.neutral_eigenvalues, 1);
  EXPECT_EQ(s.work.factorisations, 4);
  EXPECT_EQ(s.seconds, 0.25);
}

TEST(DistinctNames, TellTermsOfTheSameNameApart) {
  EXPECT_EQ(distinct_names({"load", "shell", "load", "load-2", "load"}), (std::vector<std::string>{"load", "shell", "load-2", "load-2-2", "load-3"}));
  // As many of one name as a file may have take a moment, not the square of their number.
  EXPECT_EQ(distinct_names(std::vector<std::string>(200000, "load")).back(), "load-200000");
}

TEST(PeakMemory, GrowsByWhatIsTouched) {
  const double before = peak_memory_mb();
  std::vector<char> block(std::size_t{400} << 20, 1);
  EXPECT_GE(peak_memory_mb() - before + static_cast<double>(block[12345]), 300);
}

TEST(WriteAtomically, LeavesTheOldFileAndNoOtherWhenItFails) {
  const TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "occupied" / "by a directory");
  EXPECT_THROW(write_atomically(directory / "occupied", "text"), Error);
  EXPECT_THROW(write_atomically(directory / "missing" / "file", "text"), Error);
  write_atomically(directory / "file", "old");
  write_atomically(directory / "file", "new");
  EXPECT_EQ(read_whole(directory / "file"), "new");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory.path())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"file", "occupied"}));
}

TEST(WriteAtomically, GivesFilesThePermissionsOfAnyOther) {
  const TemporaryDirectory directory;
  write_atomically(directory / "ours", "x");
  std::ofstream(directory / "other") << "x";
  EXPECT_EQ(std::filesystem::status(directory / "ours").permissions(), std::filesystem::status(directory / "other").permissions());
}

}  // namespace
}  // namespace karcher
