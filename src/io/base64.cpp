#include "io/base64.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "karcher/error.hpp"

namespace karcher {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;
// Doubles compress little; the fastest level is within a few per cent of the best and several times faster.
constexpr int level = 1;
constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

void append_base64(std::string& out, const void* data, std::size_t size) {
  const auto* b = static_cast<const unsigned char*>(data);
  const std::size_t begin = out.size();
  out.resize(begin + (size + 2) / 3 * 4);
  char* o = out.data() + begin;
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t n = std::min<std::size_t>(3, size - i);
    const unsigned bits = unsigned{b[i]} << 16 | (n > 1 ? unsigned{b[i + 1]} << 8 : 0U) | (n > 2 ? unsigned{b[i + 2]} : 0U);
    *o++ = digits[bits >> 18];
    *o++ = digits[bits >> 12 & 63];
    *o++ = n > 1 ? digits[bits >> 6 & 63] : '=';
    *o++ = n > 2 ? digits[bits & 63] : '=';
  }
}

void append_compressed(std::string& out, const void* data, std::size_t size) {
  const auto* b = static_cast<const Bytef*>(data);
  const std::size_t blocks = (size + block_size - 1) / block_size;
  std::vector<std::uint64_t> header{blocks, block_size, size % block_size};
  std::vector<Bytef> compressed;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t raw = std::min(block_size, size - i * block_size), begin = compressed.size();
    uLongf got = compressBound(static_cast<uLong>(raw));
    compressed.resize(begin + got);
    if (compress2(compressed.data() + begin, &got, b + i * block_size, static_cast<uLong>(raw), level) != Z_OK)
      throw Error("zlib could not compress a block of results: out of memory.");
    compressed.resize(begin + got);
    header.push_back(got);
  }
  append_base64(out, header.data(), header.size() * sizeof(std::uint64_t));
  append_base64(out, compressed.data(), compressed.size());
}

namespace {

std::size_t encoded_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// Decodes `size` bytes from the beginning of text and removes what was read.
bool take_base64(std::string_view& text, std::size_t size, std::string& bytes) {
  static const auto values = [] {
    std::array<int, 256> table{};
    table.fill(-1);
    for (std::size_t i = 0; i < 64; ++i) table[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    return table;
  }();
  const std::size_t length = encoded_size(size);
  if (text.size() < length) return false;
  bytes.clear();
  for (std::size_t i = 0; i < length; i += 4) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = bytes.size() + (k == 0 ? 0 : k - 1) >= size;  // beyond the last byte
      const int v = padding ? 0 : values[static_cast<unsigned char>(text[i + k])];
      if (v < 0) return false;
      bits = bits << 6 | static_cast<unsigned>(v);
    }
    for (int shift = 16; shift >= 0 && bytes.size() < size; shift -= 8) bytes += static_cast<char>(bits >> shift & 255);
  }
  text.remove_prefix(length);
  return true;
}

std::uint64_t number_at(const std::string& bytes, std::size_t i) {
  std::uint64_t n = 0;
  std::memcpy(&n, bytes.data() + i * sizeof n, sizeof n);
  return n;
}

}  // namespace

bool read_compressed(std::string_view text, std::string& bytes) {
  // The header is one piece of base64, so its length is read first from its beginning.
  std::string header;
  std::string_view beginning = text;
  if (!take_base64(beginning, 3 * sizeof(std::uint64_t), header)) return false;
  const std::uint64_t blocks = number_at(header, 0), whole = number_at(header, 1), last = number_at(header, 2);
  if (blocks > text.size() || whole != block_size || last >= block_size) return false;
  if (!take_base64(text, (3 + blocks) * sizeof(std::uint64_t), header)) return false;
  std::size_t total = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::uint64_t size = number_at(header, 3 + i);
    if (size > text.size()) return false;
    total += size;
  }
  std::string compressed;
  if (!take_base64(text, total, compressed) || !text.empty()) return false;
  bytes.clear();
  std::size_t begin = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t raw = i + 1 == blocks && last > 0 ? last : block_size, old = bytes.size(), size = number_at(header, 3 + i);
    bytes.resize(old + raw);
    uLongf got = raw;
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + old), &got, reinterpret_cast<const Bytef*>(compressed.data() + begin), size) != Z_OK ||
        got != raw)
      return false;
    begin += size;
  }
  return true;
}

}  // namespace karcher
