#include "io/binary.hpp"

#include <zlib.h>

#include <bit>

#include "karcher/error.hpp"

namespace karcher {

static_assert(std::endian::native == std::endian::little, "files are little-endian and are written as the machine holds its numbers");

std::string_view BinaryReader::take(std::uint64_t count, std::uint64_t components, std::uint64_t size) {
  // In quotients: a product of lengths that a file tells can be more than 64 bits hold.
  if (count > 0 && components > bytes_.size() / size / count) throw InputError(too_short_);
  const std::string_view piece = bytes_.substr(0, count * components * size);
  bytes_.remove_prefix(piece.size());
  return piece;
}

std::uint32_t check_sum(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace karcher
