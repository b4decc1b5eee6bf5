#pragma once
/// \file
/// A table of a problem file while it is read, with its part of the table of keys (schema.hpp): refuses unknown keys, checks types and ranges, fills in defaults,
/// and notes down what it answered, which becomes problem.resolved.toml.

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/schema.hpp"
#include "app/toml_value.hpp"

namespace karcher::app {

class Section {
 public:
  /// \param table  null: the table is not there, everything has its default
  /// \param path   "solver", "energies.0"
  /// \param place  of the table, or of what lacks it
  /// \param keys   what it may hold \throws InputError for another key, or if it is no table
  Section(const Value* table, std::string path, Place place, std::vector<KeyInfo> keys);

  bool has(const std::string& key) const { return table_ && table_->find(key); }
  const std::string& path() const { return path_; }
  std::string path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  /// Of the value if it is given, else of the table.
  Place place(const std::string& key) const;
  const Place& place() const { return place_; }

  // Each takes a key of its kind and gives its value, else its default. \throws InputError for a wrong type or range, or if it must be given and is not

  /// \param standard the default, where it follows from other keys; also of a word that somebody else checks
  std::string text(const std::string& key, const std::optional<std::string>& standard = {});
  /// \param words those that have a meaning here; empty: all of the key's
  std::string word(const std::string& key, const std::optional<std::string>& standard = {}, const std::vector<std::string>& words = {});
  /// An array of texts; a single one counts as an array of one.
  std::vector<Value> texts(const std::string& key);
  /// A text that somebody else compiles.
  Value formula(const std::string& key);
  bool flag(const std::string& key);
  int integer(const std::string& key, const std::optional<int>& standard = {});
  double number(const std::string& key);
  /// A number or an expression.
  Expression expression(const std::string& key, const Scope& scope);
  /// The same, without x, y, z, t.
  double constant(const std::string& key, const Scope& scope);
  /// An array; a single number or expression counts as an array of one. \param size 0: the key's
  std::vector<Expression> expressions(const std::string& key, const Scope& scope, std::size_t size = 0);
  std::vector<double> constants(const std::string& key, const Scope& scope);
  /// The value of a point as it is; null if it is not given.
  const Value* raw(const std::string& key);

  /// Notes down a value for the resolved file (replaces an earlier one).
  void note(const std::string& key, Value value);
  const Value& resolved() const { return resolved_; }

  [[noreturn]] void missing(const std::string& key) const;
  [[noreturn]] void wrong_type(const std::string& key, const Value& value, const std::string& expected) const;

 private:
  const Value* given(const std::string& key) const;
  const KeyInfo& info(const std::string& key, std::initializer_list<KeyKind> kinds) const;
  /// What is given, else the default. \throws InputError if there is neither
  const Value& value(const KeyInfo& key) const;
  Expression single(const std::string& key, const Scope& scope, KeyKind kind);
  std::vector<Expression> several(const std::string& key, const Scope& scope, KeyKind kind, std::size_t size);
  double constant_of(const std::string& key, const Expression& e) const;

  const Value* table_;
  std::string path_;
  Place place_;
  std::vector<KeyInfo> keys_;
  Value resolved_;
};

/// \throws InputError where `name` cannot be that of a region, a field or the like.
void check_name(const Place& place, const std::string& what, const std::string& name);

/// \throws InputError naming the unknown name, the allowed and the nearest
[[noreturn]] void refuse_name(const Place& place, const std::string& what, const std::string& name, const std::vector<std::string>& allowed);
/// The number or expression that a value holds.
Expression expression_of(const Value& value, const std::string& key, const Scope& scope);

}  // namespace karcher::app
