#include "expression/parser.hpp"

#include <fmt/format.h>

#include <span>

#include "karcher/text.hpp"

namespace karcher {
namespace {

struct Binary {
  std::string_view text;
  Op op;
  int precedence;
};

constexpr int conditional = 0, sign = 6, strongest = 7;
constexpr Binary binaries[] = {{"||", Op::disjunction, 1}, {"&&", Op::conjunction, 2},   {"<", Op::less, 4},     {">", Op::greater, 4},
                               {"<=", Op::less_equal, 4},  {">=", Op::greater_equal, 4}, {"==", Op::equal, 4},   {"!=", Op::not_equal, 4},
                               {"+", Op::add, 5},          {"-", Op::subtract, 5},       {"*", Op::multiply, 6}, {"/", Op::divide, 6},
                               {"^", Op::power, strongest}};

[[noreturn]] void unexpected(const Token& token, const std::string& expected) {
  const bool end = token.kind == Token::Kind::end;
  throw FormulaError(token.position,
                     fmt::format("{}; expected is {}.",
                                 end ? fmt::format("it ends after character {}", token.position) : quoted(token) + " is not expected", expected));
}

}  // namespace

Formula Parser::formula() {
  bool operand_next = true;
  while (true) {
    const Token token = tokens_.next();
    if (operand_next) {
      operand_next = operand(token);
    } else if (token.kind == Token::Kind::end) {
      end(token);
      return emitter_.finish(pop());
    } else {
      operand_next = continuation(token);
    }
  }
}

bool Parser::operand(const Token& token) {
  if (token.kind == Token::Kind::name) return name(token);
  if (token.kind == Token::Kind::number) {
    operands_.push_back(Emitter::constant(token.value));
    return false;
  }
  if (token.text == "(") {
    pending_.push_back({.kind = Pending::Kind::parenthesis, .position = token.position});
  } else if (token.text == "-") {
    pending_.push_back({.kind = Pending::Kind::minus, .precedence = sign});
  } else if (token.text == ")" && on_top(Pending::Kind::call) && operands_.size() == pending_.back().first_argument) {
    call(pending_.back(), token);
  } else if (token.text != "+") {
    unexpected(token, "a number, a name, a function or \"(\"");
  }
  return true;
}

bool Parser::name(const Token& token) {
  if (const auto number = symbols_.find(token.text)) {
    const Symbols::Symbol& symbol = symbols_[*number];
    operands_.push_back(symbol.kind == Symbols::Kind::constant ? Emitter::constant(symbol.value) : emitter_.symbol(*number));
    return false;
  }
  if (const auto constant = find_constant(token.text)) {
    operands_.push_back(Emitter::constant(*constant));
    return false;
  }
  if (const Function* function = find_function(token.text)) {
    const Token next = tokens_.next();
    if (next.text != "(") throw FormulaError(token.position, quoted(token) + " is a function; \"(\" must follow it.");
    pending_.push_back({.kind = Pending::Kind::call, .position = next.position, .function = function, .first_argument = operands_.size()});
    return true;
  }
  std::vector<std::string> known = symbols_.names();
  const std::string names = join_names(known);
  for (const Function& f : functions()) known.push_back(f.name);
  const std::string near = nearest_name(token.text, known);
  throw FormulaError(token.position,
                     fmt::format("\"{}\" is not known.{} Names: {}.", token.text, near.empty() ? "" : " Did you mean \"" + near + "\"?", names));
}

bool Parser::continuation(const Token& token) {
  if (token.kind == Token::Kind::mark) {
    for (const Binary& b : binaries) {
      if (token.text != b.text) continue;
      binary(b.op, b.precedence);
      return true;
    }
    if (token.text == ")") {
      close(token);
      return false;
    }
    if (token.text != "(") {
      token.text == "?" ? question(token) : token.text == ":" ? colon(token) : comma(token);
      return true;
    }
  }
  const bool unit = token.kind == Token::Kind::name && !symbols_.find(token.text) && !find_constant(token.text) && !find_function(token.text);
  unexpected(token,
             unit ? "an operator; numbers have no units here: state all of them in one system, as N, mm and MPa" : "an operator (\"*\" multiplies)");
}

void Parser::binary(Op op, int precedence) {
  reduce(op == Op::power ? precedence + 1 : precedence);
  pending_.push_back({.kind = Pending::Kind::binary, .precedence = precedence, .op = op});
}

void Parser::question(const Token& token) {
  reduce(conditional + 1);
  pending_.push_back({.kind = Pending::Kind::question, .position = token.position, .conditional = emitter_.begin(pop())});
}

void Parser::colon(const Token& token) {
  reduce(conditional);
  if (pending_.empty()) throw FormulaError(token.position, quoted(token) + " has no \"?\" before it.");
  if (!on_top(Pending::Kind::question)) unclosed(token);
  Pending& top = pending_.back();
  emitter_.otherwise(top.conditional, pop());
  top.kind = Pending::Kind::colon;
}

void Parser::comma(const Token& token) {
  reduce(conditional);
  if (on_top(Pending::Kind::question)) unclosed(token);
  if (!on_top(Pending::Kind::call)) throw FormulaError(token.position, "one value is expected, not a list.");
}

void Parser::close(const Token& token) {
  reduce(conditional);
  if (pending_.empty()) throw FormulaError(token.position, quoted(token) + " has no \"(\" before it.");
  if (on_top(Pending::Kind::question)) unclosed(token);
  const Pending top = pending_.back();
  pending_.pop_back();
  if (top.kind == Pending::Kind::call) call(top, token);
}

void Parser::call(const Pending& pending, const Token& token) {
  const Function& f = *pending.function;
  const std::size_t count = operands_.size() - pending.first_argument;
  if (f.arguments > 0 ? count != static_cast<std::size_t>(f.arguments) : count == 0)
    throw FormulaError(token.position, fmt::format("\"{}\" takes {}{} argument{}, not {}.", f.name, f.arguments > 0 ? "" : "at least ",
                                                   std::max(f.arguments, 1), f.arguments > 1 ? "s" : "", count));
  const Operand result = emitter_.call(f, std::span(operands_).subspan(pending.first_argument));
  operands_.resize(pending.first_argument);
  operands_.push_back(result);
}

void Parser::end(const Token& token) {
  reduce(conditional);
  if (!pending_.empty()) unclosed(token);
}

void Parser::reduce(int precedence) {
  while (!pending_.empty()) {
    const Pending& top = pending_.back();
    const bool waits = top.kind == Pending::Kind::binary || top.kind == Pending::Kind::minus || top.kind == Pending::Kind::colon;
    if (!waits || top.precedence < precedence) return;
    const Operand x = pop();
    operands_.push_back(top.kind == Pending::Kind::minus   ? emitter_.negate(x)
                        : top.kind == Pending::Kind::colon ? emitter_.end(top.conditional, x)
                                                           : emitter_.binary(top.op, pop(), x));
    pending_.pop_back();
  }
}

Operand Parser::pop() {
  const Operand x = operands_.back();
  operands_.pop_back();
  return x;
}

void Parser::unclosed(const Token& token) const {
  const Pending& top = pending_.back();
  const bool question = top.kind == Pending::Kind::question;
  unexpected(token, fmt::format("\"{}\" for the \"{}\" at character {}", question ? ":" : ")", question ? "?" : "(", top.position + 1));
}

}  // namespace karcher
