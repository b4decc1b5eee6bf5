#pragma once
/// \file
/// Tokens of an expression's text.

#include <cstddef>
#include <string>
#include <string_view>

namespace karcher {

struct Token {
  enum class Kind { end, number, name, mark } kind = Kind::end;
  std::size_t position = 0;
  std::string_view text;  ///< of a mark: one of + - * / ^ < > <= >= == != && || ? : ( ) ,
  double value = 0;       ///< of a number
};

class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}
  /// \throws FormulaError for what is no token
  Token next();

 private:
  Token number();
  Token name();
  Token mark();

  std::string_view text_;
  std::size_t at_ = 0;
};

/// "\"x\" at character 3"
std::string quoted(const Token& token);

}  // namespace karcher
