#include "karcher/io/directory_lock.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "karcher/error.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

std::string refusal(const std::filesystem::path& directory) {
  try {
    const DirectoryLock lock(directory);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(DirectoryLock, ASecondHolderIsToldTheFirst) {
  const TemporaryDirectory directory;
  {
    const DirectoryLock lock(directory / "new/results");
    const std::string text = refusal(directory / "new/results");
    EXPECT_NE(text.find("Another run writes into " + (directory / "new/results").string() + " (process " + std::to_string(::getpid()) + ", since 20"),
              std::string::npos)
        << text;
    EXPECT_EQ(refusal(directory / "other"), "");
  }
  EXPECT_EQ(refusal(directory / "new/results"), "");
  EXPECT_FALSE(std::filesystem::exists(directory / "new/results/.lock"));
}

TEST(DirectoryLock, WhatAKilledProcessLeftLocksNothing) {
  const TemporaryDirectory directory;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const DirectoryLock lock(directory.path());
    if (::write(ready[1], "x", 1) == 1) ::pause();
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_NE(refusal(directory.path()).find("(process " + std::to_string(child) + ", since "), std::string::npos);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(std::filesystem::exists(directory / ".lock"));
  const DirectoryLock lock(directory.path());
  EXPECT_NE(refusal(directory.path()).find("(process " + std::to_string(::getpid()) + ", since "), std::string::npos);
}

TEST(DirectoryLock, ADirectoryThatCannotBeMadeIsAnErrorInTheInput) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file") << "x";
  EXPECT_NE(refusal(directory / "file/results").find("cannot be made: "), std::string::npos);
}

}  // namespace
}  // namespace karcher
