#include "karcher/io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "temporary_directory.hpp"

namespace karcher {
namespace {

TEST(AtomicFile, IsWrittenBesideALinkInItsPlaceNotThroughIt) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "other") << "other";
  const std::string unfinished = ".file." + std::to_string(::getpid()) + ".part";
  std::filesystem::create_symlink(directory / "other", directory / unfinished);
  std::filesystem::create_symlink(directory / "other", directory / "file");
  write_atomically(directory / "file", "new");
  EXPECT_EQ(read_whole(directory / "other"), "other");
  EXPECT_EQ(read_whole(directory / "file"), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(directory / "file"));
}

}  // namespace
}  // namespace karcher
