#include "app/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/expression_tree.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

double modulo(double a, double b) { return a - b * std::floor(a / b); }
double power(double a, double b) { return std::pow(a, b); }
double round_down(double a) { return std::floor(a); }
double round_up(double a) { return std::ceil(a); }

const std::array<std::string, 4> variable_names{"x", "y", "z", "t"};

std::string at_point(const Vec3<double>& x, double t, bool point, bool time) {
  std::string s;
  if (point) s += fmt::format(" at ({}, {}, {})", x[0], x[1], x[2]);
  if (time) s += fmt::format("{} t = {}", point ? "," : " at", t);
  return s;
}

}  // namespace

struct Expression::State {
  std::string text, key;
  Place place;
  bool uses_point = false, uses_t = false;
  std::optional<double> constant;
  mu::Parser parser;
  std::array<double, 4> variables{};
  /// Parameters that are functions of the point, evaluated before the expression itself.
  std::vector<std::pair<Expression, std::unique_ptr<double>>> inner;
  std::function<Tree()> make_tree;
  Tree tree;

  [[noreturn]] void not_finite(double value, const char* what, const Vec3<double>& x, double t) const {
    refuse(place, fmt::format("{}{} = \"{}\" is {}{}; it must be finite.", what, key, text, value, at_point(x, t, uses_point, uses_t)));
  }
};

Expression::Expression(double constant) : state_(std::make_shared<State>()) {
  state_->constant = constant;
  state_->text = fmt::format("{}", constant);
}

double Expression::operator()(const Vec3<double>& x, double t) const {
  State& s = *state_;
  if (s.constant) return *s.constant;
  s.variables = {x[0], x[1], x[2], t};
  for (auto& [expression, value] : s.inner) *value = expression(x, t);
  const double result = s.parser.Eval();
  if (!std::isfinite(result)) s.not_finite(result, "", x, t);
  return result;
}

bool Expression::is_constant() const { return state_->constant.has_value(); }
bool Expression::uses_t() const { return state_->uses_t; }
bool Expression::uses_point() const { return state_->uses_point; }

Dual<double, 3> Expression::derivative(const Vec3<double>& x, double t) const {
  State& s = *state_;
  if (s.constant) return Slope(*s.constant);
  if (!s.tree) s.tree = s.make_tree();
  std::array<Slope, 4> variables;
  for (int i = 0; i < 3; ++i) {
    variables[static_cast<std::size_t>(i)] = Slope(x[i]);
    variables[static_cast<std::size_t>(i)].d[static_cast<std::size_t>(i)] = 1;
  }
  variables[3] = Slope(t);
  const Slope result = (*s.tree)(variables);
  if (!std::isfinite(result.v)) s.not_finite(result.v, "", x, t);
  for (const double d : result.d)
    if (!std::isfinite(d)) s.not_finite(d, "the derivative of ", x, t);
  return result;
}

ParameterValue Expression::parameter() const {
  if (is_constant()) return ParameterValue(constant());
  ParameterValue value;
  value.depends_on_t = uses_t();
  value.function = [self = *this](const Vec3<double>& x, double t) { return self(x, t); };
  return value;
}

std::vector<std::string> Scope::names() const {
  std::vector<std::string> all(variable_names.begin(), variable_names.end());
  all.push_back("pi");
  for (const auto& [name, value] : parameters_) all.push_back(name);
  return all;
}

void Scope::define(const std::string& name, Expression value, const Place& place) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  if (name.empty() || !letter(name[0]) ||
      !std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || std::isdigit(static_cast<unsigned char>(c)); }))
    refuse(place, "the parameter \"" + name + "\" cannot be used in expressions; names are made of letters, digits and underscores.");
  const std::vector<std::string> taken = names();
  const auto& functions = function_names();
  if (std::find(taken.begin(), taken.end(), name) != taken.end() || std::find(functions.begin(), functions.end(), name) != functions.end() ||
      name == "_pi" || name == "_e")
    refuse(place, "the parameter \"" + name + "\" cannot have this name: it means something else in expressions.");
  parameters_.emplace_back(name, std::move(value));
}

