#include "io/page_data.hpp"

#include <zlib.h>

#include <bit>
#include <cmath>

#include "io/base64.hpp"
#include "karcher/error.hpp"

namespace karcher {
namespace {

constexpr std::uint32_t not_a_number = 65535, largest = 65534;

/// Writes words[i] of one component as byte planes.
template <class Word>
void append_planes(std::string& out, const std::vector<Word>& words, int bytes) {
  for (int b = 0; b < bytes; ++b)
    for (const Word w : words) out += static_cast<char>((w >> (8 * b)) & 0xff);
}

}  // namespace

int PageArrays::add(const char* type, std::size_t values, int components) {
  infos_.push_back({{"type", type}, {"count", values / static_cast<std::size_t>(components)}, {"components", components}, {"offset", bytes_.size()}});
  return static_cast<int>(infos_.size()) - 1;
}

int PageArrays::add_quantised(std::span<const float> values, int components) {
  const int index = add("u16", values.size(), components);
  const auto stride = static_cast<std::size_t>(components);
  nlohmann::ordered_json low = nlohmann::ordered_json::array(), high = low;
  std::vector<std::uint16_t> words(values.size() / stride);
  for (std::size_t c = 0; c < stride; ++c) {
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (std::size_t i = c; i < values.size(); i += stride) {
      if (!std::isfinite(values[i])) continue;
      from = std::min(from, static_cast<double>(values[i]));
      to = std::max(to, static_cast<double>(values[i]));
    }
    if (from > to) from = to = 0;
    low.push_back(from);
    high.push_back(to);
    const double scale = to > from ? largest / (to - from) : 0;
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const float v = values[i * stride + c];
      const std::uint32_t q = std::isfinite(v) ? static_cast<std::uint32_t>((v - from) * scale + 0.5) : not_a_number;
      const auto difference = static_cast<std::int16_t>(static_cast<std::uint16_t>(q - last));
      words[i] = static_cast<std::uint16_t>((difference << 1) ^ (difference >> 15));
      last = q;
    }
    append_planes(bytes_, words, 2);
  }
  infos_.back()["low"] = std::move(low);
  infos_.back()["high"] = std::move(high);
  return index;
}

int PageArrays::add_floats(std::span<const float> values, int components) {
  const int index = add("f32", values.size(), components);
  const auto stride = static_cast<std::size_t>(components);
  std::vector<std::uint32_t> words(values.size() / stride);
  for (std::size_t c = 0; c < stride; ++c) {
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = std::bit_cast<std::uint32_t>(values[i * stride + c]);
    append_planes(bytes_, words, 4);
  }
  return index;
}

int PageArrays::add_integers(std::span<const std::uint32_t> values, int components) {
  const int index = add("u32", values.size(), components);
  const auto stride = static_cast<std::size_t>(components);
  std::vector<std::uint32_t> words(values.size() / stride);
  for (std::size_t c = 0; c < stride; ++c) {
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::uint32_t v = values[i * stride + c];
      const auto difference = static_cast<std::int32_t>(v - last);
      words[i] = (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
      last = v;
    }
    append_planes(bytes_, words, 4);
  }
  return index;
}

std::string PageArrays::packed(nlohmann::ordered_json header) const {
  header["arrays"] = infos_;
  // Text that is not UTF-8 (a title from anywhere) is shown with replacement characters rather than refused.
  const std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string plain = "KARCHER1";
  for (int b = 0; b < 4; ++b) plain += static_cast<char>((text.size() >> (8 * b)) & 0xff);
  plain += text;
  plain += bytes_;
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::string compressed(size, '\0');
  // Level 5: within 2 % of the best size at half the time.
  if (compress2(reinterpret_cast<Bytef*>(compressed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()), static_cast<uLong>(plain.size()),
                5) != Z_OK)
    throw Error("The data of the page cannot be compressed: there is not enough memory.");
  std::string out;
  append_base64(out, compressed.data(), size);
  return out;
}

}  // namespace karcher
