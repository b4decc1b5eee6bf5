#include "karcher/io/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string>

#include "karcher/error.hpp"

namespace karcher {
namespace {

/// What the holder wrote; empty while it has not yet.
std::string holder(int descriptor) {
  std::array<char, 200> text{};
  const ssize_t got = ::pread(descriptor, text.data(), text.size(), 0);
  return got > 0 ? std::string(text.data(), static_cast<std::size_t>(got)) : std::string("process unknown");
}

/// Whether the path still names the open file: its last holder may have removed it before it was locked here.
bool is_same_file(int descriptor, const std::filesystem::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

}  // namespace

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) : file_(directory / ".lock") {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) throw InputError(fmt::format("The directory of results, {}, cannot be made: {}.", directory.string(), code.message()));
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0)
      throw InputError(fmt::format("The directory of results, {}, cannot be written to: {}.", directory.string(), std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) continue;
    // Where the file system has no locks, there is none to be had.
    if (errno != EWOULDBLOCK) break;
    const std::string who = holder(descriptor_);
    ::close(descriptor_);
    throw InputError(
        fmt::format("Another run writes into {} ({}). Wait for it, or choose another directory with --output.", directory.string(), who));
  } while (!is_same_file(descriptor_, file_));
  const std::time_t now = std::time(nullptr);
  const std::string text = fmt::format("process {}, since {:%Y-%m-%d %H:%M:%S}", ::getpid(), fmt::localtime(now));
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, text.data(), text.size(), 0) < 0) return;  // a lock without a name
}

DirectoryLock::~DirectoryLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace karcher
