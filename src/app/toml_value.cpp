#include "app/toml_value.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "karcher/io/atomic_file.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

/// Parts of a dotted key, which no key of a problem file comes near.
constexpr int most_parts = 10;

/// Past the string that begins here.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool several_lines = text.substr(begin, 3) == three;
  for (std::size_t i = begin + (several_lines ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (several_lines && text.substr(i, 3) == three) {
      // Up to two quotation marks may stand before the three that end it.
      const std::size_t after = std::min(text.find_first_not_of(quote, i), text.size());
      return std::min(after, i + 5);
    } else if (!several_lines && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    }
  }
  return text.size();
}

/// toml++ limits how deep values are nested, but not how many parts a dotted key has; each is a table in a table.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') i = std::min(text.find('\n', i), text.size() - 1);
    if (c == '.' && ++parts > most_parts) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
      refuse({file, static_cast<int>(line), static_cast<int>(i - text.substr(0, i).rfind('\n'))},
             fmt::format("a key of more than {} parts is none of a problem file.", most_parts));
    }
    if (std::string_view(",=[]{}#\n").find(c) != std::string_view::npos) parts = 1;
    ++i;
  }
}

Place place_of(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

Value convert(const toml::node& node, const std::string& file) {
  Value v;
  v.place = place_of(node.source(), file);
  if (const auto* t = node.as_table()) {
    for (const auto& [key, child] : *t) v.append(std::string(key.str()), place_of(key.source(), file), convert(child, file));
    // toml++ sorts by name; parameters are evaluated in the order of the file.
    std::stable_sort(v.entries.begin(), v.entries.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
  } else if (const auto* a = node.as_array()) {
    v.kind = Value::Kind::array;
    for (const auto& child : *a) v.items.push_back(convert(child, file));
  } else if (const auto* s = node.as_string()) {
    v.kind = Value::Kind::text;
    v.text = s->get();
    // Behind one quotation mark or three; a line that ends behind the three is no part of the text.
    const toml::source_region& at = node.source();
    const auto lines = std::count(v.text.begin(), v.text.end(), '\n');
    const bool three = lines > 0 || at.end.column - at.begin.column == v.text.size() + 6;
    v.text_line = static_cast<std::ptrdiff_t>(at.end.line - at.begin.line) > lines ? 1 : 0;
    v.text_column = three ? 3 : 1;
  } else if (const auto* i = node.as_integer()) {
    v.kind = Value::Kind::integer;
    v.integer = i->get();
  } else if (const auto* d = node.as_floating_point()) {
    v.kind = Value::Kind::number;
    v.number = d->get();
  } else if (const auto* b = node.as_boolean()) {
    v.kind = Value::Kind::boolean;
    v.boolean = b->get();
  } else {
    refuse(v.place, "dates and times mean nothing here.");
  }
  return v;
}

void set_places(Value& v, const Place& place) {
  v.place = place;
  for (Value& item : v.items) set_places(item, place);
  for (Entry& e : v.entries) {
    e.place = place;
    set_places(e.value, place);
  }
}

Value parse_override(const std::string& text, const Place& place) {
  Value v;
  try {
    const toml::table t = toml::parse("value = " + text);
    v = convert(*t.get("value"), "");
    if (t.size() != 1) v = Value::of(text);
  } catch (const toml::parse_error&) {
    v = Value::of(text);
  }
  set_places(v, place);
  return v;
}

std::vector<std::string> split(const std::string& dotted) {
  std::vector<std::string> parts{""};
  for (const char c : dotted) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

bool is_index(const std::string& s) {
  return !s.empty() && s.size() < 9 && std::all_of(s.begin(), s.end(), [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
}

void apply_override(Value& root, const std::string& text) {
  const Place place{"--set " + text, 0, 0};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse(place, "an override is KEY=VALUE, for instance solver.max_iterations=50.");
  const auto trimmed = [](std::string s) {
    while (!s.empty() && s.back() == ' ') s.pop_back();
    while (!s.empty() && s.front() == ' ') s.erase(0, 1);
    return s;
  };
  std::vector<std::string> path = split(trimmed(text.substr(0, equals)));
  if (path.size() > static_cast<std::size_t>(most_parts))
    refuse({"--set", 0, 0}, fmt::format("a key of more than {} parts is none of a problem file.", most_parts));
  if (path.size() == 1 && !root.find(path[0])) {
    const Entry* parameters = root.find("parameters");
    if (parameters && parameters->value.find(path[0])) path.insert(path.begin(), "parameters");
  }
  Value* at = &root;
  std::string so_far;
  for (const std::string& part : path) {
    if (part.empty()) refuse(place, "the key has an empty part.");
    if (at->is(Value::Kind::array)) {
      if (!is_index(part) || static_cast<std::size_t>(std::stoi(part)) >= at->items.size())
        refuse(place, fmt::format("\"{}\" has {} entries; an entry is named by its number from 0, not \"{}\".", so_far, at->items.size(), part));
      at = &at->items[static_cast<std::size_t>(std::stoi(part))];
    } else if (at->is(Value::Kind::table)) {
      Entry* entry = at->find(part);
      if (!entry) {
        entry = &at->append(part, place, {});
        entry->value.place = place;
      }
      at = &entry->value;
    } else {
      refuse(place, fmt::format("\"{}\" is {} and has no part \"{}\".", so_far, at->kind_name(), part));
    }
    so_far += (so_far.empty() ? "" : ".") + part;
  }
  *at = parse_override(trimmed(text.substr(equals + 1)), place);
}

std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (const char c : s) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (u < 0x20 || u == 0x7f)
      out += fmt::format("\\u{:04x}", u);
    else
      out += c;
  }
  return out + "\"";
}

std::string key_text(const std::string& key) {
  const bool bare =
      !key.empty() && std::all_of(key.begin(), key.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; });
  return bare ? key : quoted(key);
}

std::string number_text(double d) {
  if (std::isnan(d)) return "nan";
  if (std::isinf(d)) return d > 0 ? "inf" : "-inf";
  std::string s = fmt::format("{}", d);
  if (s.find_first_of(".en") == std::string::npos) s += ".0";
  return s;
}

std::string inline_text(const Value& v) {
  switch (v.kind) {
    case Value::Kind::boolean:
      return v.boolean ? "true" : "false";
    case Value::Kind::integer:
      return std::to_string(v.integer);
    case Value::Kind::number:
      return number_text(v.number);
    case Value::Kind::text:
      return quoted(v.text);
    case Value::Kind::array: {
      std::string s;
      for (const Value& item : v.items) s += (s.empty() ? "" : ", ") + inline_text(item);
      return "[" + s + "]";
    }
    case Value::Kind::table: {
      std::string s;
      for (const Entry& e : v.entries) s += (s.empty() ? " " : ", ") + key_text(e.key) + " = " + inline_text(e.value);
      return "{" + s + " }";
    }
  }
  return {};
}

bool is_table_array(const Value& v) {
  return v.is(Value::Kind::array) && !v.items.empty() &&
         std::all_of(v.items.begin(), v.items.end(), [](const Value& item) { return item.is(Value::Kind::table); });
}

/// Tables below `depth` 2 are written inline: sections are [a], [a.b] and [[a]].
void write(const Value& table, const std::string& header, int depth, std::string& out) {
  const auto deferred = [&](const Value& v) { return depth < 2 && (v.is(Value::Kind::table) || (depth == 0 && is_table_array(v))); };
  for (const Entry& e : table.entries)
    if (!deferred(e.value)) out += key_text(e.key) + " = " + inline_text(e.value) + "\n";
  for (const Entry& e : table.entries) {
    if (!deferred(e.value)) continue;
    const std::string name = header.empty() ? key_text(e.key) : header + "." + key_text(e.key);
    if (is_table_array(e.value)) {
      for (const Value& item : e.value.items) {
        out += "\n[[" + name + "]]\n";
        write(item, name, 2, out);
      }
      continue;
    }
    const bool has_own_keys = std::any_of(e.value.entries.begin(), e.value.entries.end(),
                                          [&](const Entry& inner) { return depth + 1 >= 2 || !inner.value.is(Value::Kind::table); });
    if (has_own_keys) out += "\n[" + name + "]\n";
    write(e.value, name, depth + 1, out);
  }
}

/// What a line that is not TOML may have meant, as a sentence to follow.
std::string hint_for(std::string_view line) {
  const auto trimmed = [](std::string_view s) {
    while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
    while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
    return s;
  };
  line = trimmed(line.substr(0, line.find('#')));
  for (const std::string_view name : {"fields", "regions"})
    if (line.starts_with("[[" + std::string(name))) return fmt::format(" Every one of the {0} is a table with its name: [{0}.NAME].", name);
  const std::size_t equals = line.find('=');
  if (equals == line.npos) return {};
  const std::string_view key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
  if (value.empty()) return {};
  const auto first = static_cast<unsigned char>(value.front());
  if (std::isalpha(first)) return fmt::format(" A string stands in quotes: {} = \"{}\".", key, shortened(value, 100));
  const std::size_t end = value.find_first_not_of("0123456789+-._eE");
  if (end == value.npos || (!std::isdigit(first) && value.find_first_of("+-.") != 0)) return {};
  const std::string_view rest = trimmed(value.substr(end));
  if (rest.empty()) return {};
  if (std::isalpha(static_cast<unsigned char>(rest.front())))
    return " Numbers have no units here: state all of them in one system, as N, mm and MPa.";
  return fmt::format(" A formula stands in quotes: {} = \"{}\".", key, shortened(value, 100));
}

std::string line_of(std::string_view content, std::size_t number) {
  for (; number > 1; --number) {
    const std::size_t end = content.find('\n');
    if (end == content.npos) return {};
    content.remove_prefix(end + 1);
  }
  return std::string(content.substr(0, content.find('\n')));
}

}  // namespace

Value Value::of(bool b) {
  Value v;
  v.kind = Kind::boolean;
  v.boolean = b;
  return v;
}
Value Value::of(long long i) {
  Value v;
  v.kind = Kind::integer;
  v.integer = i;
  return v;
}
Value Value::of(double d) {
  Value v;
  v.kind = Kind::number;
  v.number = d;
  return v;
}
Value Value::of(std::string s) {
  Value v;
  v.kind = Kind::text;
  v.text = std::move(s);
  return v;
}
Value Value::of(std::vector<Value> array) {
  Value v;
  v.kind = Kind::array;
  v.items = std::move(array);
  return v;
}

const Entry* Value::find(const std::string& key) const {
  for (const Entry& e : entries)
    if (e.key == key) return &e;
  return nullptr;
}
Entry* Value::find(const std::string& key) { return const_cast<Entry*>(static_cast<const Value*>(this)->find(key)); }

Entry& Value::append(std::string key, Place at, Value value) {
  Entry& e = entries.emplace_back();
  e.key = std::move(key);
  e.place = std::move(at);
  e.value = std::move(value);
  return e;
}

std::string Value::kind_name() const {
  switch (kind) {
    case Kind::boolean:
      return "true or false";
    case Kind::integer:
      return "a whole number";
    case Kind::number:
      return "a number";
    case Kind::text:
      return "a string";
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
  }
  return {};
}

Value read_toml(const std::filesystem::path& file, std::span<const std::string> overrides) {
  std::error_code unknown;
  if (std::filesystem::is_directory(file, unknown)) throw InputError(file.string() + " is a directory, not a problem file.");
  constexpr std::size_t most = 10'000'000;
  const std::string content = read_whole(file, most);
  refuse_deep_keys(content, file.string());
  Value root;
  try {
    root = convert(toml::parse(content, file.string()), file.string());
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    if (!what.empty() && what.back() != '.') what += '.';
    refuse(place_of(error.source(), file.string()), "this is not TOML: " + what + hint_for(line_of(content, error.source().begin.line)));
  }
  for (const std::string& text : overrides) apply_override(root, text);
  return root;
}

std::string to_toml(const Value& table) {
  std::string out;
  write(table, "", 0, out);
  return out;
}

}  // namespace karcher::app
