#pragma once
/// \file
/// Names of functions and constants that every expression knows.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "karcher/expression/instruction.hpp"

namespace karcher {

struct Function {
  std::string name;
  Op op;
  int arguments;      ///< 0: any number, between which `op` stands
  bool mean = false;  ///< divided by the number of arguments
};

const std::vector<Function>& functions();
const Function* find_function(std::string_view name);
/// pi, _pi, _e
std::optional<double> find_constant(std::string_view name);

}  // namespace karcher
