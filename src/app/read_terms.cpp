#include "app/read_terms.hpp"

#include <fmt/format.h>

#include "app/density.hpp"
#include "app/schema.hpp"
#include "app/section.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

const EnergyInfo& find_info(const std::string& section, const std::string& type, const Place& place) {
  const auto& catalogue = section == "energies" ? energy_catalogue() : load_catalogue();
  const auto& other = section == "energies" ? load_catalogue() : energy_catalogue();
  std::vector<std::string> names;
  for (const EnergyInfo& info : catalogue) {
    if (info.type == type) return info;
    names.push_back(info.type);
  }
  for (const EnergyInfo& info : other)
    if (info.type == type)
      refuse(place, fmt::format("\"{}\" is {}; it belongs under [[{}]].", type, section == "energies" ? "a load" : "an energy",
                                section == "energies" ? "loads" : "energies"));
  refuse_name(place, section == "energies" ? "there is no energy" : "there is no load", type, names);
}

/// The parameter, which refuses values out of its range wherever it is evaluated.
ParameterValue in_range(const Expression& e, const Parameter& p, const std::string& key, const Place& place) {
  const auto check = [=](double value, const Vec3<double>& x, double t, bool constant) {
    if (value > p.minimum || (p.minimum_allowed && value == p.minimum)) return;
    refuse(place, fmt::format("{} is {}{}; it must be {} {}.", key, value,
                              constant ? std::string() : fmt::format(" at ({}, {}, {}), t = {}", x[0], x[1], x[2], t),
                              p.minimum_allowed ? "at least" : "greater than", p.minimum));
  };
  ParameterValue value = e.parameter();
  if (e.is_constant()) {
    check(value.constant, {}, 0, true);
  } else if (p.minimum > -std::numeric_limits<double>::infinity()) {
    value.function = [=, inner = value.function](const Vec3<double>& x, double t) {
      const double v = inner(x, t);
      check(v, x, t, false);
      return v;
    };
  }
  return value;
}

/// mu and lambda of Young's modulus and Poisson's ratio: E / (2 (1 + nu)), E nu / ((1 + nu)(1 - 2 nu)).
void lame_of_young(Section& s, const Scope& scope, ParameterValues& parameters) {
  for (const char* key : {"mu", "lambda"})
    if (s.has(key)) refuse(s.place(key), s.path() + " has young and poisson, which say what \"" + key + "\" is; give one pair or the other.");
  const Expression young = s.expression("young", scope), poisson = s.expression("poisson", scope);
  const Place young_place = s.place("young"), poisson_place = s.place("poisson");
  const std::string path = s.path();
  const auto lame = [=](const Vec3<double>& x, double t) {
    const double e = young(x, t), nu = poisson(x, t);
    if (!(e > 0)) refuse(young_place, fmt::format("{}.young is {}; it must be greater than 0.", path, e));
    if (!(nu > -1 && nu < 0.5)) refuse(poisson_place, fmt::format("{}.poisson is {}; it must be greater than -1 and less than 1/2.", path, nu));
    return std::pair(e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu)));
  };
  if (young.is_constant() && poisson.is_constant()) {
    const auto [mu, lambda] = lame({}, 0);
    parameters["mu"] = mu;
    parameters["lambda"] = lambda;
    return;
  }
  ParameterValue mu, lambda;
  mu.depends_on_t = lambda.depends_on_t = young.uses_t() || poisson.uses_t();
  mu.function = [=](const Vec3<double>& x, double t) { return lame(x, t).first; };
  lambda.function = [=](const Vec3<double>& x, double t) { return lame(x, t).second; };
  parameters["mu"] = mu;
  parameters["lambda"] = lambda;
}

void point_parameter(Section& s, const Parameter& p, const ManifoldOps& m, const Scope& scope, ParameterValues& parameters) {
  const Value* v = s.raw(p.name);
  if (!v) s.missing(p.name);
  const PointValue point(*v, s.path(p.name), m, scope);
  for (int i = 0; i < m.ambient; ++i) {
    ParameterValue value;
    value.depends_on_t = point.uses_t();
    value.function = [point, i, n = m.ambient](const Vec3<double>& x, double t) {
      std::vector<double> coordinates(static_cast<std::size_t>(n));
      point.evaluate(x, t, coordinates.data());
      return coordinates[static_cast<std::size_t>(i)];
    };
    parameters[fmt::format("{}[{}]", p.name, i)] = value;
  }
}

