#pragma once
/// \file
/// A table of a problem file while it is read: refuses unknown keys, checks types, fills in defaults, and notes down what it answered, which becomes
/// problem.resolved.toml.

#include <optional>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/toml_value.hpp"

namespace karcher::app {

class Section {
 public:
  /// \param table  null: the table is not there, everything has its default
  /// \param path   "solver", "energies.0"
  /// \param place  of the table, or of what lacks it
  /// \param allowed keys \throws InputError for a key that is not allowed, or if it is no table
  Section(const Value* table, std::string path, Place place, std::vector<std::string> allowed);

  bool has(const std::string& key) const { return table_ && table_->find(key); }
  const std::string& path() const { return path_; }
  std::string path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  /// Of the value if it is given, else of the table.
  Place place(const std::string& key) const;
  const Place& place() const { return place_; }

  // Without a default the key must be given.
  std::string text(const std::string& key, const std::optional<std::string>& standard = {});
  std::string word(const std::string& key, const std::vector<std::string>& words, const std::optional<std::string>& standard = {});
  bool flag(const std::string& key, bool standard);
  int integer(const std::string& key, std::optional<int> standard, int minimum, int maximum);
  double number(const std::string& key, std::optional<double> standard);
  /// A number or an expression.
  Expression expression(const std::string& key, const Scope& scope, const std::optional<double>& standard = {});
  /// The same, without x, y, z, t.
  double constant(const std::string& key, const Scope& scope, const std::optional<double>& standard = {});
  /// An array; a single number or expression counts as an array of one.
  std::vector<Expression> expressions(const std::string& key, const Scope& scope, std::size_t size, const std::vector<double>& standard = {});
  std::vector<double> constants(const std::string& key, const Scope& scope, std::size_t size, const std::vector<double>& standard = {});
  /// The value as it is; null if it is not given.
  const Value* raw(const std::string& key);

  /// Notes down a value for the resolved file (replaces an earlier one).
  void note(const std::string& key, Value value);
  const Value& resolved() const { return resolved_; }

  [[noreturn]] void missing(const std::string& key) const;
  [[noreturn]] void wrong_type(const std::string& key, const Value& value, const std::string& expected) const;

 private:
  const Value* given(const std::string& key) const;

  const Value* table_;
  std::string path_;
  Place place_;
  Value resolved_;
};

/// \throws InputError naming the unknown name, the allowed and the nearest
[[noreturn]] void refuse_name(const Place& place, const std::string& what, const std::string& name, const std::vector<std::string>& allowed);
/// The number or expression that a value holds.
Expression expression_of(const Value& value, const std::string& key, const Scope& scope);

}  // namespace karcher::app
