#pragma once
/// \file
/// Parameters of energies: one table per energy that the problem-file reader, `karcher doc` and library users share.

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

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
};

/// Description of one parameter. A parameter with size > 1 is an array of numbers; keys in ParameterValues are then "b[0]", "b[1]", ...
struct Parameter {
  std::string name;
  std::string unit;                     ///< in consistent units, e.g. "length", "force/length^2", "1"
  std::string description;              ///< one line
  std::optional<double> default_value;  ///< none: must be given
  double minimum = -std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: must be greater than minimum
  int size = 1;                 ///< Parameter::ambient: as many as the first field has ambient coordinates
  static constexpr int ambient = -1;
};

/// A field that an energy uses, under the key of the problem file ("deformation", "rotation", "field", ...).
struct FieldSlot {
  std::string key;
  std::vector<std::string> manifolds;  ///< accepted names
  std::string description;
};

/// A choice between words ("coupling", "material", "volumetric").
struct Choice {
  std::string name;
  std::vector<std::string> values;  ///< first: the default
  std::string description;
};

struct EnergyInfo {
  std::string type;             ///< "cosserat-shell"
  std::string description;      ///< formula and source, a few lines
  std::vector<int> dimensions;  ///< of the region: 1, 2, 3
  std::vector<FieldSlot> fields;
  std::vector<Parameter> parameters;
  std::vector<Choice> choices;
  bool lame = false;  ///< mu and lambda may be given as young and poisson instead (the reader converts)
};

using ParameterValues = std::map<std::string, ParameterValue>;

}  // namespace karcher
