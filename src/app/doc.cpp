#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <sstream>

#include "app/schema.hpp"
#include "app/verbs.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

/// Words of a long text on lines of at most `width` letters.
void print_wrapped(const std::string& text, std::size_t indent, std::size_t width = 110) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string out;
    for (std::string word; words >> word;) {
      if (!out.empty() && indent + out.size() + 1 + word.size() > width) {
        fmt::print("{:{}}{}\n", "", indent, out);
        out.clear();
      }
      out += (out.empty() ? "" : " ") + word;
    }
    fmt::print("{:{}}{}\n", "", indent, out);
  }
}

/// The number in as few letters as it takes: "0.5", "1e-8".
std::string number_text(double d) {
  const auto shortest = [d](std::chars_format format) {
    char letters[400];
    return std::string(letters, std::to_chars(letters, letters + sizeof letters, d, format).ptr);
  };
  const std::string fixed = shortest(std::chars_format::fixed), scientific = shortest(std::chars_format::scientific);
  const std::size_t e = scientific.find('e');
  if (e == std::string::npos) return fixed;  // not finite
  const std::string power = fmt::format("{}e{}", scientific.substr(0, e), std::stoi(scientific.substr(e + 1)));
  return power.size() < fixed.size() ? power : fixed;
}

std::string value_text(const Value& v) {
  if (v.is(Value::Kind::text)) return v.text;
  if (v.is(Value::Kind::array)) return v.items.empty() ? "none" : "an array";
  if (v.is(Value::Kind::boolean)) return v.boolean ? "true" : "false";
  return v.is(Value::Kind::integer) ? std::to_string(v.integer) : number_text(v.number);
}

/// "must be given", or the default after the words before it.
std::string default_text(const Default& d, const std::string& before = {}) {
  return d.must_be_given() ? "must be given" : before + (d.value ? value_text(*d.value) : d.words);
}

/// The keys of a section as a table in Markdown.
std::string markdown(const SectionInfo& section) {
  const auto code = [](const std::string& s) { return "`" + s + "`"; };
  std::string table = "| key | type | default | meaning |\n| --- | --- | --- | --- |\n";
  for (const KeyInfo& k : section.keys) {
    std::string type = k.type;
    if (k.kind == KeyKind::word) {
      std::vector<std::string> words;
      for (const std::string& w : k.words) words.push_back(code(w));
      type = join_names(words, words.size() > 2 ? ", " : " or ");
    }
    if (!k.unit.empty()) type += " (" + k.unit + ")";
    const bool word = k.standard.value && k.standard.value->is(Value::Kind::text);
    table +=
        fmt::format("| {} | {} | {} | {} |\n", code(k.name), type, word ? code(k.standard.value->text) : default_text(k.standard), k.description);
  }
  return table;
}

void doc_section(const SectionInfo& s) {
  fmt::print("{}\n", s.header);
  print_wrapped(s.description, 0);
  for (const KeyInfo& k : s.keys) {
    fmt::print("\n  {} ({}, {})\n", k.name, k.type, default_text(k.standard, "default: "));
    print_wrapped(k.description, 6);
  }
}

void doc_generators() {
  fmt::print("[mesh] generate = \"...\" with these arguments (defaults)\n");
  for (const GeneratorInfo& g : generators()) {
    fmt::print("\n{}\n", g.name);
    print_wrapped(g.description, 2);
    for (const GeneratorArgument& a : g.arguments) {
      std::string standard;
      for (const double x : a.numbers) standard += fmt::format("{}{:.10g}", standard.empty() ? "" : ", ", x);
      if (a.numbers.size() > 1) standard = "[" + standard + "]";
      fmt::print("    {:<10} {} ({})\n", a.name, a.description, a.is_choice() ? join_names(a.words, ", or ") : standard);
    }
    fmt::print("    regions    {}\n", g.regions.empty() ? "all" : "all, " + join_names(g.regions));
  }
}

/// "with material = hencky or exp-hencky"
std::string condition_text(const Condition& only) { return fmt::format("with {} = {}", only.choice, join_names(only.words, " or ")); }

