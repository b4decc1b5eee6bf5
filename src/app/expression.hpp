#pragma once
/// \file
/// Expressions of problem files: functions of the reference point (x, y, z), the load parameter t and the names of [parameters]. The language and the evaluation
/// are those of the room `expression` (karcher/expression/symbols.hpp); here, errors get their places in the file and values must be finite.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "karcher/energy/parameter.hpp"
#include "karcher/expression/symbols.hpp"
#include "karcher/math/dual.hpp"
#include "karcher/math/tensor.hpp"
#include "karcher/place.hpp"

namespace karcher::app {

/// Immutable, so threads may share it.
class Expression {
 public:
  Expression() : Expression(0.0) {}
  Expression(double constant);

  /// \throws InputError naming key, place and point where the value, or that of a parameter that it uses, is not finite
  double operator()(const Vec3<double>& x, double t) const;
  bool is_constant() const;
  double constant() const { return (*this)({}, 0); }
  bool uses_t() const;
  bool uses_point() const;

  /// Value and derivatives in x, y, z by automatic differentiation. \throws InputError naming key, place and point where they are not finite
  Dual<double, 3> derivative(const Vec3<double>& x, double t) const;

  ParameterValue parameter() const;

 private:
  friend class Scope;
  struct Source;
  struct State;
  std::shared_ptr<const State> state_;
};

/// The names that expressions may use.
class Scope {
 public:
  Scope();
  /// Makes a name known to the expressions compiled later. \throws InputError if the name is not a name, or is taken
  void define(const std::string& name, const Expression& value, const Place& place);
  /// Operations, with those of the parameters that they use, that all expressions of a file may have: a chain of parameters makes each of its uses long.
  static constexpr std::size_t most_operations = 10000000;
  /// \param key for messages \param place of the first character of the text \throws InputError with the place of the error, or if there are too many operations
  Expression compile(const std::string& text, const std::string& key, const Place& place) const;
  /// Counts operations of a text that somebody else compiles. \throws InputError if there are too many
  void count(std::size_t operations, const std::string& key, const Place& place) const;
  std::vector<std::string> names() const { return symbols_.names(); }
  bool is_taken(const std::string& name) const { return symbols_.is_taken(name); }
  /// Name and value of every parameter.
  std::vector<std::pair<std::string, Expression>> parameters() const;

 private:
  Symbols symbols_;
  std::size_t first_parameter_;
  mutable std::size_t operations_ = 0;              ///< of all expressions that were compiled
  std::map<std::uint32_t, Expression> parameters_;  ///< those that are not constant, by symbol
};

}  // namespace karcher::app
