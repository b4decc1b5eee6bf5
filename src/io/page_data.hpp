#pragma once
/// \file
/// The data of a page: a JSON header and arrays of numbers, as viewer/src/data.ts reads them (the same format in TypeScript).
///
/// The page holds base64 of a zlib stream of: "KARCHER1" | u32 number of header bytes (little endian) | header (JSON, UTF-8) | arrays.
/// Offsets of arrays count from the first byte after the header. An array is a block of `count` tuples of `components` numbers, stored component after
/// component and within a component byte plane after byte plane (low bytes first), since bytes of one weight compress well together:
///   u16  zigzag differences (modulo 2^16) of successive quantised values q; value = low + q (high - low) / 65534, q = 65535: not a number;
///        low and high by component
///   u32  zigzag differences (modulo 2^32) of successive values
///   f32  IEEE single precision

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace karcher {

class PageArrays {
 public:
  /// Each appends an array and returns its number. values: tuple after tuple. In add_quantised a value that is not finite becomes "not a number".
  int add_quantised(std::span<const float> values, int components = 1);
  int add_floats(std::span<const float> values, int components = 1);
  int add_integers(std::span<const std::uint32_t> values, int components = 1);

  /// The whole text for the page's data element. The header gets the key "arrays".
  /// \throws Error if zlib refuses (no memory)
  std::string packed(nlohmann::ordered_json header) const;

 private:
  int add(const char* type, std::size_t values, int components);

  nlohmann::ordered_json infos_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

}  // namespace karcher