void doc_term(const EnergyInfo& info) {
  fmt::print("{}\n", info.type);
  print_wrapped(info.description, 2);
  std::string dimensions;
  for (const int d : info.dimensions) dimensions += (dimensions.empty() ? "" : ", ") + std::to_string(d);
  fmt::print("\n  on          region of dimension {}\n", dimensions);
  for (const KeyInfo& k : info.formula ? formula_keys() : std::vector<KeyInfo>()) {
    fmt::print("\n  {} ({}, {})\n", k.name, k.type, default_text(k.standard, "default: "));
    print_wrapped(k.description, 6);
  }
  for (const FieldSlot& f : info.fields)
    fmt::print("  {:<11} field with values in {}: {}\n", f.key, join_names(f.manifold_names(), ", "), f.description);
  for (const Parameter& p : info.parameters) {
    std::string facts = p.unit;
    if (p.size > 1) facts += fmt::format(", {} numbers", p.size);
    if (p.size == Parameter::ambient) facts += ", as many numbers as the field has coordinates";
    facts += p.default_value ? fmt::format(", default {}", *p.default_value) : std::string(", must be given");
    if (p.minimum > -std::numeric_limits<double>::infinity())
      facts += fmt::format(", {} {}", p.minimum_allowed ? "at least" : "greater than", p.minimum);
    if (p.only) facts += ", " + condition_text(*p.only);
    fmt::print("  {:<11} {} ({})\n", p.name, p.description, facts);
  }
  if (info.lame) fmt::print("  {:<11} instead of mu and lambda: Young's modulus and Poisson's ratio\n", "young, poisson");
  for (const Choice& c : info.choices)
    fmt::print("  {:<11} {}: {} (default {}{})\n", c.name, c.description, join_names(c.values, ", "), c.values.front(),
               c.only ? ", " + condition_text(*c.only) : std::string());
}

/// Prints every key whose name or text has the word. \returns false if there is none
bool doc_search(const std::string& word) {
  bool found = false;
  const auto offer = [&](const std::string& page, const std::string& text) {
    if (lower_case(page + " " + text).find(lower_case(word)) == std::string::npos) return;
    fmt::print("{}\n", page);
    print_wrapped(text, 4);
    found = true;
  };
  for (const SectionInfo& s : schema()) {
    if (s.name.empty()) continue;
    offer(s.name, s.description);
    if (s.name != "loads")
      for (const KeyInfo& k : s.keys) offer(s.name + "." + k.name, k.description);
  }
  for (const GeneratorInfo& g : generators()) offer("mesh.generate = \"" + g.name + "\"", g.description);
  for (const auto& [section, catalogue] : {std::pair("energies", &energy_catalogue()), {"loads", &load_catalogue()}})
    for (const EnergyInfo& info : *catalogue) {
      std::string text = info.description;
      for (const Parameter& p : info.parameters) text += "\n" + p.name + ": " + p.description;
      offer(std::string(section) + "." + info.type, text);
    }
  return found;
}

}  // namespace

int doc(const std::string& key, bool as_markdown) {
  if (as_markdown) {
    std::vector<std::string> sections;
    for (const SectionInfo& s : schema()) {
      if (s.keys.empty() || s.name.empty()) continue;
      sections.push_back(s.name);
      if (s.name == key) return fmt::print("{}", markdown(s)), 0;
    }
    throw InputError("--markdown makes the table of a section. " + suggestion(key, sections, "Sections"));
  }
  if (key.empty()) {
    for (const SectionInfo& s : schema()) {
      fmt::print("{:<18} ", s.header);
      print_wrapped(s.description, 0, 1000);
    }
    fmt::print("\nkarcher doc SECTION (for instance solver), mesh.generate, energies.TYPE, loads.TYPE, SECTION.KEY\n");
    return 0;
  }
  std::vector<std::string> known{"mesh.generate"};
  if (key == "mesh.generate") return doc_generators(), 0;
  for (const auto& [section, catalogue] : {std::pair("energies", &energy_catalogue()), {"loads", &load_catalogue()}})
    for (const EnergyInfo& info : *catalogue) {
      known.push_back(std::string(section) + "." + info.type);
      if (known.back() == key) return doc_term(info), 0;
    }
  for (const SectionInfo& s : schema()) {
    if (!s.name.empty()) known.push_back(s.name);
    if (s.name == key) return doc_section(s), 0;
    for (const KeyInfo& k : s.keys) {
      if (s.name.empty()) continue;
      known.push_back(s.name + "." + k.name);
      if (known.back() != key) continue;
      fmt::print("{}: {} ({})\n", key, k.type, default_text(k.standard, "default: "));
      print_wrapped(k.description, 2);
      return 0;
    }
  }
  if (doc_search(key)) return 0;
  throw InputError("There is nothing about \"" + key + "\". " + suggestion(key, known, "Pages"));
}

}  // namespace karcher::app
