#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "app/verbs.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/text.hpp"
#include "karcher/version.hpp"

namespace karcher::app {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

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