/// The catalogue's entry as a part of the table of keys.
std::vector<KeyInfo> term_keys(const std::string& section, const EnergyInfo& info) {
  std::vector<KeyInfo> keys = section_info(section).keys;
  if (info.formula) keys.insert(keys.end(), formula_keys().begin(), formula_keys().end());
  for (const FieldSlot& f : info.fields) keys.push_back({.name = f.key});
  for (const Parameter& p : info.parameters) {
    KeyInfo& key = keys.emplace_back(KeyInfo{.name = p.name, .kind = p.point ? KeyKind::point : KeyKind::expression});
    if (p.default_value) key.standard = *p.default_value;
  }
  if (info.lame)
    for (const char* name : {"young", "poisson"}) keys.push_back({.name = name, .kind = KeyKind::expression});
  for (const Choice& c : info.choices) {
    if (c.is_flag())
      keys.push_back({.name = c.name, .kind = KeyKind::flag, .standard = false});
    else
      keys.push_back({.name = c.name, .kind = KeyKind::word, .standard = c.values.front(), .words = c.values});
  }
  return keys;
}

void read_parameter(Section& s, const Parameter& p, const TermSpec& spec, const ProblemFile& problem, ParameterValues& parameters) {
  const ManifoldOps& m = *problem.fields[static_cast<std::size_t>(spec.fields.front())].manifold;
  if (p.point) return point_parameter(s, p, m, problem.scope, parameters);
  const Place place = s.place(p.name);
  if (p.size == 1) {
    const Expression e = s.expression(p.name, problem.scope);
    if (p.uniform && e.uses_point())
      refuse(place, s.path(p.name) + " must be the same everywhere: an expression of t and parameters, without x, y and z.");
    parameters[p.name] = in_range(e, p, s.path(p.name), place);
    return;
  }
  const auto size = static_cast<std::size_t>(p.size == Parameter::ambient ? m.ambient : p.size);
  const std::vector<Expression> e = s.expressions(p.name, problem.scope, size);
  for (std::size_t i = 0; i < size; ++i)
    parameters[fmt::format("{}[{}]", p.name, i)] = in_range(e[i], p, fmt::format("{}.{}", s.path(p.name), i), place);
}

/// Keys of the parameters and choices that go with the choices of a term.
std::vector<std::string> keys_that_go(const EnergyInfo& info, const std::map<std::string, std::string>& choices) {
  std::vector<std::string> keys;
  const auto add = [&](const auto& list) {
    for (const auto& entry : list)
      if (!entry.only || entry.only->holds(choices)) keys.push_back(entry.name);
  };
  add(info.parameters);
  add(info.choices);
  return keys;
}

/// Refuses what does not go with the choices of a term, if it is given.
void refuse_stranger(const Section& s, const std::string& key, const Condition& only, const EnergyInfo& info, const TermSpec& spec) {
  if (!s.has(key)) return;
  const auto chosen = spec.choices.find(only.choice);
  refuse(s.place(key),
         fmt::format("{} goes with {} = \"{}\", not with \"{}\", with which go: {}.", s.path(key), only.choice, join_names(only.words, "\" or \""),
                     chosen == spec.choices.end() ? "" : chosen->second, join_names(keys_that_go(info, spec.choices))));
}

void read_choices(Section& s, const EnergyInfo& info, TermSpec& spec) {
  for (const Choice& c : info.choices)
    if (!c.only || c.only->holds(spec.choices)) spec.choices[c.name] = c.is_flag() ? (s.flag(c.name) ? "true" : "false") : s.word(c.name);
  for (const Choice& c : info.choices)
    if (c.only && !c.only->holds(spec.choices)) refuse_stranger(s, c.name, *c.only, info, spec);
}

void read_parameters(Section& s, const EnergyInfo& info, const ProblemFile& problem, TermSpec& spec) {
  const auto is_modulus = [](const Parameter& p) { return p.name == "mu" || p.name == "lambda"; };
  for (const Parameter& p : info.parameters) {
    if (!p.only || p.only->holds(spec.choices)) continue;
    refuse_stranger(s, p.name, *p.only, info, spec);
    if (info.lame && is_modulus(p))
      for (const char* key : {"young", "poisson"}) refuse_stranger(s, key, *p.only, info, spec);
  }
  const bool young = info.lame && (s.has("young") || s.has("poisson"));
  if (young) lame_of_young(s, problem.scope, spec.parameters);
  for (const Parameter& p : info.parameters)
    if ((!p.only || p.only->holds(spec.choices)) && !(young && is_modulus(p))) read_parameter(s, p, spec, problem, spec.parameters);
}

void read_fields(Section& s, const EnergyInfo& info, const ProblemFile& problem, TermSpec& spec) {
  for (const FieldSlot& slot : info.fields) {
    const std::string name = s.text(slot.key);
    const int index = field_index(problem, name, s.place(slot.key));
    const ManifoldOps& manifold = *problem.fields[static_cast<std::size_t>(index)].manifold;
    if (!slot.accepts(manifold))
      refuse(s.place(slot.key), fmt::format("{} of {} takes a field with values in {}; \"{}\" has values in {}.", s.path(slot.key), info.type,
                                            join_names(slot.manifold_names(), " or "), name, manifold.name));
    for (std::size_t k = 0; k < spec.fields.size(); ++k)
      if (spec.fields[k] == index)
        refuse(s.place(slot.key), fmt::format("{}: the field \"{}\" is used twice, as {} and as {}.", s.path(), name, info.fields[k].key, slot.key));
    spec.fields.push_back(index);
  }
}

