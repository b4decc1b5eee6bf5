#include "karcher/io/row_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

/// While it lives, files of this process have at most so many bytes: a write beyond is cut off, as on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(RowFile, ARowThatAFullDiskCutsOffIsTakenBackAndTheNextOneFollowsTheLastWholeOne) {
  const TemporaryDirectory directory;
  RowFile rows(directory / "rows", "head\n");
  rows.append("one\n");
  {
    const SmallDisk disk(12);  // room for half of the next row
    EXPECT_THROW(rows.append("second\n"), Error);
  }
  EXPECT_EQ(read_whole(directory / "rows"), "head\none\n");
  rows.append("two\n");
  EXPECT_EQ(read_whole(directory / "rows"), "head\none\ntwo\n");
}

TEST(RowFile, HalfARowAtTheEndIsLeftOut) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "rows") << "a\nb\nhal";
  EXPECT_EQ(whole_rows(directory / "rows"), "a\nb\n");
  std::ofstream(directory / "half") << "hal";
  EXPECT_EQ(whole_rows(directory / "half"), "");
}

}  // namespace
}  // namespace karcher
