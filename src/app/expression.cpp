#include "app/expression.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "karcher/text.hpp"

namespace karcher::app {
namespace {

constexpr std::uint32_t t_variable = 3;  // of x, y, z, t

}  // namespace

/// Where an expression comes from, and what it depends on.
struct Expression::Source {
  std::string text, key;
  Place place;
  bool uses_point = false, uses_t = false;

  [[noreturn]] void not_finite(double value, const char* what, const Vec3<double>& x, double t) const {
    std::string at;
    if (uses_point) at += fmt::format(" at ({}, {}, {})", x[0], x[1], x[2]);
    if (uses_t) at += fmt::format("{} t = {}", uses_point ? "," : " at", t);
    refuse(place, fmt::format("{}{} = \"{}\" is {}{}; it must be finite.", what, key, shortened(text), value, at));
  }
};

struct Expression::State {
  std::optional<double> constant;
  // Of what is not constant:
  std::shared_ptr<const Source> source;
  Formula formula;
  Program program;
  std::vector<std::shared_ptr<const Source>> parameters;  ///< of program.definitions()
};

Expression::Expression(double constant) {
  State state;
  state.constant = constant;
  state_ = std::make_shared<const State>(std::move(state));
}

double Expression::operator()(const Vec3<double>& x, double t) const {
  const State& s = *state_;
  if (s.constant) return *s.constant;
  Places<double> places(s.program.size());
  for (int i = 0; i < 3; ++i) places[static_cast<std::size_t>(i)] = x[i];
  places[t_variable] = t;
  const double result = s.program.evaluate_in(places.data());
  for (std::size_t i = 0; i < s.parameters.size(); ++i)
    if (const double value = places[s.program.definitions()[i].place]; !std::isfinite(value)) s.parameters[i]->not_finite(value, "", x, t);
  if (!std::isfinite(result)) s.source->not_finite(result, "", x, t);
  return result;
}

bool Expression::is_constant() const { return state_->constant.has_value(); }
bool Expression::uses_t() const { return !is_constant() && state_->source->uses_t; }
bool Expression::uses_point() const { return !is_constant() && state_->source->uses_point; }

Dual<double, 3> Expression::derivative(const Vec3<double>& x, double t) const {
  using Slope = Dual<double, 3>;
  const State& s = *state_;
  if (s.constant) return Slope(*s.constant);
  Places<Slope> places(s.program.size());
  for (std::size_t i = 0; i < 3; ++i) {
    places[i] = x[static_cast<int>(i)];
    places[i].d[i] = 1;
  }
  places[t_variable] = t;
  const Slope& result = s.program.evaluate_in(places.data());
  if (!std::isfinite(result.v)) s.source->not_finite(result.v, "", x, t);
  for (const double d : result.d)
    if (!std::isfinite(d)) s.source->not_finite(d, "the derivative of ", x, t);
  return result;
}

ParameterValue Expression::parameter() const {
  if (is_constant()) return ParameterValue(constant());
  ParameterValue value;
  value.depends_on_t = uses_t();
  value.function = [self = *this](const Vec3<double>& x, double t) { return self(x, t); };
  return value;
}

Scope::Scope() : symbols_({"x", "y", "z", "t"}), first_parameter_(symbols_.size()) {}

void Scope::define(const std::string& name, const Expression& value, const Place& place) {
  if (name.size() > longest_name)
    refuse(place, fmt::format("the name of the parameter \"{}\" has more than {} characters.", shortened(name, longest_name), longest_name));
  if (!Symbols::is_name(name))
    refuse(place, "the parameter \"" + name + "\" cannot be used in expressions; names are made of letters, digits and underscores.");
  if (symbols_.is_taken(name)) refuse(place, "the parameter \"" + name + "\" cannot have this name: it means something else in expressions.");
  if (value.is_constant())
    symbols_.define(name, value.constant());
  else
    parameters_.emplace(symbols_.define(name, value.state_->formula), value);
}

void Scope::count(std::size_t operations, const std::string& key, const Place& place) const {
  operations_ += operations;
  if (operations_ > most_operations)
    refuse(place, fmt::format("up to {}, the expressions of the file have more than {} operations, with those of the parameters that they use.", key,
                              most_operations));
}

std::vector<std::pair<std::string, Expression>> Scope::parameters() const {
  std::vector<std::pair<std::string, Expression>> all;
  for (std::size_t n = first_parameter_; n < symbols_.size(); ++n) {
    const auto s = static_cast<std::uint32_t>(n);
    if (const auto varying = parameters_.find(s); varying != parameters_.end())
      all.emplace_back(symbols_[s].name, varying->second);
    else
      all.emplace_back(symbols_[s].name, symbols_[s].value);
  }
  return all;
}

Expression Scope::compile(const std::string& text, const std::string& key, const Place& place) const {
  Expression::State s;
  try {
    s.formula = symbols_.compile(text);
  } catch (const FormulaError& error) {
    refuse(place.after(std::string_view(text).substr(0, error.position)), "expression \"" + shortened(text) + "\" of " + key + ": " + error.what());
  }
  s.program = symbols_.link(s.formula);
  count(s.program.code().size(), key, place);
  for (const Program::Definition& d : s.program.definitions()) s.parameters.push_back(parameters_.at(d.symbol).state_->source);
  const auto& inputs = s.program.inputs();
  const bool uses_t = !inputs.empty() && inputs.back() == t_variable;
  s.source = std::make_shared<const Expression::Source>(Expression::Source{text, key, place, inputs.size() > (uses_t ? 1 : 0), uses_t});
  if (inputs.empty()) {
    const double value = s.program.evaluate<double>({});
    if (!std::isfinite(value)) s.source->not_finite(value, "", {}, 0);
    return value;
  }
  Expression result;
  result.state_ = std::make_shared<const Expression::State>(std::move(s));
  return result;
}

}  // namespace karcher::app
