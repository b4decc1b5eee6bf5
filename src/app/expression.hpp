#pragma once
/// \file
/// Expressions of problem files: functions of the reference point (x, y, z), the load parameter t and the names of [parameters].
///
/// Grammar and precedence are muParser's (https://beltoforion.de/en/muparser/): + - * / ^, < > <= >= == !=, && ||, c ? a : b, and its functions; besides
/// them pow(a, b), floor, ceil and mod(a, b) = a - b floor(a/b), and the constant pi. Assignments and lists are refused.
/// Not thread-safe, as muParser is not.

#include <memory>
#include <string>
#include <vector>

#include "app/place.hpp"
#include "karcher/energy/parameter.hpp"
#include "karcher/math/dual.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher::app {

struct Node;  // of the differentiable form, see expression_tree.hpp

class Expression {
 public:
  Expression() : Expression(0.0) {}
  Expression(double constant);

  /// \throws InputError naming key, place and point where the value is not finite
  double operator()(const Vec3<double>& x, double t) const;
  bool is_constant() const;
  double constant() const { return (*this)({}, 0); }
  bool uses_t() const;
  bool uses_point() const;

  /// Value and derivatives in x, y, z by automatic differentiation. \throws InputError as above
  Dual<double, 3> derivative(const Vec3<double>& x, double t) const;

  ParameterValue parameter() const;

 private:
  friend class Scope;
  struct State;
  std::shared_ptr<State> state_;
};

/// The names that expressions may use.
class Scope {
 public:
  /// Makes a name known to the expressions compiled later. \throws InputError if the name is not a name, or is taken
  void define(const std::string& name, Expression value, const Place& place);
  /// \param key for messages \param place of the first character of the text \throws InputError with the place of the error
  Expression compile(const std::string& text, const std::string& key, const Place& place) const;
  std::vector<std::string> names() const;

 private:
  std::vector<std::pair<std::string, Expression>> parameters_;
};

}  // namespace karcher::app
