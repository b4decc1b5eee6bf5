#include "karcher/io/console_table.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "karcher/field/field.hpp"

namespace karcher {
namespace {

/// What a run of two iterations, the second rejected, leaves on the console.
std::string run(bool terminal) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* out = open_memstream(&text, &size);
  {
    ConsoleTable table(out, 4, terminal);
    table.transient("reading the mesh ...");
    table.load_step_begins(1, 0.25);
    IterationRecord r;
    r.load_step = 1;
    r.energy = 12.5;
    r.gradient_norm = 3.25e-3;
    table.iteration(r);
    r.iteration = 1;
    r.step_norm = 0.125;
    r.radius = 1;
    r.ratio = -0.5;
    r.note = "infinite energy in the cell around (1, 2, 3)";
    table.iteration(r);
    StepReport report;
    report.status = Status::converged;
    report.iterations = 1;
    report.seconds = 0.5;
    report.reason = "The gradient norm 1e-9 is at most 1e-8.";
    table.load_step_finished(report, Configuration());
    table.line("Results are in results/.");
    table.transient("writing ...");
  }
  std::fclose(out);
  const std::string result(text, size);
  std::free(text);
  return result;
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

TEST(ConsoleTable, RowsAreAlignedUnderTheirHeads) {
  const auto rows = lines(run(false));
  ASSERT_EQ(rows.size(), 7U);
  EXPECT_EQ(rows[1], "Load step 1 of 4, t = 0.25");
  const auto end_of = [&](const std::string& row, const std::string& text) { return row.find(text) + text.size(); };
  EXPECT_EQ(end_of(rows[2], "energy"), end_of(rows[3], "1.250000000000e+01"));
  EXPECT_EQ(end_of(rows[2], "|gradient|"), end_of(rows[3], "3.2500e-03"));
  EXPECT_EQ(end_of(rows[2], "|step|"), end_of(rows[4], "1.2500e-01"));
  EXPECT_EQ(end_of(rows[2], "radius"), end_of(rows[4], "1.0000e+00"));
  EXPECT_EQ(end_of(rows[2], "ratio"), end_of(rows[4], "-0.500"));
  EXPECT_TRUE(rows[4].ends_with("rejected: infinite energy in the cell around (1, 2, 3)"));
  EXPECT_EQ(rows[5], "converged after 1 iteration, 0.50 s. The gradient norm 1e-9 is at most 1e-8.");
}

TEST(ConsoleTable, TellsTheTimeLeftByTheMeanOfTheLoadStepsThatEnded) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* out = open_memstream(&text, &size);
  {
    ConsoleTable table(out, 1000, false), uncounted(out, 0, false);
    StepReport report;
    for (const auto& [seconds, next] : {std::pair(20.0, 999), {0.0, 996}, {20.0, 2}, {1e6, 3}}) {
      report.seconds = seconds;
      table.load_step_finished(report, Configuration());
      uncounted.load_step_finished(report, Configuration());
      table.load_step_begins(next, 0.5);
      uncounted.load_step_begins(next, 0.5);
    }
  }
  std::fclose(out);
  std::vector<std::string> heads;
  for (const std::string& line : lines(text))
    if (line.starts_with("Load step")) heads.push_back(line);
  std::free(text);
  ASSERT_EQ(heads.size(), 8U);
  EXPECT_EQ(heads[0], "Load step 999 of 1000, t = 0.5; about 40 s left");
  EXPECT_EQ(heads[2], "Load step 996 of 1000, t = 0.5; about 50 s left");
  EXPECT_EQ(heads[4], "Load step 2 of 1000, t = 0.5; about 3.7 h left");
  for (std::size_t i = 1; i < 8; i += 2) EXPECT_EQ(heads[i].find("left"), std::string::npos) << "their number is not known";
}

TEST(ConsoleTable, OnlyATerminalSeesTransientLinesAndTheyAreAllErased) {
  const std::string plain = run(false), terminal = run(true);
  EXPECT_EQ(plain.find('\r'), std::string::npos);
  EXPECT_EQ(plain.find('\x1b'), std::string::npos);
  // What a terminal shows in the end: an erased line ("\r", then "erase to the end of the line") is gone.
  std::string shown, line;
  for (std::size_t i = 0; i < terminal.size(); ++i) {
    if (terminal.compare(i, 4, "\r\x1b[K") == 0) {
      line.clear();
      i += 3;
      continue;
    }
    line += terminal[i];
    if (terminal[i] == '\n') {
      shown += line;
      line.clear();
    }
  }
  EXPECT_TRUE(line.empty());
  EXPECT_EQ(shown, plain);
  EXPECT_NE(terminal.find("iteration 2 of load step 1"), std::string::npos);
}

TEST(FinalReport, TellsSizesEnergiesStepsTimesAndWork) {
  Summary s;
  s.title = "Klein bottle";
  s.status = Status::converged;
  s.reason = "A local minimum.";
  s.mesh = {3072, 6144, 2};
  s.unknowns = 36864;
  s.free_unknowns = 36000;
  s.energy = 1.25;
  s.energies = {{"cosserat-shell", 1.5}, {"volume-load", -0.25}};
  s.parts["cosserat-shell"] = {{"membrane", 1.125}};
  s.load_steps.emplace_back();
  s.load_steps[0].t = 1;
  s.load_steps[0].negative_eigenvalues = 0;
  s.load_steps[0].probes["tip"] = {0.5, 0.25};
  s.seconds = {4, 1, 2, 0.5, 0.25, 0.125};
  s.work = {1, 7, 8, 9, 10};
  s.peak_memory_mb = 210.4;
  const std::string text = final_report(s);
  for (const std::string part : {"Klein bottle\nconverged: A local minimum.\n", "3072 cells of order 2, 6144 nodes", "36864 (36000 free) on 1 rank\n",
                                 "1.25\n", "volume-load            -0.25\n", "membrane             1.125\n", "tip                      0.5 0.25\n",
                                 "factorisation                 2.00 s  50.0 %\n", "other                         0.12 s   3.1 %\n",
                                 "1 factorisation, 7 Hessians, 8 gradients, 9 energies, 10 solves", "210 MB"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis missing in" << text;
}

}  // namespace
}  // namespace karcher