Expression Scope::compile(const std::string& text, const std::string& key, const Place& place) const {
  Expression result(0.0);
  Expression::State& s = *result.state_;
  s.constant.reset();
  s.text = text;
  s.key = key;
  s.place = place;

  const auto wrong = [&](std::size_t position, const std::string& sentence) {
    refuse(place.shifted(static_cast<int>(std::min(position, text.size()))), "expression \"" + text + "\" of " + key + ": " + sentence);
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
    if (text[i] == '=' && after != '=' && before != '=' && before != '<' && before != '>' && before != '!')
      wrong(i, "\"=\" assigns; write \"==\" to compare.");
  }

  mu::Parser& parser = s.parser;
  std::vector<std::string> used;
  try {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("pow", power);
    parser.DefineFun("mod", modulo);
    parser.DefineFun("floor", round_down);
    parser.DefineFun("ceil", round_up);
    for (std::size_t i = 0; i < 4; ++i) parser.DefineVar(variable_names[i], &s.variables[i]);
    for (const auto& [name, value] : parameters_) {
      if (value.is_constant()) {
        parser.DefineConst(name, value.constant());
        continue;
      }
      s.inner.emplace_back(value, std::make_unique<double>(0.0));
      parser.DefineVar(name, s.inner.back().second.get());
    }
    parser.SetExpr(text);
    s.variables = {};
    parser.Eval();
    for (const auto& [name, address] : parser.GetUsedVar()) used.push_back(name);
    if (parser.GetNumResults() != 1) wrong(text.find(','), "one value is expected, not a list.");
  } catch (const mu::ParserError& error) {
    const std::size_t position = error.GetPos() < 0 ? 0 : static_cast<std::size_t>(error.GetPos());
    if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !error.GetToken().empty()) {
      std::vector<std::string> known = names();
      known.insert(known.end(), function_names().begin(), function_names().end());
      std::string token = error.GetToken();
      while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back()))) token.pop_back();
      const std::string near = nearest_name(token, known);
      wrong(position,
            "\"" + token + "\" is not known." + (near.empty() ? "" : " Did you mean \"" + near + "\"?") + " Names: " + join_names(names()) + ".");
    }
    std::string sentence = error.GetMsg();
    if (sentence.starts_with(text + ": ")) sentence.erase(0, text.size() + 2);
    if (!sentence.empty() && sentence.back() != '.') sentence += '.';
    wrong(position, sentence);
  }

  // Only the functions among the parameters that the expression uses are evaluated before it.
  std::vector<std::pair<Expression, std::unique_ptr<double>>> inner;
  std::size_t next = 0;
  for (const auto& [name, value] : parameters_) {
    if (value.is_constant()) continue;
    auto& entry = s.inner[next++];
    if (std::find(used.begin(), used.end(), name) == used.end()) continue;
    s.uses_point = s.uses_point || value.uses_point();
    s.uses_t = s.uses_t || value.uses_t();
    inner.push_back(std::move(entry));
  }
  s.inner = std::move(inner);
  for (const std::string& name : used) {
    if (name == "t") s.uses_t = true;
    if (name == "x" || name == "y" || name == "z") s.uses_point = true;
  }
  if (!s.uses_point && !s.uses_t) {
    const double value = parser.Eval();
    if (!std::isfinite(value)) s.not_finite(value, "", {}, 0);
    s.constant = value;
  }
  s.make_tree = [text, parameters = parameters_] {
    return parse_tree(text, [&](const std::string& name) -> Tree {
      for (const auto& [known, value] : parameters)
        if (known == name) return value.is_constant() ? constant_tree(value.constant()) : value.state_->make_tree();
      return nullptr;
    });
  };
  return result;
}

}  // namespace karcher::app
