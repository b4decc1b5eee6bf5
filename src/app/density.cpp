#include "app/density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "karcher/text.hpp"

namespace karcher::app {
namespace {

using Parameters = std::vector<std::pair<std::string, Expression>>;

/// Writes the definition of a name: a sum of products of variables.
class Sum {
 public:
  Sum(std::uint32_t a, std::uint32_t b) { result(Op::multiply, symbol(a), symbol(b)); }
  Sum& plus(std::uint32_t a, std::uint32_t b) { return combine(Op::add, a, b); }
  Sum& minus(std::uint32_t a, std::uint32_t b) { return combine(Op::subtract, a, b); }
  Sum& times(double factor) { return result(Op::multiply_constant, formula_.result, 0, factor); }
  Sum& plus(double constant) { return result(Op::add_constant, formula_.result, 0, constant); }
  Formula finish() {
    std::sort(formula_.symbols.begin(), formula_.symbols.end());
    formula_.symbols.erase(std::unique(formula_.symbols.begin(), formula_.symbols.end()), formula_.symbols.end());
    return std::move(formula_);
  }

 private:
  std::uint32_t symbol(std::uint32_t number) {
    formula_.symbols.push_back(number);
    return number | Formula::of_symbol;
  }
  Sum& result(Op op, std::uint32_t a, std::uint32_t b, double k = 0) {
    formula_.result = static_cast<std::uint32_t>(formula_.code.size());
    formula_.code.push_back({op, formula_.result, a, b, 0, k, 0});
    return *this;
  }
  Sum& combine(Op op, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t before = formula_.result;
    result(Op::multiply, symbol(a), symbol(b));
    return result(op, before, formula_.result);
  }
  Formula formula_;
};

/// The names of a density on regions of a dimension; variables in the order of DensityVariables.
class Names {
 public:
  Names(const std::vector<Density::Field>& fields, const Parameters& parameters, int directions) : symbols({"x", "y", "z"}), directions_(directions) {
    for (const Density::Field& f : fields) add_coordinates(f);
    symbols.add_variable("t");
    for (const auto& [name, value] : parameters) {
      if (value.is_constant())
        symbols.define(name, value.constant());
      else
        symbols.add_variable(name);
    }
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (fields[f].manifold->body_axes) add_rotation(fields[f], numbers_[f]);
  }

  Symbols symbols;

 private:
  /// In solids the directions are the axes.
  void add_coordinates(const Density::Field& f) {
    const auto n = static_cast<std::size_t>(f.manifold->ambient);
    auto& mine = numbers_.emplace_back();
    const auto add = [&](std::size_t c, const std::string& behind, bool named) {
      return named ? symbols.add_variable(fmt::format("{}[{}]{}", f.name, c, behind)) : symbols.add_hidden_variable();
    };
    for (std::size_t c = 0; c < n; ++c) mine.push_back(add(c, "", true));
    for (const bool along_axes : {true, false})
      for (const char axis : {'x', 'y', 'z'})
        for (std::size_t c = 0; c < n; ++c) {
          const std::uint32_t number = add(c, std::string(".") + axis, along_axes ? directions_ == 1 || directions_ == 2 : directions_ == 3);
          if (!along_axes) mine.push_back(number);
        }
  }
  /// Of the unit quaternion q: k_a = 2 Im(conj(q) d_a q), and the columns of its rotation matrix.
  void add_rotation(const Density::Field& f, const std::vector<std::uint32_t>& q) {
    for (std::size_t a = 1; a <= static_cast<std::size_t>(directions_); ++a) {
      const std::uint32_t* d = q.data() + 4 * a;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        Sum rate(q[0], d[1 + i]);
        rate.minus(q[1 + i], d[0]).minus(q[1 + j], d[1 + k]).plus(q[1 + k], d[1 + j]).times(2);
        symbols.define(fmt::format("{}.k{}[{}]", f.name, a, i), rate.finish());
      }
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t column = 0; column < 3; ++column) {
        const std::size_t j = 1 + (i + 1) % 3, k = 1 + (i + 2) % 3;
        Sum entry(q[i == column ? j : 1 + i], q[i == column ? j : 1 + column]);
        if (i == column)
          entry.plus(q[k], q[k]).times(-2).plus(1.0);
        else
          (1 + column == j ? entry.minus(q[0], q[k]) : entry.plus(q[0], q[j])).times(2);
        symbols.define(fmt::format("{}.d{}[{}]", f.name, column + 1, i), entry.finish());
      }
  }

  int directions_;
  std::vector<std::vector<std::uint32_t>> numbers_;  ///< of variables of every field: values, derivatives along t_1, along t_2, along t_3
};

std::string base_of(std::string_view name) { return std::string(name.substr(0, name.find_first_of(".["))); }

/// The name that begins at a place of a text.
std::string name_at(const std::string& text, std::size_t begin) {
  const auto part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '[' || c == ']';
  };
  std::size_t end = begin;
  while (end < text.size() && part(text[end])) ++end;
  return text.substr(begin, end - begin);
}

/// What a field has, as half a sentence.
std::string parts_of(const Density::Field& f, int directions) {
  const int last = f.manifold->ambient - 1;
  std::string s = fmt::format("the field \"{}\" has values in {}: {}[0]{}", f.name, f.manifold->name, f.name,
                              last > 0 ? fmt::format(" to {}[{}]", f.name, last) : std::string());
  if (directions > 0) s += fmt::format(", with derivatives {0}[0].x, {0}[0].y, {0}[0].z", f.name);
  if (f.manifold->body_axes) {
    for (int a = 1; a <= directions; ++a) s += fmt::format("{} {}.k{}[0..2]", a == 1 ? ", body rates" : ",", f.name, a);
    s += fmt::format(", directors {0}.d1[0..2], {0}.d2, {0}.d3", f.name);
  }
  return s;
}

