#pragma once
/// \file
/// Numbers out of an MSH file, ASCII or binary, with errors that say where.

#include <cstdint>
#include <string>
#include <string_view>

namespace karcher {

class GmshInput {
 public:
  /// Reads the whole file, without a byte order mark. \throws InputError if it cannot be opened or is no regular file
  explicit GmshInput(std::string path);

  const std::string& path() const { return path_; }
  bool binary = false;
  /// Name of the section being read, for messages.
  std::string section;

  /// The next number, whatever its width in binary files.
  int integer();        ///< 4 bytes
  std::int64_t size();  ///< 8 bytes
  double real();

  // Text, which binary files contain too.
  std::string_view word();              ///< up to white space
  std::string_view line();              ///< the rest of the line
  bool next_is(std::string_view word);  ///< then it is taken
  int text_integer();
  double text_real();
  std::string quoted();  ///< "..."
  /// After the line end that precedes binary data.
  void skip_line_end();

  bool at_end();  ///< nothing but white space is left
  /// Past the line `$End<section>`. \throws InputError if it does not come (skipping: next, otherwise at all)
  void end_section(bool skipping);

  /// An upper bound for counts, so that a damaged number is not taken for a size.
  std::int64_t bytes_left() const { return static_cast<std::int64_t>(text_.size() - position_); }
  /// \throws InputError "path:line: sentence" or "path, section $Nodes: sentence"
  [[noreturn]] void fail(const std::string& sentence) const;
  /// A count of items. \throws InputError if it is negative or the file is too short for as many
  std::int64_t count(std::int64_t n, const char* what, std::int64_t least_bytes_each) const;

 private:
  void skip_space();
  template <class T>
  T raw();
  template <class T>
  T parse(std::string_view token, const char* what) const;

  std::string path_, text_;
  std::size_t position_ = 0;
};

}  // namespace karcher
