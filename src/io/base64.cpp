#include "io/base64.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
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

}  // namespace karcher
