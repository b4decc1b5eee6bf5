#pragma once
/// \file
/// Files that grow by whole rows, so that ten thousand load steps do not write ten thousand files: a row is one write of the system, and what a full disk cut off is
/// taken back. A reader, or a kill, at any moment finds whole rows, but for a machine that lost its power: whole_rows() leaves its half row out.

#include <filesystem>
#include <string>
#include <string_view>

namespace karcher {

class RowFile {
 public:
  /// A new file with this content, atomically. Make one on the rank that writes only. \throws Error naming the file if it cannot be written
  RowFile(std::filesystem::path file, std::string_view content);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// \param row  ends with a newline \throws Error if it cannot be written; the file is as it was before
  void append(std::string_view row);
  /// What is written is on the disk. \throws Error
  void flush();

 private:
  [[noreturn]] void refuse(const char* why) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Content of a file of rows up to its last newline. \throws InputError if the file cannot be read
std::string whole_rows(const std::filesystem::path& file);

}  // namespace karcher
