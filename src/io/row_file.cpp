#include "karcher/io/row_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"

namespace karcher {

RowFile::RowFile(std::filesystem::path file, std::string_view content) : file_(std::move(file)) {
  write_atomically(file_, content);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) refuse(std::strerror(errno));
}

RowFile::~RowFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RowFile::append(std::string_view row) {
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  ssize_t written = -1;
  do written = ::write(descriptor_, row.data(), row.size());
  while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(row.size())) return;
  const char* why = written < 0 ? std::strerror(errno) : "the disk is full";
  if (written > 0 && before >= 0 && ::ftruncate(descriptor_, before) != 0) why = "the disk is full, and its last row is not whole";
  refuse(why);
}

void RowFile::flush() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse(std::strerror(errno));
}

void RowFile::refuse(const char* why) const { throw Error(fmt::format("The file {} cannot be written: {}.", file_.string(), why)); }

std::string whole_rows(const std::filesystem::path& file) {
  std::string content = read_whole(file);
  content.resize(content.rfind('\n') + 1);  // npos + 1 = 0
  return content;
}

}  // namespace karcher
