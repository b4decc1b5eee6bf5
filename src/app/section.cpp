#include "app/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/text.hpp"

namespace karcher::app {

void refuse_name(const Place& place, const std::string& what, const std::string& name, const std::vector<std::string>& allowed) {
  refuse(place, what + " \"" + name + "\". " + suggestion(name, allowed, "Allowed"));
}

Expression expression_of(const Value& value, const std::string& key, const Scope& scope) {
  if (value.is_number()) {
    if (!std::isfinite(value.as_double())) refuse(value.place, key + " must be finite.");
    return Expression(value.as_double());
  }
  if (!value.is(Value::Kind::text)) refuse(value.place, key + " must be a number or an expression in quotes, not " + value.kind_name() + ".");
  return scope.compile(value.text, key, value.place.line > 0 ? value.place.shifted(1) : value.place);
}

Section::Section(const Value* table, std::string path, Place place, std::vector<std::string> allowed)
    : table_(table), path_(std::move(path)), place_(std::move(place)) {
  if (!table_) return;
  if (!table_->is(Value::Kind::table)) refuse(table_->place, path_ + " must be a table, not " + table_->kind_name() + ".");
  for (const Entry& e : table_->entries)
    if (std::find(allowed.begin(), allowed.end(), e.key) == allowed.end())
      refuse_name(e.place, (path_.empty() ? std::string("unknown key") : "in " + path_ + ": unknown key"), e.key, allowed);
}

const Value* Section::given(const std::string& key) const {
  const Entry* e = table_ ? table_->find(key) : nullptr;
  return e ? &e->value : nullptr;
}

Place Section::place(const std::string& key) const {
  const Value* v = given(key);
  return v ? v->place : place_;
}

void Section::missing(const std::string& key) const { refuse(place_, (path_.empty() ? "the file" : path_) + " lacks the key \"" + key + "\"."); }

void Section::wrong_type(const std::string& key, const Value& value, const std::string& expected) const {
  refuse(value.place, path(key) + " must be " + expected + ", not " + value.kind_name() + ".");
}

void Section::note(const std::string& key, Value value) {
  if (Entry* e = resolved_.find(key))
    e->value = std::move(value);
  else
    resolved_.append(key, {}, std::move(value));
}

const Value* Section::raw(const std::string& key) {
  const Value* v = given(key);
  if (v) note(key, *v);
  return v;
}

std::string Section::text(const std::string& key, const std::optional<std::string>& standard) {
  const Value* v = given(key);
  if (!v && !standard) missing(key);
  if (v && !v->is(Value::Kind::text)) wrong_type(key, *v, "a string");
  const std::string s = v ? v->text : *standard;
  note(key, Value::of(s));
  return s;
}

std::string Section::word(const std::string& key, const std::vector<std::string>& words, const std::optional<std::string>& standard) {
  const std::string s = text(key, standard);
  if (std::find(words.begin(), words.end(), s) == words.end()) refuse_name(place(key), path(key) + " cannot be", s, words);
  return s;
}

bool Section::flag(const std::string& key, bool standard) {
  const Value* v = given(key);
  if (v && !v->is(Value::Kind::boolean)) wrong_type(key, *v, "true or false");
  const bool b = v ? v->boolean : standard;
  note(key, Value::of(b));
  return b;
}

int Section::integer(const std::string& key, std::optional<int> standard, int minimum, int maximum) {
  const Value* v = given(key);
  if (!v && !standard) missing(key);
  if (!v) {
    note(key, Value::of(*standard));
    return *standard;
  }
  const bool whole = v->is(Value::Kind::integer) || (v->is(Value::Kind::number) && v->number == std::floor(v->number) && std::abs(v->number) < 1e9);
  if (!whole) wrong_type(key, *v, "a whole number");
  const long long i = v->is(Value::Kind::integer) ? v->integer : static_cast<long long>(v->number);
  if (i < minimum || i > maximum) refuse(v->place, fmt::format("{} must be from {} to {}, not {}.", path(key), minimum, maximum, i));
  note(key, Value::of(i));
  return static_cast<int>(i);
}

double Section::number(const std::string& key, std::optional<double> standard) {
  const Value* v = given(key);
  if (!v && !standard) missing(key);
  if (v && !v->is_number()) wrong_type(key, *v, "a number");
  const double d = v ? v->as_double() : *standard;
  if (!std::isfinite(d)) refuse(place(key), path(key) + " must be finite.");
  note(key, Value::of(d));
  return d;
}

Expression Section::expression(const std::string& key, const Scope& scope, const std::optional<double>& standard) {
  const Value* v = given(key);
  if (!v && !standard) missing(key);
  note(key, v ? *v : Value::of(*standard));
  return v ? expression_of(*v, path(key), scope) : Expression(*standard);
}

double Section::constant(const std::string& key, const Scope& scope, const std::optional<double>& standard) {
  const Expression e = expression(key, scope, standard);
  if (!e.is_constant()) refuse(place(key), path(key) + " must not depend on x, y, z or t.");
  return e.constant();
}

std::vector<Expression> Section::expressions(const std::string& key, const Scope& scope, std::size_t size, const std::vector<double>& standard) {
  const Value* v = given(key);
  std::vector<Expression> result;
  if (!v) {
    if (standard.size() != size) missing(key);
    std::vector<Value> items;
    for (const double d : standard) {
      result.emplace_back(d);
      items.push_back(Value::of(d));
    }
    note(key, Value::of(std::move(items)));
    return result;
  }
  note(key, *v);
  const bool array = v->is(Value::Kind::array);
  const std::size_t count = array ? v->items.size() : 1;
  if (count != size)
    refuse(v->place,
           fmt::format("{} takes {} number{} or expression{}, not {}.", path(key), size, size == 1 ? "" : "s", size == 1 ? "" : "s", count));
  for (std::size_t i = 0; i < count; ++i)
    result.push_back(expression_of(array ? v->items[i] : *v, array ? fmt::format("{}.{}", path(key), i) : path(key), scope));
  return result;
}

std::vector<double> Section::constants(const std::string& key, const Scope& scope, std::size_t size, const std::vector<double>& standard) {
  std::vector<double> result;
  for (const Expression& e : expressions(key, scope, size, standard)) {
    if (!e.is_constant()) refuse(place(key), path(key) + " must not depend on x, y, z or t.");
    result.push_back(e.constant());
  }
  return result;
}

}  // namespace karcher::app
