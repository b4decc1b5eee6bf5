// `karcher view` where it makes no picture: without results, without a browser, with a browser that is none.

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/verbs.hpp"
#include "karcher/error.hpp"
#include "karcher/io/summary.hpp"
#include "temporary_directory.hpp"

namespace karcher::app {
namespace {

void write_results(const std::filesystem::path& directory) {
  Summary summary;
  summary.title = "x";
  write_summary(directory / "summary.json", summary);
}

TEST(View, WithoutResultsItSaysSo) {
  const TemporaryDirectory directory;
  ViewOptions nowhere;
  nowhere.directory = directory / "nowhere";
  EXPECT_THROW(view(nowhere), InputError);
  nowhere.directory = directory.path();
  EXPECT_THROW(view(nowhere), InputError);
  EXPECT_FALSE(std::filesystem::exists(directory / "report.html"));
}

TEST(View, WithoutABrowserItSaysWhatToInstall) {
  const TemporaryDirectory directory;
  write_results(directory.path());
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", directory.path().c_str(), 1);
  ::unsetenv("KARCHER_CHROMIUM");
  ViewOptions options;
  options.directory = directory.path();
  options.png = directory / "x.png";
  std::string words;
  try {
    view(options);
  } catch (const InputError& error) {
    words = error.what();
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(words.find("apt-get install chromium"), std::string::npos) << words;
  EXPECT_TRUE(std::filesystem::exists(directory / "report.html"));
  EXPECT_FALSE(std::filesystem::exists(directory / "x.png"));
}

TEST(View, ABrowserThatEndsAtOnceIsReported) {
  const TemporaryDirectory directory;
  write_results(directory.path());
  ::setenv("KARCHER_CHROMIUM", "/bin/false", 1);
  ViewOptions options;
  options.directory = directory.path();
  options.png = directory / "x.png";
  EXPECT_THROW(view(options), Error);
  ::setenv("KARCHER_CHROMIUM", "/no/such/program", 1);
  EXPECT_THROW(view(options), Error);
  ::unsetenv("KARCHER_CHROMIUM");
  EXPECT_FALSE(std::filesystem::exists(directory / "x.png"));
}

}  // namespace
}  // namespace karcher::app
