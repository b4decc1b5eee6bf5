// The table of keys: the reader reads all of it with its defaults, and the reference is made of it.

#include "app/schema.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "app/problem_file.hpp"
#include "program_runner.hpp"

namespace karcher::app {
namespace {

using testing::content;
using testing::Outcome;
using testing::Workshop;

/// Every key there is, but those of a mesh file, which excludes `mesh.generate`.
const std::string everything = R"toml(title = "Every key"
[parameters]
L = 2
P = {csv = "load.csv", column = "P", time = "t"}
[mesh]
generate = "rectangle"
refine = 0
[regions.part]
dim = 2
where = "x < 2"
boundary = false
[regions.tip]
near = [1, 1, 0]
[reference]
position = ["x", "y", "z"]
order = 1
[fields.m]
manifold = "R3"
order = 1
interpolation = "projection"
on = "all"
initial = {results = "earlier", step = 1, field = "m", values = "reference"}
[[energies]]
type = "harmonic"
on = "all"
field = "m"
[[loads]]
type = "volume"
on = "all"
field = "m"
value = [0, 0, 1]
[[dirichlet]]
name = "wall"
field = "m"
on = "left"
value = "initial"
from = 0
to = 0.5
[[dirichlet]]
field = "m"
on = "right"
support = "clamped"
[[dirichlet]]
field = "m"
on = "right"
symmetry = "x"
[[dirichlet]]
field = "m"
on = "right"
diaphragm = "x"
[continuation]
from = 0
to = 1
steps = 1
adaptive = false
smallest = 0.1
[solver]
method = "trust-region"
subproblem = "direct"
norm = "mass"
gradient_tolerance = 1e-8
absolute_gradient_tolerance = 0
step_tolerance = 0
max_iterations = 1
initial_radius = 0
max_corrections = 1
escape = false
[quadrature]
degree = 1
line = 1
triangle = 1
quadrilateral = 1
tetrahedron = 1
hexahedron = 1
[exact.m]
value = ["x", "y", "z"]
[[probes]]
name = "tip"
field = "m"
at = [1, 1, 0]
quantity = "value"
[output]
directory = "results"
vtu = false
report = false
every = 1
)toml";

const std::string needed = R"toml(
[parameters]
P = {csv = "load.csv", column = "P"}
[mesh]
generate = "rectangle"
[regions.part]
dim = 2
where = "x < 2"
[reference]
position = ["x", "y", "z"]
[fields.m]
manifold = "R3"
[[energies]]
type = "harmonic"
field = "m"
[[loads]]
type = "volume"
field = "m"
value = [0, 0, 1]
[[dirichlet]]
field = "m"
on = "left"
value = "initial"
[[probes]]
name = "tip"
field = "m"
at = [1, 1, 0]
)toml";

/// The section's entries in a resolved problem: those of the table, of all named tables, or of all in an array; the series among the parameters.
std::vector<Entry> resolved(const Value& file, const SectionInfo& section) {
  if (section.name.empty()) return file.entries;
  if (section.name == "fields.initial") return file.find("fields")->value.entries.at(0).value.find("initial")->value.entries;
  const Entry* e = file.find(section.name);
  if (!e) return {};
  if (section.name == "parameters") return e->value.find("P")->value.entries;
  std::vector<Entry> all;
  const auto append = [&](const Value& table) { all.insert(all.end(), table.entries.begin(), table.entries.end()); };
  if (section.header.starts_with("[["))
    for (const Value& item : e->value.items) append(item);
  else if (section.header.find('.') != std::string::npos)
    for (const Entry& named : e->value.entries) append(named.value);
  else
    append(e->value);
  return all;
}
const Entry* find(const std::vector<Entry>& entries, const std::string& key) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}
bool is_of_file(const SectionInfo& s, const KeyInfo& k) { return s.name == "mesh" && (k.name == "file" || k.name == "periodic"); }

