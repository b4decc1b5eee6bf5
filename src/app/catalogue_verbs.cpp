#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "app/schema.hpp"
#include "app/verbs.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/text.hpp"
#include "karcher/version.hpp"

namespace karcher::app {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

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

/// Title and directory of every example.
std::vector<std::pair<std::string, std::string>> examples() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& entry : std::filesystem::directory_iterator(examples_directory())) {
    const auto file = entry.path() / "problem.toml";
    if (!std::filesystem::exists(file)) continue;
    std::string title;
    try {
      const Value root = read_toml(file, {});
      if (const Entry* e = root.find("title")) title = e->value.text;
    } catch (const InputError&) {
      title = "(cannot be read)";
    }
    all.emplace_back(entry.path().filename().string(), title);
  }
  std::sort(all.begin(), all.end());
  return all;
}

void doc_section(const SectionInfo& s) {
  fmt::print("{}\n", s.header);
  print_wrapped(s.description, 0);
  for (const KeyInfo& k : s.keys) {
    fmt::print("\n  {} ({}{})\n", k.name, k.type, k.standard == "-" ? std::string(", must be given") : ", default: " + k.standard);
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

void doc_term(const EnergyInfo& info) {
  fmt::print("{}\n", info.type);
  print_wrapped(info.description, 2);
  std::string dimensions;
  for (const int d : info.dimensions) dimensions += (dimensions.empty() ? "" : ", ") + std::to_string(d);
  fmt::print("\n  on          region of dimension {}\n", dimensions);
  for (const FieldSlot& f : info.fields)
    fmt::print("  {:<11} field with values in {}: {}\n", f.key, join_names(f.manifold_names(), ", "), f.description);
  for (const Parameter& p : info.parameters) {
    std::string facts = p.unit;
    if (p.size > 1) facts += fmt::format(", {} numbers", p.size);
    if (p.size == Parameter::ambient) facts += ", as many numbers as the field has coordinates";
    facts += p.default_value ? fmt::format(", default {}", *p.default_value) : std::string(", must be given");
    if (p.minimum > -std::numeric_limits<double>::infinity())
      facts += fmt::format(", {} {}", p.minimum_allowed ? "at least" : "greater than", p.minimum);
    fmt::print("  {:<11} {} ({})\n", p.name, p.description, facts);
  }
  if (info.lame) fmt::print("  {:<11} instead of mu and lambda: Young's modulus and Poisson's ratio\n", "young, poisson");
  for (const Choice& c : info.choices)
    fmt::print("  {:<11} {}: {} (default {})\n", c.name, c.description, join_names(c.values, ", "), c.values.front());
}

}  // namespace

std::filesystem::path examples_directory() {
  std::vector<std::filesystem::path> places;
  if (const char* given = std::getenv("KARCHER_EXAMPLES")) places.emplace_back(given);
  std::error_code code;
  const std::filesystem::path program = std::filesystem::canonical("/proc/self/exe", code);
  places.push_back(program.parent_path() / "examples");  // a link that CMake makes in the build directory
  places.push_back(program.parent_path().parent_path() / "share" / "karcher" / "examples");
  for (const auto& p : places)
    if (std::filesystem::is_directory(p, code)) return p;
  throw Error("The examples are not where they should be (" + places.back().string() + "); say where in the environment variable KARCHER_EXAMPLES.");
}

int list(const std::string& what) {
  const std::vector<std::string> topics{"manifolds", "energies", "loads", "meshes", "examples"};
  if (what.empty()) {
    for (const char* topic : {"manifolds", "energies", "meshes", "examples"}) {
      fmt::print("{}{}\n", topic == topics.front() ? "" : "\n", topic);
      list(topic);
    }
  } else if (what == "manifolds") {
    for (const std::string& name : manifold_names()) {
      const ManifoldOps& m = manifold_by_name(name);
      fmt::print("{:<6} dimension {}, {} ambient coordinates, {}: {}\n", name, m.dim, m.ambient,
                 m.linear           ? "linear"
                 : m.has_projection ? "projection or geodesic"
                                    : "geodesic",
                 m.description);
    }
  } else if (what == "energies" || what == "loads") {
    if (what == "energies")
      for (const EnergyInfo& e : energy_catalogue()) fmt::print("{:<20} {}\n", e.type, first_line(e.description));
    if (what == "energies") fmt::print("\nloads\n");
    for (const EnergyInfo& e : load_catalogue()) fmt::print("{:<20} {}\n", e.type, first_line(e.description));
  } else if (what == "meshes") {
    for (const GeneratorInfo& g : generators()) fmt::print("{:<14} {}\n", g.name, first_line(g.description));
  } else if (what == "examples") {
    for (const auto& [name, title] : examples()) fmt::print("{:<24} {}\n", name, title);
  } else {
    throw InputError("There is no list of \"" + what + "\". " + suggestion(what, topics, "Lists"));
  }
  return 0;
}

int doc(const std::string& key) {
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
      fmt::print("{}: {} ({})\n", key, k.type, k.standard == "-" ? "must be given" : "default: " + k.standard);
      print_wrapped(k.description, 2);
      return 0;
    }
  }
  throw InputError("There is nothing about \"" + key + "\". " + suggestion(key, known, "Pages"));
}

int version() {
  fmt::print("karcher {}\n", version_string);
  return 0;
}

int make_new(const std::string& name, const std::string& example) {
  std::vector<std::string> known;
  for (const auto& entry : examples()) known.push_back(entry.first);
  if (std::find(known.begin(), known.end(), example) == known.end())
    throw InputError("There is no example \"" + example + "\". " + suggestion(example, known, "Examples"));
  const std::filesystem::path target = name;
  if (std::filesystem::exists(target)) throw InputError("\"" + name + "\" exists already; nothing is overwritten.");
  std::error_code code;
  std::filesystem::create_directories(target, code);
  if (code) throw Error("The directory " + name + " cannot be made: " + code.message() + ".");
  for (const auto& entry : std::filesystem::directory_iterator(examples_directory() / example)) {
    const std::string file = entry.path().filename().string();
    if (entry.is_regular_file() && file != "expected.toml" && file != "view") std::filesystem::copy_file(entry.path(), target / file);
  }
  fmt::print("{} is a copy of the example {}; next: karcher run {}\n", (target / "problem.toml").string(), example,
             (target / "problem.toml").string());
  return 0;
}

}  // namespace karcher::app
