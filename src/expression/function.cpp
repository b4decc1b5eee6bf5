#include "expression/function.hpp"

#include <numbers>

namespace karcher {

const std::vector<Function>& functions() {
  static const std::vector<Function> all{
      {"sin", Op::sin, 1},     {"cos", Op::cos, 1},     {"tan", Op::tan, 1},     {"asin", Op::asin, 1}, {"acos", Op::acos, 1},
      {"atan", Op::atan, 1},   {"atan2", Op::atan2, 2}, {"sinh", Op::sinh, 1},   {"cosh", Op::cosh, 1}, {"tanh", Op::tanh, 1},
      {"asinh", Op::asinh, 1}, {"acosh", Op::acosh, 1}, {"atanh", Op::atanh, 1}, {"log", Op::log, 1},   {"ln", Op::log, 1},
      {"log2", Op::log2, 1},   {"log10", Op::log10, 1}, {"exp", Op::exp, 1},     {"sqrt", Op::sqrt, 1}, {"abs", Op::abs, 1},
      {"sign", Op::sign, 1},   {"rint", Op::rint, 1},   {"floor", Op::floor, 1}, {"ceil", Op::ceil, 1}, {"mod", Op::modulo, 2},
      {"pow", Op::power, 2},   {"min", Op::min, 0},     {"max", Op::max, 0},     {"sum", Op::add, 0},   {"avg", Op::add, 0, true},
  };
  return all;
}

const Function* find_function(std::string_view name) {
  for (const Function& f : functions())
    if (f.name == name) return &f;
  return nullptr;
}

std::optional<double> find_constant(std::string_view name) {
  if (name == "pi" || name == "_pi") return std::numbers::pi;
  if (name == "_e") return std::numbers::e;
  return {};
}

}  // namespace karcher
