#include "expression/token.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>

#include "karcher/expression/formula.hpp"

namespace karcher {
namespace {

// Not those of <cctype>, which depend on the locale.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

std::string quoted(const Token& token) { return fmt::format("\"{}\" at character {}", token.text, token.position + 1); }

Token Tokens::next() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  if (at_ == text_.size()) return {Token::Kind::end, at_, {}, 0};
  const char c = text_[at_];
  if (is_letter(c)) return name();
  if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
  return mark();
}

Token Tokens::number() {
  Token token{Token::Kind::number, at_, {}, 0};
  const char* const first = text_.data() + at_;
  const auto [end, code] = std::from_chars(first, text_.data() + text_.size(), token.value);
  token.text = std::string_view(first, static_cast<std::size_t>(end - first));
  if (code == std::errc::result_out_of_range) {
    token.value = std::strtod(std::string(token.text).c_str(), nullptr);  // which tells too small from too large
    if (token.value > 1) throw FormulaError(at_, quoted(token) + " is too large for a number.");
  }
  at_ += token.text.size();
  return token;
}

/// A name goes on with .name and [digits]: u[0].x
Token Tokens::name() {
  const std::size_t begin = at_;
  const auto at = [this](std::size_t i) { return i < text_.size() ? text_[i] : ' '; };
  while (true) {
    while (is_letter(at(at_)) || is_digit(at(at_))) ++at_;
    while (at(at_) == '[') {
      std::size_t end = at_ + 1;
      while (is_digit(at(end))) ++end;
      if (end == at_ + 1 || at(end) != ']') break;
      at_ = end + 1;
    }
    if (at(at_) != '.' || !is_letter(at(at_ + 1))) break;
    ++at_;
  }
  return {Token::Kind::name, begin, text_.substr(begin, at_ - begin), 0};
}

Token Tokens::mark() {
  for (const std::string_view m : {"<=", ">=", "==", "!=", "&&", "||", "+", "-", "*", "/", "^", "<", ">", "?", ":", "(", ")", ","}) {
    if (text_.substr(at_, m.size()) != m) continue;
    const Token token{Token::Kind::mark, at_, text_.substr(at_, m.size()), 0};
    at_ += m.size();
    return token;
  }
  std::size_t length = 1;  // of a character in UTF-8
  while (at_ + length < text_.size() && (static_cast<unsigned char>(text_[at_ + length]) & 0xc0) == 0x80) ++length;
  const Token token{Token::Kind::mark, at_, text_.substr(at_, length), 0};
  const unsigned char c = static_cast<unsigned char>(text_[at_]);
  if (c == '=') throw FormulaError(at_, "\"=\" assigns; write \"==\" to compare.");
  if (c == '&' || c == '|') throw FormulaError(at_, fmt::format("{} is no operator; write \"{}{}\".", quoted(token), token.text, token.text));
  if (c == '!') throw FormulaError(at_, quoted(token) + " is no operator; write \"!=\" to compare, \"== 0\" to negate.");
  if (c < 0x20 || c == 0x7f) throw FormulaError(at_, fmt::format("there is a control character ({:#04x}) at character {}.", c, at_ + 1));
  throw FormulaError(at_, quoted(token) + " means nothing in an expression.");
}

}  // namespace karcher
