#pragma once
/// \file
/// Symbols: the names that expressions may use, and the compiler of expressions.
///
/// Grammar, from what binds weakest: c ? a : b, ||, &&, < > <= >= == !=, + -, * / and signs, ^ (to the right, so -x^2 = -(x^2) and 2^-1 = 1/2). Functions:
/// sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, acosh, atanh, log = ln, log2, log10, exp, sqrt, abs, sign, rint, floor, ceil,
/// mod(a, b) = a - b floor(a/b), pow(a, b), and min, max, sum, avg of any number of values. Constants: pi = _pi, _e.
///
/// Values are those of muParser 2.3 (https://beltoforion.de/en/muparser/), bit by bit, which includes its arithmetic of constants: an expression that is affine
/// in one symbol, like 2*x*3 + 1, is 6*x + 1; x^2, x^3 and x^4 of a symbol are products, x^0 = 1, other powers are std::pow. One thing differs: 0.5 && 1 is
/// true, as x && 1 is for x = 0.5, where muParser cuts constants to whole numbers.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "karcher/expression/formula.hpp"
#include "karcher/expression/program.hpp"

namespace karcher {

/// Numbers of symbols are their positions in the order in which they were added; they never change, also not in a copy that grows.
class Symbols {
 public:
  enum class Kind { variable, constant, definition };
  struct Symbol {
    std::string name;
    Kind kind = Kind::variable;
    std::uint32_t variable = 0;                 ///< of a variable: its position among variables
    double value = 0;                           ///< of a constant
    std::shared_ptr<const Formula> definition;  ///< of a definition
  };

  /// The longest text that is compiled.
  static constexpr std::size_t longest_text = 1000000;

  /// \param variables names in the order of the values that programs are evaluated at
  explicit Symbols(const std::vector<std::string>& variables);

  /// Variables may have names like u[0], u.k1 and u[0].x. The numbers of new symbols are returned. \throws InputError if the name is no name or is taken
  std::uint32_t add_variable(const std::string& name);
  /// A variable that only definitions made by code can name.
  std::uint32_t add_hidden_variable();
  std::uint32_t define(const std::string& name, double constant);
  std::uint32_t define(const std::string& name, Formula formula);

  /// Letters, digits and underscores, no digit first.
  static bool is_name(std::string_view name);
  /// Whether the name means something already: a symbol, a constant, a function.
  bool is_taken(std::string_view name) const;
  /// What an expression may name, without functions.
  std::vector<std::string> names() const;
  const Symbol& operator[](std::size_t number) const { return symbols_[number]; }
  std::size_t size() const { return symbols_.size(); }
  std::uint32_t variables() const { return variables_; }
  /// The number of a name, if there is one.
  std::optional<std::uint32_t> find(std::string_view name) const;

  /// Needs neither time nor memory beyond a multiple of the text's length, however it is nested. \throws FormulaError
  Formula compile(std::string_view text) const;
  /// The formula with the definitions that it needs, each once.
  Program link(const Formula& formula) const;

 private:
  std::uint32_t add(Symbol symbol);
  void check(const std::string& name, bool valid) const;

  std::vector<Symbol> symbols_;
  std::map<std::string, std::uint32_t, std::less<>> numbers_;
  std::uint32_t variables_ = 0;
};

}  // namespace karcher
