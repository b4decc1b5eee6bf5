#include "karcher/expression/symbols.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "expression/function.hpp"
#include "expression/parser.hpp"
#include "expression/token.hpp"

namespace karcher {
namespace {

/// Whether the text is one name for the compiler, which may have parts: u[0].x
bool is_one_name(std::string_view text) {
  try {
    const Token token = Tokens(text).next();
    return token.kind == Token::Kind::name && token.text == text;
  } catch (const FormulaError&) {
    return false;
  }
}

}  // namespace

Symbols::Symbols(const std::vector<std::string>& variables) {
  for (const std::string& name : variables) add_variable(name);
  add({"pi", Kind::constant, 0, *find_constant("pi"), nullptr});
}

std::uint32_t Symbols::add(Symbol symbol) {
  const auto number = static_cast<std::uint32_t>(symbols_.size());
  numbers_.emplace(symbol.name, number);
  symbols_.push_back(std::move(symbol));
  return number;
}

std::uint32_t Symbols::add_variable(const std::string& name) {
  check(name, is_one_name(name));
  return add({name, Kind::variable, variables_++, 0, nullptr});
}

std::uint32_t Symbols::add_hidden_variable() {
  symbols_.push_back({{}, Kind::variable, variables_++, 0, nullptr});
  return static_cast<std::uint32_t>(symbols_.size()) - 1;
}

std::uint32_t Symbols::define(const std::string& name, double constant) {
  check(name, is_name(name));
  return add({name, Kind::constant, 0, constant, nullptr});
}

std::uint32_t Symbols::define(const std::string& name, Formula formula) {
  check(name, is_one_name(name));
  return add({name, Kind::definition, 0, 0, std::make_shared<const Formula>(std::move(formula))});
}

void Symbols::check(const std::string& name, bool valid) const {
  if (!valid) throw InputError("\"" + name + "\" is no name for an expression.");
  if (is_taken(name)) throw InputError("\"" + name + "\" means something else in expressions.");
}

bool Symbols::is_name(std::string_view name) { return is_one_name(name) && name.find_first_of(".[") == name.npos; }

bool Symbols::is_taken(std::string_view name) const { return find(name) || find_constant(name) || find_function(name); }

std::vector<std::string> Symbols::names() const {
  std::vector<std::string> all;
  for (const Symbol& s : symbols_)
    if (!s.name.empty()) all.push_back(s.name);
  return all;
}

std::optional<std::uint32_t> Symbols::find(std::string_view name) const {
  const auto it = numbers_.find(name);
  return it == numbers_.end() ? std::nullopt : std::optional(it->second);
}

Formula Symbols::compile(std::string_view text) const {
  if (text.size() > longest_text) throw FormulaError(0, fmt::format("it has {} characters; {} are the most.", text.size(), longest_text));
  if (Tokens(text).next().kind == Token::Kind::end) throw FormulaError(0, "it is empty.");
  return Parser(*this, text).formula();
}

}  // namespace karcher
