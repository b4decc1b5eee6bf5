#include "karcher/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "karcher/error.hpp"

namespace karcher {
namespace {

/// Closes a descriptor and removes an unfinished file whatever happens.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;
  bool keep = false;
  ~TemporaryFile() {
    if (descriptor >= 0) ::close(descriptor);
    if (!keep) ::unlink(path.c_str());
  }
};

[[noreturn]] void refuse(const std::filesystem::path& path, int error) {
  throw Error(fmt::format("The file {} cannot be written: {}.", path.string(), std::strerror(error)));
}

void write_all(int descriptor, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  TemporaryFile file{directory / fmt::format(".{}.{}.part", path.filename().string(), ::getpid())};
  // What has that name is of a killed process of the same number, or somebody else's trap: it is removed, never followed or written into.
  ::unlink(file.path.c_str());
  file.descriptor = ::open(file.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file.descriptor < 0) refuse(path, errno);
  write_all(file.descriptor, content, path);
  if (::fsync(file.descriptor) != 0 && errno != EINVAL && errno != EROFS) refuse(path, errno);
  const int closed = ::close(file.descriptor);
  file.descriptor = -1;
  if (closed != 0) refuse(path, errno);
  if (::rename(file.path.c_str(), path.c_str()) != 0) refuse(path, errno);
  file.keep = true;
}

std::string read_whole(const std::filesystem::path& path, std::size_t most) {
  const auto refuse_reading = [&] { return InputError(fmt::format("The file {} cannot be read: {}.", path.string(), std::strerror(errno))); };
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw refuse_reading();
  std::string content;
  char buffer[1 << 16];
  std::size_t got = 0;
  while (content.size() <= most && (got = std::fread(buffer, 1, sizeof buffer, file)) > 0) content.append(buffer, got);
  const bool bad = std::ferror(file) != 0;
  const int error = errno;
  std::fclose(file);
  errno = error;
  if (bad) throw refuse_reading();
  if (content.size() > most) throw InputError(fmt::format("The file {} has more than {} bytes.", path.string(), most));
  return content;
}

}  // namespace karcher
