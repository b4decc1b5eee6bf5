#pragma once
/// \file
/// Parser: operator precedence with its own stacks, so that no text is too deep.

#include <cstddef>
#include <string_view>
#include <vector>

#include "expression/emitter.hpp"
#include "expression/token.hpp"
#include "karcher/expression/symbols.hpp"

namespace karcher {

class Parser {
 public:
  Parser(const Symbols& symbols, std::string_view text) : symbols_(symbols), tokens_(text) {}
  /// \throws FormulaError
  Formula formula();

 private:
  /// What waits for the operand after it.
  struct Pending {
    enum class Kind { binary, minus, parenthesis, call, question, colon } kind;
    int precedence = 0;                  ///< of binary, minus and colon
    std::size_t position = 0;            ///< of parenthesis, call and question: in the text
    Op op = Op::add;                     ///< of binary
    const Function* function = nullptr;  ///< of call
    std::size_t first_argument = 0;      ///< of call: position among the operands
    Emitter::Conditional conditional{};  ///< of question and colon
  };

  /// True if another operand follows the token: a sign, an opening parenthesis.
  bool operand(const Token& token);
  bool name(const Token& token);
  /// The same for what may follow an operand.
  bool continuation(const Token& token);
  void binary(Op op, int precedence);
  void question(const Token& token);
  void colon(const Token& token);
  void comma(const Token& token);
  void close(const Token& token);
  void call(const Pending& pending, const Token& token);
  void end(const Token& token);

  /// Carries out what waits and binds no weaker than `precedence`.
  void reduce(int precedence);
  bool on_top(Pending::Kind kind) const { return !pending_.empty() && pending_.back().kind == kind; }
  Operand pop();
  /// What is open on top cannot be closed by the token.
  [[noreturn]] void unclosed(const Token& token) const;

  const Symbols& symbols_;
  Tokens tokens_;
  Emitter emitter_;
  std::vector<Operand> operands_;
  std::vector<Pending> pending_;
};

}  // namespace karcher
