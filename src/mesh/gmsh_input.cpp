#include "mesh/gmsh_input.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "karcher/error.hpp"
#include "karcher/memory.hpp"

namespace karcher {

GmshInput::GmshInput(std::string path) : path_(std::move(path)) {
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(path_, unknown);
  if (std::filesystem::is_directory(status)) throw InputError("The mesh file \"" + path_ + "\" is a directory.");
  // A device or a pipe has no end, or none that is known.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError("The mesh file \"" + path_ + "\" is no file but a device or a pipe.");
  std::ifstream file(path_, std::ios::binary | std::ios::ate);
  if (!file) throw InputError("Cannot open the mesh file \"" + path_ + "\".");
  const std::streamoff size = file.tellg();
  if (size < 0) throw InputError("Cannot read the mesh file \"" + path_ + "\".");
  // The cells of the mesh take at least as much as the file, which is kept beside them.
  require_memory(2 * static_cast<double>(size), "The mesh file \"" + path_ + "\"");
  text_.resize(static_cast<std::size_t>(size));
  file.seekg(0);
  if (!file.read(text_.data(), size)) throw InputError("Cannot read the mesh file \"" + path_ + "\".");
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text_.starts_with(mark)) position_ = mark.size();
}

void GmshInput::fail(const std::string& sentence) const {
  const auto here = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position_, text_.size()));
  const std::string where = section.empty() ? "" : ", section $" + section;
  if (binary) throw InputError(path_ + where + ": " + sentence);
  throw InputError(path_ + ":" + std::to_string(1 + std::count(text_.begin(), here, '\n')) + where + ": " + sentence);
}

std::int64_t GmshInput::count(std::int64_t n, const char* what, std::int64_t least_bytes_each) const {
  if (n < 0) fail("the number of " + std::string(what) + " is negative.");
  if (n > bytes_left() / least_bytes_each)
    fail("the file announces " + std::to_string(n) + " " + what + " but ends too early; it seems to be truncated.");
  return n;
}

void GmshInput::skip_space() {
  while (position_ < text_.size() && std::strchr(" \t\r\n", text_[position_])) ++position_;
}

bool GmshInput::at_end() {
  skip_space();
  return position_ == text_.size();
}

std::string_view GmshInput::word() {
  skip_space();
  const std::size_t begin = position_;
  while (position_ < text_.size() && !std::strchr(" \t\r\n", text_[position_])) ++position_;
  if (position_ == begin) fail("the file ends too early; it seems to be truncated.");
  return std::string_view(text_).substr(begin, position_ - begin);
}

bool GmshInput::next_is(std::string_view expected) {
  skip_space();
  const std::size_t begin = position_;
  if (!at_end() && word() == expected) return true;
  position_ = begin;
  return false;
}

std::string_view GmshInput::line() {
  const std::size_t begin = position_;
  position_ = std::min(text_.find('\n', position_), text_.size());
  std::string_view rest = std::string_view(text_).substr(begin, position_ - begin);
  while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ')) rest.remove_suffix(1);
  return rest;
}

std::string GmshInput::quoted() {
  skip_space();
  if (position_ == text_.size() || text_[position_] != '"') fail("a name in quotation marks is missing.");
  const std::size_t begin = ++position_, end = text_.find_first_of("\"\n", begin);
  if (end == std::string::npos || text_[end] != '"') fail("a quotation mark is missing at the end of a name.");
  position_ = end + 1;
  return text_.substr(begin, end - begin);
}

void GmshInput::skip_line_end() {
  while (position_ < text_.size() && (text_[position_] == ' ' || text_[position_] == '\r')) ++position_;
  if (position_ < text_.size() && text_[position_] == '\n') ++position_;
}

template <class T>
T GmshInput::parse(std::string_view token, const char* what) const {
  T value{};
  std::string_view digits = token;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    fail(std::string(what) + " is expected, not \"" + std::string(token.substr(0, 40)) + "\".");
  return value;
}

template <class T>
T GmshInput::raw() {
  if (text_.size() - position_ < sizeof(T)) fail("the file ends too early; it seems to be truncated.");
  T value;
  std::memcpy(&value, text_.data() + position_, sizeof(T));
  position_ += sizeof(T);
  return value;
}

int GmshInput::text_integer() { return parse<int>(word(), "a whole number"); }
double GmshInput::text_real() { return parse<double>(word(), "a number"); }
int GmshInput::integer() { return binary ? raw<std::int32_t>() : text_integer(); }
std::int64_t GmshInput::size() { return binary ? raw<std::int64_t>() : parse<std::int64_t>(word(), "a whole number"); }
double GmshInput::real() { return binary ? raw<double>() : text_real(); }

void GmshInput::end_section(bool skipping) {
  const std::string end = "$End" + section;
  if (skipping) {
    const std::size_t found = text_.find("\n" + end, position_);
    if (found == std::string::npos) {
      position_ = text_.size();
      fail("the line " + end + " is missing; the file seems to be truncated.");
    }
    position_ = found + 1 + end.size();
  } else {
    if (at_end()) fail("the line " + end + " is missing; the file seems to be truncated.");
    const std::string_view found = word();
    if (found != end) fail(end + " is expected, not \"" + std::string(found.substr(0, 40)) + "\".");
  }
  section.clear();
}

}  // namespace karcher
