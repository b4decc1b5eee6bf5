#include "karcher/io/earlier_results.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "karcher/io/summary.hpp"
#include "karcher/io/vtu.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

std::set<std::string> files(const TemporaryDirectory& directory) {
  std::set<std::string> names;
  for (const auto& e : std::filesystem::directory_iterator(directory.path())) names.insert(e.path().filename().string());
  return names;
}

const OutputPart point{"all", 0, 1, {{{0, 0, 0}}}, {{CellKind::vertex, {0}}}, {}, {}};

TEST(EarlierResults, AreNamedAndRemovedAndNothingElseIs) {
  const TemporaryDirectory directory;
  EXPECT_EQ(remove_earlier_results(directory.path()), "");
  VtuSeries series(directory.path());
  for (const int state : {0, 1, 2}) series.write(state, state, {point});
  Summary summary;
  summary.title = "a plate";
  summary.status = Status::converged;
  summary.load_steps.resize(2);
  write_summary(directory / "summary.json", summary);
  for (const char* name : {"checkpoint.bin", "report.html", "report.data", "iterations.csv", ".checkpoint.bin.123.part", ".solution_0003.vtu.9.part",
                           "solution_0007.vtu", ".hidden.part", "mine.part", "notes.txt"})
    std::ofstream(directory / name) << "x";
  EXPECT_EQ(remove_earlier_results(directory.path()), "replaces the results of an earlier run (\"a plate\": converged, 2 load steps)");
  EXPECT_EQ(files(directory), (std::set<std::string>{"iterations.csv", "solution_0007.vtu", ".hidden.part", "mine.part", "notes.txt"}));
}

TEST(EarlierResults, ACollectionOfOthersNamesNothingThatIsOurs) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "results");
  const std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n",
                    tail = "  </Collection>\n</VTKFile>\n";
  for (const char* file : {"../outside.vtu", "notes.txt"}) {
    std::ofstream(directory / "outside.vtu") << "x";
    std::ofstream(directory / "results/notes.txt") << "x";
    std::ofstream(directory / "results/solution.pvd")
        << head << "    <DataSet timestep=\"0\" group=\"\" part=\"0\" name=\"all\" state=\"0\" file=\"" << file << "\"/>\n"
        << tail;
    remove_earlier_results(directory / "results");
    EXPECT_TRUE(std::filesystem::exists(directory / "outside.vtu"));
    EXPECT_TRUE(std::filesystem::exists(directory / "results/notes.txt"));
  }
}

TEST(EarlierResults, AResumedSeriesDropsStatesThatAreLaterOrMissing) {
  const TemporaryDirectory directory;
  {
    VtuSeries series(directory.path());
    for (const int state : {0, 1, 2, 3}) series.write(state, state, {point});
  }
  std::filesystem::remove(directory / "solution_0001.vtu");
  VtuSeries series(directory.path());
  series.resume(3);
  EXPECT_EQ(files(directory), (std::set<std::string>{"solution.pvd", "solution_0000.vtu", "solution_0002.vtu"}));
  series.write(3, 3, {point});
  std::vector<int> states;
  for (const VtuEntry& e : read_collection(directory / "solution.pvd")) states.push_back(e.state);
  EXPECT_EQ(states, (std::vector<int>{0, 2, 3}));
}

}  // namespace
}  // namespace karcher
