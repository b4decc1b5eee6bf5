#pragma once
/// \file
/// The content of a problem file: a tree of values that know their places, tables in the order of the file. What toml++ reads, with --set applied, becomes this
/// tree; and this tree is written as problem.resolved.toml.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "karcher/place.hpp"

namespace karcher::app {

struct Entry;

struct Value {
  enum class Kind { boolean, integer, number, text, array, table };
  Kind kind = Kind::table;
  Place place;
  bool boolean = false;
  long long integer = 0;
  double number = 0;
  std::string text;
  int text_line = 0, text_column = 0;  ///< of the first character of a text, from `place`
  std::vector<Value> items;            ///< of an array
  std::vector<Entry> entries;          ///< of a table

  static Value of(bool b);
  static Value of(long long i);
  static Value of(int i) { return of(static_cast<long long>(i)); }
  static Value of(double d);
  static Value of(std::string s);
  static Value of(const char* s) { return of(std::string(s)); }
  static Value of(std::vector<Value> array);

  bool is(Kind k) const { return kind == k; }
  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  double as_double() const { return kind == Kind::integer ? static_cast<double>(integer) : number; }
  /// Of the first character of a text.
  Place text_place() const {
    if (place.line == 0) return place;
    return text_line > 0 ? Place{place.file, place.line + text_line, 1} : place.shifted(text_column);
  }
  /// Entry of a table; null if there is none.
  const Entry* find(const std::string& key) const;
  Entry* find(const std::string& key);
  /// Appends an entry to a table.
  Entry& append(std::string key, Place at, Value value);
  /// "a table", "a number", "a string", ...
  std::string kind_name() const;
};

struct Entry {
  std::string key;
  Place place;
  Value value;
};

/// \param overrides "key=value" with dotted keys, array elements by number from 0 ("energies.0.thickness=0.1"); the value is TOML, or else a string. A single
///                  name that is not a section means parameters.NAME.
/// \throws InputError naming file, line and column
Value read_toml(const std::filesystem::path& file, std::span<const std::string> overrides);

/// A table as TOML text, entries in their order. Numbers read back to the same double.
std::string to_toml(const Value& table);

}  // namespace karcher::app