TEST(Schema, EveryKeyIsReadAndResolved) {
  const Workshop shop;
  shop.write("load.csv", "t,P\n0,0\n1,1\n");
  const Problem problem = read_problem(shop.write("everything.toml", everything));
  const Value file = read_toml(shop.write("resolved.toml", problem.resolved), {});
  for (const SectionInfo& s : schema()) {
    const std::vector<Entry> entries = resolved(file, s);
    ASSERT_FALSE(entries.empty()) << s.header;
    for (const KeyInfo& k : s.keys)
      EXPECT_TRUE(find(entries, k.name) || is_of_file(s, k) || (s.name == "quadrature" && k.name == "degree")) << s.header << " " << k.name;
  }
}

TEST(Schema, DefaultsAreThoseOfTheTableInTheResolvedFile) {
  const Workshop shop;
  shop.write("load.csv", "t,P\n0,0\n1,1\n");
  const Problem problem = read_problem(shop.write("needed.toml", needed));
  const Value file = read_toml(shop.write("resolved.toml", problem.resolved), {});
  int defaults = 0;
  for (const SectionInfo& s : schema())
    for (const KeyInfo& k : s.keys) {
      if (!k.standard.value || is_of_file(s, k)) continue;
      ++defaults;
      Value expected, found;
      expected.append(k.name, {}, *k.standard.value);
      const std::vector<Entry> entries = resolved(file, s);
      ASSERT_TRUE(find(entries, k.name)) << s.header << " " << k.name;
      found.append(k.name, {}, find(entries, k.name)->value);
      EXPECT_EQ(to_toml(found), to_toml(expected)) << s.header;
    }
  EXPECT_GE(defaults, 24);
  EXPECT_EQ(problem.solver.gradient_tolerance, SolverOptions{}.gradient_tolerance);
  EXPECT_EQ(problem.continuation.smallest, ContinuationOptions{}.smallest);
}

TEST(Schema, WordsAreThoseThatTheSolverTakes) {
  for (const auto& [key, member] :
       {std::pair("method", &SolverOptions::method), {"subproblem", &SolverOptions::subproblem}, {"norm", &SolverOptions::norm}}) {
    const auto& keys = section_info("solver").keys;
    const auto found = std::find_if(keys.begin(), keys.end(), [name = key](const KeyInfo& k) { return k.name == name; });
    ASSERT_NE(found, keys.end());
    ASSERT_FALSE(found->words.empty());
    for (std::string word : found->words) {
      SolverOptions options;
      options.*member = word;
      EXPECT_TRUE(options.validate().empty()) << word;
      options.*member = word + "s";
      EXPECT_EQ(options.validate().size(), 1U) << word;
    }
  }
}

TEST(Schema, TheReferenceHasTheTablesOfAllSections) {
  const Workshop shop;
  const std::string reference = content(KARCHER_SOURCE_DIR "/docs/problem-file.md");
  std::size_t rows = 0;
  for (const SectionInfo& s : schema()) {
    if (s.name.empty() || s.keys.empty()) continue;
    const Outcome o = shop.karcher("doc --markdown " + s.name);
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(static_cast<std::size_t>(std::count(o.out.begin(), o.out.end(), '\n')), s.keys.size() + 2);
    // [[loads]] has the keys of [[energies]].
    const std::string head = s.name == "loads" ? "" : "<!-- program: doc --markdown " + s.name + " -->";
    EXPECT_NE(reference.find(head + "\n" + o.out + "\n"), std::string::npos)
        << s.header << " has other keys in docs/problem-file.md; scripts/check_documents.py --update " KARCHER_BINARY_DIR "/karcher renews them.";
    if (s.name != "loads") rows += s.keys.size();
  }
  // and no others
  std::size_t blocks_rows = 0;
  for (std::size_t at = reference.find("<!-- program:"); at != std::string::npos; at = reference.find("<!-- program:", at + 1)) {
    std::size_t line = reference.find('\n', at) + 1;
    for (; reference[line] == '|'; line = reference.find('\n', line) + 1) ++blocks_rows;
    blocks_rows -= 2;
  }
  EXPECT_EQ(blocks_rows, rows);
}

TEST(Schema, MarkdownIsMadeOfSectionsOnly) {
  const Workshop shop;
  const Outcome o = shop.karcher("doc --markdown solvr");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("Did you mean \"solver\"?"), std::string::npos) << o.err;
}

}  // namespace
}  // namespace karcher::app
