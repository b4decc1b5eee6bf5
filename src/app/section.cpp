#include "app/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "karcher/text.hpp"

namespace karcher::app {

void refuse_name(const Place& place, const std::string& what, const std::string& name, const std::vector<std::string>& allowed) {
  refuse(place, what + " \"" + shortened(name) + "\". " + suggestion(name, allowed, "Allowed"));
}

void check_name(const Place& place, const std::string& what, const std::string& name) {
  if (const std::string fault = fault_of_name(name); !fault.empty())
    refuse(place, "the name of the " + what + " \"" + printable(shortened(name)) + "\" " + fault + ".");
}

Expression expression_of(const Value& value, const std::string& key, const Scope& scope) {
  if (value.is_number()) {
    if (!std::isfinite(value.as_double())) refuse(value.place, key + " must be finite.");
    return Expression(value.as_double());
  }
  if (!value.is(Value::Kind::text)) refuse(value.place, key + " must be a number or an expression in quotes, not " + value.kind_name() + ".");
  return scope.compile(value.text, key, value.text_place());
}

Section::Section(const Value* table, std::string path, Place place, std::vector<KeyInfo> keys)
    : table_(table), path_(std::move(path)), place_(std::move(place)), keys_(std::move(keys)) {
  if (!table_) return;
  if (!table_->is(Value::Kind::table)) refuse(table_->place, path_ + " must be a table, not " + table_->kind_name() + ".");
  const std::vector<std::string> allowed = key_names(keys_);
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

const KeyInfo& Section::info(const std::string& key, std::initializer_list<KeyKind> kinds) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const KeyInfo& k) { return k.name == key; });
  if (found == keys_.end() || std::find(kinds.begin(), kinds.end(), found->kind) == kinds.end())
    throw std::logic_error("no key " + path(key) + " of this kind");
  return *found;
}

const Value& Section::value(const KeyInfo& key) const {
  const Value* v = given(key.name);
  if (!v && !key.standard.value) missing(key.name);
  return v ? *v : *key.standard.value;
}

const Value* Section::raw(const std::string& key) {
  info(key, {KeyKind::point});
  const Value* v = given(key);
  if (v) note(key, *v);
  return v;
}

std::string Section::text(const std::string& key, const std::optional<std::string>& standard) {
  const KeyInfo& k = info(key, {KeyKind::text, KeyKind::word});
  const Value& v = standard && !given(key) ? Value::of(*standard) : value(k);
  if (!v.is(Value::Kind::text)) wrong_type(key, v, "a string");
  constexpr std::size_t longest = 4000;
  if (given(key) && v.text.size() > longest) refuse(v.place, fmt::format("{} has more than {} characters.", path(key), longest));
  if (given(key) && has_control_characters(v.text)) refuse(v.place, path(key) + " must be one line without control characters.");
  note(key, Value::of(v.text));
  return v.text;
}

std::string Section::word(const std::string& key, const std::optional<std::string>& standard, const std::vector<std::string>& words) {
  const KeyInfo& k = info(key, {KeyKind::word});
  const std::vector<std::string>& allowed = words.empty() ? k.words : words;
  const std::string s = text(key, standard);
  if (std::find(allowed.begin(), allowed.end(), s) == allowed.end()) refuse_name(place(key), path(key) + " cannot be", s, allowed);
  return s;
}

std::vector<Value> Section::texts(const std::string& key) {
  const Value& v = value(info(key, {KeyKind::texts}));
  note(key, v);
  if (v.is(Value::Kind::text)) return {v};
  if (!v.is(Value::Kind::array)) wrong_type(key, v, "a string or an array of strings");
  for (std::size_t i = 0; i < v.items.size(); ++i)
    if (!v.items[i].is(Value::Kind::text))
      refuse(v.items[i].place, fmt::format("{}.{} must be a string, not {}.", path(key), i, v.items[i].kind_name()));
  return v.items;
}

Value Section::formula(const std::string& key) {
  const Value& v = value(info(key, {KeyKind::formula}));
  if (!v.is(Value::Kind::text)) wrong_type(key, v, "an expression in quotes");
  note(key, v);
  return v;
}

bool Section::flag(const std::string& key) {
  const Value& v = value(info(key, {KeyKind::flag}));
  if (!v.is(Value::Kind::boolean)) wrong_type(key, v, "true or false");
  note(key, Value::of(v.boolean));
  return v.boolean;
}

int Section::integer(const std::string& key, const std::optional<int>& standard) {
  const KeyInfo& k = info(key, {KeyKind::integer});
  const Value& v = standard && !given(key) ? Value::of(static_cast<long long>(*standard)) : value(k);
  const bool whole = v.is(Value::Kind::integer) || (v.is(Value::Kind::number) && v.number == std::floor(v.number) && std::abs(v.number) < 1e9);
  if (!whole) wrong_type(key, v, "a whole number");
  const long long i = v.is(Value::Kind::integer) ? v.integer : static_cast<long long>(v.number);
  if (i < k.minimum || i > k.maximum) refuse(v.place, fmt::format("{} must be from {} to {}, not {}.", path(key), k.minimum, k.maximum, i));
  note(key, Value::of(i));
  return static_cast<int>(i);
}

double Section::number(const std::string& key) {
  const Value& v = value(info(key, {KeyKind::number}));
  if (!v.is_number()) wrong_type(key, v, "a number");
  const double d = v.as_double();
  if (!std::isfinite(d)) refuse(place(key), path(key) + " must be finite.");
  note(key, Value::of(d));
  return d;
}

Expression Section::single(const std::string& key, const Scope& scope, KeyKind kind) {
  const Value& v = value(info(key, {kind}));
  note(key, v);
  return expression_of(v, path(key), scope);
}

std::vector<Expression> Section::several(const std::string& key, const Scope& scope, KeyKind kind, std::size_t size) {
  const KeyInfo& k = info(key, {kind});
  if (size == 0) size = k.size;
  Value v = value(k);
  // One number is the default of all.
  if (!given(key) && !v.is(Value::Kind::array)) v = Value::of(std::vector<Value>(size, v));
  note(key, v);
  const bool array = v.is(Value::Kind::array);
  const std::size_t count = array ? v.items.size() : 1;
  if (count != size)
    refuse(v.place, fmt::format("{} takes {} number{} or expression{}, not {}.", path(key), size, size == 1 ? "" : "s", size == 1 ? "" : "s", count));
  std::vector<Expression> result;
  for (std::size_t i = 0; i < count; ++i)
    result.push_back(expression_of(array ? v.items[i] : v, array ? fmt::format("{}.{}", path(key), i) : path(key), scope));
  return result;
}

double Section::constant_of(const std::string& key, const Expression& e) const {
  if (!e.is_constant()) refuse(place(key), path(key) + " must not depend on x, y, z or t.");
  return e.constant();
}

Expression Section::expression(const std::string& key, const Scope& scope) { return single(key, scope, KeyKind::expression); }

double Section::constant(const std::string& key, const Scope& scope) { return constant_of(key, single(key, scope, KeyKind::constant)); }

std::vector<Expression> Section::expressions(const std::string& key, const Scope& scope, std::size_t size) {
  return several(key, scope, KeyKind::expression, size);
}

std::vector<double> Section::constants(const std::string& key, const Scope& scope) {
  std::vector<double> result;
  for (const Expression& e : several(key, scope, KeyKind::constant, 0)) result.push_back(constant_of(key, e));
  return result;
}

}  // namespace karcher::app
