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
constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
// Deflate makes no more than 1032 bytes of one (zlib, technical details).
constexpr std::size_t largest_ratio = 1032;

[[noreturn]] void broken() { throw InputError("its compressed data are damaged"); }

std::array<int, 256> digit_values() {
  std::array<int, 256> value;
  value.fill(-1);
  for (std::size_t i = 0; i < digits.size(); ++i) value[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  return value;
}

/// The bytes of a whole number of groups of four digits.
std::string decode_base64(std::string_view text) {
  static const std::array<int, 256> value = digit_values();
  if (text.size() % 4 != 0) broken();
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const std::size_t padding = i + 4 < text.size() || text[i + 3] != '=' ? 0 : text[i + 2] != '=' ? 1 : 2;
    unsigned bits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const int digit = k + padding >= 4 ? 0 : value[static_cast<unsigned char>(text[i + k])];
      if (digit < 0) broken();
      bits = bits << 6 | static_cast<unsigned>(digit);
    }
    for (std::size_t k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 255);
  }
  return bytes;
}

/// The first `count` numbers of the bytes; padding in the middle of the text may have left fewer.
std::vector<std::uint64_t> numbers(std::string_view bytes, std::size_t count) {
  if (bytes.size() < count * sizeof(std::uint64_t)) broken();
  std::vector<std::uint64_t> n(count);
  std::memcpy(n.data(), bytes.data(), count * sizeof(std::uint64_t));
  return n;
}

constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

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

std::string read_compressed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == text.npos) broken();
  text = text.substr(begin, text.find_last_not_of(space) - begin + 1);
  // The number of blocks tells how long the header is.
  constexpr std::size_t first = base64_size(sizeof(std::uint64_t));
  if (text.size() < first) broken();
  const std::uint64_t blocks = numbers(decode_base64(text.substr(0, 8)) + decode_base64(text.substr(8, 4)), 1)[0];
  if (blocks > text.size()) broken();
  const std::size_t header_size = base64_size((3 + blocks) * sizeof(std::uint64_t));
  if (text.size() < header_size) broken();
  const std::vector<std::uint64_t> header = numbers(decode_base64(text.substr(0, header_size)), 3 + blocks);
  const std::string compressed = decode_base64(text.substr(header_size));
  std::string bytes;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint64_t raw = b + 1 == blocks && header[2] > 0 ? header[2] : header[1], packed = header[3 + b];
    if (packed > compressed.size() - at || raw / largest_ratio > packed) broken();
    const std::size_t old = bytes.size();
    bytes.resize(old + raw);
    uLongf got = static_cast<uLongf>(raw);
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + old), &got, reinterpret_cast<const Bytef*>(compressed.data() + at),
                   static_cast<uLong>(packed)) != Z_OK ||
        got != raw)
      broken();
    at += packed;
  }
  if (at != compressed.size()) broken();
  return bytes;
}

}  // namespace karcher
