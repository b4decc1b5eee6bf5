#pragma once
/// \file
/// Numbers in files as the machine holds them: little-endian, IEEE.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace karcher {

/// Puts numbers and texts one behind the other. The type of a number is that of the file, so it is always said: writer.number<std::uint32_t>(n).
class BinaryWriter {
 public:
  template <class T>
  void number(std::type_identity_t<T> value) {
    numbers<T>({&value, 1});
  }
  template <class T>
  void numbers(std::type_identity_t<std::span<const T>> values) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  void text(std::string_view text) { bytes_ += text; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes them off again. Whatever lengths a file tells, nothing is read past its end.
class BinaryReader {
 public:
  /// \param bytes     must outlive the reader
  /// \param too_short what the InputError says that is thrown where more is wanted than there is
  BinaryReader(std::string_view bytes, std::string too_short) : bytes_(bytes), too_short_(std::move(too_short)) {}

  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, take(1, 1, sizeof(T)).data(), sizeof(T));
    return value;
  }
  /// `count` tuples of `components` numbers each
  template <class T>
  std::vector<T> numbers(std::uint64_t count, std::uint64_t components = 1) {
    static_assert(std::is_arithmetic_v<T>);
    const std::string_view piece = take(count, components, sizeof(T));
    std::vector<T> values(piece.size() / sizeof(T));
    if (!piece.empty()) std::memcpy(values.data(), piece.data(), piece.size());
    return values;
  }
  std::string_view text(std::uint64_t size) { return take(size, 1, 1); }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view take(std::uint64_t count, std::uint64_t components, std::uint64_t size);

  std::string_view bytes_;
  std::string too_short_;
};

/// CRC-32, as zlib and PNG have it.
std::uint32_t check_sum(std::string_view bytes);

}  // namespace karcher