/// t as a parameter.
ParameterValue load_parameter() {
  ParameterValue t;
  t.depends_on_t = true;
  t.function = [](const Vec3<double>&, double now) { return now; };
  return t;
}

/// "name = expression" in two, the expression with its place.
struct Definition {
  std::string name, text;
  Place name_place, text_place;
};
Definition split(const Density::Text& item) {
  const std::string& text = item.value.text;
  const auto at = [&](std::size_t i) { return item.value.text_place().after(std::string_view(text).substr(0, i)); };
  constexpr std::string_view space = " \t\r\n\v\f";
  const std::size_t equals = text.find('='), begin = text.find_first_not_of(space);
  if (equals == std::string::npos || text.substr(equals, 2) == "==" || begin == equals)
    refuse(item.value.place, fmt::format("{} is \"{}\"; it must be \"name = expression\".", item.key, shortened(text)));
  const std::size_t end = text.find_last_not_of(space, equals - 1);
  return {text.substr(begin, end + 1 - begin), text.substr(equals + 1), at(begin), at(equals + 1)};
}

}  // namespace

Density::Density(const Scope& scope, std::vector<Field> fields, std::vector<std::string> others, std::vector<Text> let, Text density)
    : fields_(std::move(fields)), others_(std::move(others)), let_(std::move(let)), density_(std::move(density)), parameters_(scope.parameters()) {
  const DensityFormula whole = formula(3);
  std::vector<int> ambient;
  std::size_t coordinates = 0;
  for (const Field& f : fields_) {
    ambient.push_back(f.manifold->ambient);
    coordinates += 4 * static_cast<std::size_t>(f.manifold->dim);
  }
  scope.count(whole.program.code().size() * (1 + coordinates), density_.key, density_.value.text_place());

  const DensityVariables variables(ambient);
  const std::vector<std::uint32_t>& used = whole.program.inputs();
  const auto uses = [&](std::size_t begin, std::size_t end) {
    return std::any_of(used.begin(), used.end(), [&](std::uint32_t v) { return v >= begin && v < end; });
  };
  for (std::size_t f = 0; f < fields_.size(); ++f)
    if (!uses(variables.value(f), variables.end(f)))
      refuse(density_.value.place, fmt::format("{} does not use the field \"{}\": {}.", density_.key, fields_[f].name, parts_of(fields_[f], 3)));

  // Parameters are evaluated at every point: only those that are needed.
  Parameters needed;
  std::size_t next = variables.parameters() + 1;
  for (auto& p : parameters_) {
    const bool variable = !p.second.is_constant();
    if (!variable || uses(next, next + 1)) needed.push_back(std::move(p));
    if (variable) ++next;
  }
  parameters_ = std::move(needed);
}

DensityFormula Density::formula(int directions) const {
  Names names(fields_, parameters_, directions);
  Symbols& symbols = names.symbols;
  const auto compile = [&](const std::string& text, const std::string& key, const Place& place, std::size_t next_let) {
    try {
      return symbols.compile(text);
    } catch (const FormulaError& error) {
      const std::string name = name_at(text, error.position), base = base_of(name);
      std::string sentence = error.what();
      for (const Field& f : fields_)
        if (f.name == base)
          sentence = fmt::format("\"{}\" is not known{}; {}.", name, directions < 3 ? fmt::format(" on a region of dimension {}", directions) : "",
                                 parts_of(f, directions));
      if (std::find(others_.begin(), others_.end(), base) != others_.end())
        sentence = fmt::format("the field \"{}\" is none of the fields of this energy.", base);
      for (std::size_t i = next_let; i < let_.size(); ++i)
        if (split(let_[i]).name == name)
          sentence = fmt::format("\"{}\" is defined by {}, but a definition uses earlier ones only.", name, let_[i].key);
      refuse(place.after(std::string_view(text).substr(0, error.position)),
             fmt::format("expression \"{}\" of {}: {}", shortened(text), key, sentence));
    }
  };
  for (std::size_t i = 0; i < let_.size(); ++i) {
    const Definition d = split(let_[i]);
    const bool is_field = std::find(others_.begin(), others_.end(), d.name) != others_.end() ||
                          std::any_of(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == d.name; });
    if (d.name.size() > longest_name)
      refuse(d.name_place,
             fmt::format("{}: the name \"{}\" has more than {} characters.", let_[i].key, shortened(d.name, longest_name), longest_name));
    if (!Symbols::is_name(d.name))
      refuse(d.name_place, fmt::format("{}: \"{}\" is no name; names are made of letters, digits and underscores.", let_[i].key, d.name));
    if (symbols.is_taken(d.name) || is_field)
      refuse(d.name_place, fmt::format("{}: the name \"{}\" means something else already.", let_[i].key, d.name));
    symbols.define(d.name, compile(d.text, let_[i].key, d.text_place, i));
  }
  DensityFormula result;
  result.program = symbols.link(compile(density_.value.text, density_.key, density_.value.text_place(), let_.size()));
  result.parameters.push_back(load_parameter());
  for (const auto& [name, value] : parameters_)
    if (!value.is_constant()) result.parameters.push_back(value.parameter());
  return result;
}

}  // namespace karcher::app
