// `karcher view` where it makes no picture: without results, without a browser, with a browser that is none.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

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

TEST(View, SettingsThatThePageDoesNotHaveAreRefused) {
  const TemporaryDirectory directory;
  write_results(directory.path());
  const auto told = [&](const std::string& name, const std::string& value) {
    ViewOptions options;
    options.directory = directory.path();
    options.settings = {{name, value}};
    try {
      view(options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(told("edge", "0").find("the page has no setting \"edge\". Did you mean \"edges\"?"), std::string::npos);
  EXPECT_EQ(told("scale", "large"), "--show scale takes a number, not \"large\".");
  EXPECT_EQ(told("edges", "off"), "--show edges takes 0 or 1, not \"off\".");
  EXPECT_FALSE(std::filesystem::exists(directory / "report.html"));
  // All settings of the viewer are known, by their types.
  std::ifstream source(KARCHER_SOURCE_DIR "/viewer/src/view.ts");
  std::string line;
  int members = 0;
  while (std::getline(source, line) && line != "export interface View {") continue;
  while (std::getline(source, line) && line != "}") {
    const std::size_t colon = line.find(':');
    if (!line.ends_with(';') || colon == std::string::npos) continue;
    const std::string name = line.substr(2, colon - 2), type = line.substr(colon + 2);
    if (name == "field" || name == "state") continue;
    ++members;
    EXPECT_EQ(told(name, "1"), "") << name;
    EXPECT_EQ(told(name, "word").empty(), type != "number;" && type != "boolean;") << name;
  }
  EXPECT_GE(members, 17);
}

TEST(View, APictureIsAPng) {
  const TemporaryDirectory directory;
  write_results(directory.path());
  ViewOptions options;
  options.directory = directory.path();
  options.png = directory / "x.svg";
  try {
    view(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("x.svg: pictures are written in the PNG format, so the file must end in .png."), std::string::npos);
  }
}

}  // namespace
}  // namespace karcher::app