/// Fields and density of an energy that is a formula.
void read_formula(Section& s, ProblemFile& problem, TermSpec& spec) {
  std::vector<Density::Field> fields;
  const std::vector<Value> names = s.texts("fields");
  if (names.empty() || names.size() > 3)
    refuse(s.place("fields"), fmt::format("{} takes one to three fields, not {}.", s.path("fields"), names.size()));
  const std::string moves = s.has("moves") ? s.text("moves") : std::string();
  for (const Value& v : names) {
    const int index = field_index(problem, v.text, v.place);
    const FieldSpec& field = problem.fields[static_cast<std::size_t>(index)];
    if (std::find(spec.fields.begin(), spec.fields.end(), index) != spec.fields.end())
      refuse(v.place, fmt::format("{} names the field \"{}\" twice.", s.path("fields"), v.text));
    if (!Symbols::is_name(v.text))
      refuse(v.place, fmt::format("the field \"{}\" cannot be used in formulas; names there are made of letters, digits and underscores.", v.text));
    if (problem.scope.is_taken(v.text))
      refuse(v.place, fmt::format("the field \"{}\" cannot be used in formulas: \"{}\" means something else in expressions.", v.text, v.text));
    spec.fields.push_back(index);
    spec.info.fields.push_back({.key = v.text, .manifolds = {field.manifold}, .description = {}, .moves = v.text == moves});
    fields.push_back({v.text, field.manifold});
  }
  if (s.has("moves")) {
    const auto moving = std::find_if(fields.begin(), fields.end(), [&](const Density::Field& f) { return f.name == moves; });
    std::vector<std::string> known;
    for (const Density::Field& f : fields) known.push_back(f.name);
    if (moving == fields.end()) refuse_name(s.place("moves"), s.path("moves") + " must be one of the fields, not", moves, known);
    if (!moving->manifold->linear)
      refuse(s.place("moves"), fmt::format("{}: the values of \"{}\" are points of {}, not places.", s.path("moves"), moves, moving->manifold->name));
  }
  std::vector<std::string> others;
  for (std::size_t f = 0; f < problem.fields.size(); ++f)
    if (std::find(spec.fields.begin(), spec.fields.end(), static_cast<int>(f)) == spec.fields.end()) others.push_back(problem.fields[f].name);
  std::vector<Density::Text> let;
  for (const Value& v : s.texts("let")) let.push_back({fmt::format("{}.{}", s.path("let"), let.size()), v});
  const Density density(problem.scope, std::move(fields), std::move(others), std::move(let), {s.path("density"), s.formula("density")});
  spec.make = [density, info = spec.info](TermInput input) {
    input.formula = std::make_shared<const DensityFormula>(density.formula(input.region.dim));
    return make_term(info, std::move(input));
  };
}

}  // namespace

int field_index(const ProblemFile& problem, const std::string& name, const Place& place) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    if (problem.fields[i].name == name) return static_cast<int>(i);
    names.push_back(problem.fields[i].name);
  }
  refuse(place, "there is no field \"" + name + "\". " + suggestion(name, names, "Fields"));
}

void read_terms(const std::string& section, const std::vector<Value>& tables, ProblemFile& problem) {
  std::vector<Value> resolved;
  for (const Value& table : tables) {
    const std::string path = fmt::format("{}.{}", section, resolved.size());
    if (!table.is(Value::Kind::table)) refuse(table.place, path + " must be a table, not " + table.kind_name() + ".");
    const Entry* type = table.find("type");
    if (!type) refuse(table.place, path + " lacks the key \"type\".");
    if (!type->value.is(Value::Kind::text)) refuse(type->value.place, path + ".type must be a string, not " + type->value.kind_name() + ".");
    const EnergyInfo& info = find_info(section, type->value.text, type->value.place);
    Section s(&table, path, table.place, term_keys(section, info));

    TermSpec spec;
    s.text("type");
    spec.path = path;
    spec.place = table.place;
    spec.info = info;
    spec.make = [name = info.term_name()](TermInput input) { return make_term(name, std::move(input)); };
    spec.on = s.text("on");
    spec.on_place = s.place("on");
    if (info.formula) read_formula(s, problem, spec);
    read_fields(s, info, problem, spec);
    read_choices(s, info, spec);
    read_parameters(s, info, problem, spec);
    problem.terms.push_back(std::move(spec));
    resolved.push_back(s.resolved());
  }
  if (!resolved.empty()) problem.values.append(section, {}, Value::of(std::move(resolved)));
}

}  // namespace karcher::app
