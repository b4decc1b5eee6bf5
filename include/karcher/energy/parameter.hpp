#pragma once
/// \file
/// Parameters of energies: numbers of a problem, or functions of the place and the load parameter.

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "karcher/manifold/any_manifold.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

/// A number of the problem: constant, or a function of the reference point x and the load parameter t.
struct ParameterValue {
  double constant = 0;
  std::function<double(const Vec3<double>& x, double t)> function;  ///< empty: constant
  bool depends_on_t = false;

  ParameterValue() = default;
  ParameterValue(double c) : constant(c) {}
  double operator()(const Vec3<double>& x, double t) const { return function ? function(x, t) : constant; }
  /// Whether it is this number everywhere and always.
  bool is(double c) const { return !function && constant == c; }
};

using ParameterValues = std::map<std::string, ParameterValue>;

/// Holds where a choice of the energy is one of these words.
struct Condition {
  std::string choice;
  std::vector<std::string> words;

  bool holds(const std::map<std::string, std::string>& choices) const {
    const auto chosen = choices.find(choice);
    return chosen != choices.end() && std::find(words.begin(), words.end(), chosen->second) != words.end();
  }
};

/// Description of one parameter. A parameter with size > 1 is an array of numbers; keys in ParameterValues are then "b[0]", "b[1]", ...
struct Parameter {
  std::string name;
  std::string unit;                     ///< in consistent units, e.g. "length", "force/length^2", "1"
  std::string description;              ///< one line
  std::optional<double> default_value;  ///< none: must be given
  double minimum = -std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;      ///< false: must be greater than minimum
  int size = 1;                     ///< Parameter::ambient: as many as the first field has ambient coordinates
  bool point = false;               ///< the numbers are a point of the first field's manifold, written like an initial value
  bool uniform = false;             ///< the same everywhere: no function of the place
  std::optional<Condition> only{};  ///< there is no such parameter where this does not hold
  static constexpr int ambient = -1;
};

}  // namespace karcher
