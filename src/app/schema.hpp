#pragma once
/// \file
/// What a problem file may contain: one table of keys. The reader takes names, types, ranges and defaults from it (section.hpp), problem.resolved.toml holds its
/// defaults, `karcher doc` prints it, and docs/problem-file.md has its keys as `karcher doc --markdown` writes them. Keys of generators and energies are in
/// generators(), energy_catalogue() and load_catalogue().

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/toml_value.hpp"

namespace karcher::app {

enum class KeyKind {
  text,
  word,   ///< one of KeyInfo::words
  texts,  ///< an array of texts
  flag,
  integer,  ///< from KeyInfo::minimum to maximum
  number,
  constant,    ///< KeyInfo::size numbers, or expressions without x, y, z and t
  expression,  ///< KeyInfo::size numbers or expressions
  formula,     ///< an expression in which fields have values: density.hpp
  point,       ///< of a manifold: point_value.hpp
  table
};

/// What counts where a key is not given. Made of nothing: the key must be given.
struct Default {
  std::optional<Value> value;  ///< as a file would say it; one number stands for as many as the key has
  std::string words;           ///< where it follows from something else, so that the reader makes it

  Default() = default;
  template <class T>
  Default(const T& standard) : value(Value::of(standard)) {}
  static Default by_reader(std::string words) {
    Default d;
    d.words = std::move(words);
    return d;
  }
  bool must_be_given() const { return !value && words.empty(); }
};

struct KeyInfo {
  std::string name{};
  KeyKind kind = KeyKind::text;
  std::string type{};  ///< the kind in words: "3 expressions"
  Default standard{};
  std::string description{};
  std::string unit{};                ///< empty: none
  std::vector<std::string> words{};  ///< all there are; some may have no meaning beside other keys
  int minimum = 0, maximum = 0;
  std::size_t size = 1;
};

struct SectionInfo {
  std::string name;    ///< "solver"
  std::string header;  ///< "[solver]"
  std::string description;
  std::vector<KeyInfo> keys;
};

const std::vector<SectionInfo>& schema();
const SectionInfo& section_info(const std::string& name);
/// Keys of an energy whose density is a formula.
const std::vector<KeyInfo>& formula_keys();
std::vector<std::string> key_names(const std::vector<KeyInfo>& keys);

}  // namespace karcher::app
