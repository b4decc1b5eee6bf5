#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "app/problem_file.hpp"
#include "app/read_dirichlet.hpp"
#include "app/read_terms.hpp"
#include "app/schema.hpp"
#include "app/section.hpp"
#include "app/time_series.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/gmsh.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

using Path = std::filesystem::path;

/// Reads section after section into a Problem.
class Reader {
 public:
  Reader(const Path& file, const ReadOptions& options) : options_(options), root_(read_toml(file, options.overrides)) {
    problem_.file = std::filesystem::absolute(file).lexically_normal();
  }

  Problem read() {
    const Place whole{root_.place.file, 1, 1};
    Section top(&root_, "", whole, section_info("").keys);
    problem_.title = top.text("title", problem_.file.stem().string());
    if (problem_.title.empty()) refuse(top.place("title"), "title must not be empty.");
    note("title", Value::of(problem_.title));
    parameters();
    mesh(top);
    regions();
    fields(top);
    exact();
    terms(top);
    reference();
    initial_values();
    dirichlet();
    continuation();
    solver();
    quadrature();
    probes();
    output();
    problem_.resolved = to_toml(problem_.values);
    for (const Entry& e : problem_.values.entries)
      if (e.key != "title" && e.key != "output" && e.key != "probes" && e.key != "solver" && e.key != "continuation" && e.key != "mesh") {
        Value section;
        section.entries.push_back(e);
        problem_.identity.push_back(to_toml(section));
      }
    return std::move(problem_);
  }

 private:
  const Value* find(const std::string& key) const {
    const Entry* e = root_.find(key);
    return e ? &e->value : nullptr;
  }
  void note(const std::string& key, Value value) { problem_.values.append(key, {}, std::move(value)); }
  /// What is known after the terms only stands before them in the resolved file.
  void note_before_terms(const std::string& key, Value value) {
    auto& entries = problem_.values.entries;
    note(key, std::move(value));
    const auto first_term = std::find_if(entries.begin(), entries.end(), [](const Entry& e) { return e.key == "energies" || e.key == "loads"; });
    if (first_term != entries.end()) std::rotate(first_term, entries.end() - 1, entries.end());
  }
  void note(const Section& section) { note(section.path(), section.resolved()); }
  Section section(const std::string& name, const std::vector<KeyInfo>& more = {}) const {
    std::vector<KeyInfo> keys = section_info(name).keys;
    keys.insert(keys.end(), more.begin(), more.end());
    const Value* v = find(name);
    return Section(v, name, v ? v->place : Place{root_.place.file, 1, 1}, std::move(keys));
  }
  /// The entries of [name.X] tables.
  const std::vector<Entry>& named_tables(const std::string& name) const {
    static const std::vector<Entry> none;
    const Value* v = find(name);
    if (!v) return none;
    if (!v->is(Value::Kind::table)) refuse(v->place, name + " must be tables [" + name + ".NAME], not " + v->kind_name() + ".");
    for (const Entry& e : v->entries)
      if (!e.value.is(Value::Kind::table))
        refuse(e.place, name + "." + e.key + " must be a table [" + name + ".NAME] with the keys " + join_names(key_names(section_info(name).keys)) +
                            ", not " + e.value.kind_name() + ".");
    return v->entries;
  }
  const std::vector<Value>& array_of_tables(const std::string& name) const {
    static const std::vector<Value> none;
    const Value* v = find(name);
    if (!v) return none;
    if (!v->is(Value::Kind::array)) refuse(v->place, name + " must be an array of tables: write [[" + name + "]].");
    return v->items;
  }

  void parameters() {
    const Value* v = find("parameters");
    if (!v) return;
    if (!v->is(Value::Kind::table)) refuse(v->place, "parameters must be a table, not " + v->kind_name() + ".");
    Value all = *v;
    // Series need no other parameter, and tables come last in problem.resolved.toml.
    for (Entry& e : all.entries)
      if (e.value.is(Value::Kind::table)) {
        Section s(&e.value, "parameters." + e.key, e.value.place, section_info("parameters").keys);
        series_.push_back(read_time_series(s, problem_.file.parent_path(), problem_.scope));
        problem_.scope.define(e.key, series_.back().value, e.place);
        problem_.identity.push_back(series_.back().content);
        e.value = s.resolved();
      }
    for (const Entry& e : v->entries)
      if (!e.value.is(Value::Kind::table)) problem_.scope.define(e.key, expression_of(e.value, "parameters." + e.key, problem_.scope), e.place);
    note("parameters", all);
  }

  void mesh(const Section& top) {
    if (!top.has("mesh")) top.missing("mesh");
    MeshSpec& spec = problem_.mesh;
    const Value* v = find("mesh");
    const Entry* generate = v->is(Value::Kind::table) ? v->find("generate") : nullptr;
    const GeneratorInfo* info = nullptr;
    std::vector<KeyInfo> arguments;
    if (generate) {
      if (!generate->value.is(Value::Kind::text))
        refuse(generate->value.place, "mesh.generate must be a string, not " + generate->value.kind_name() + ".");
      info = &at_place(generate->value.place, [&]() -> const GeneratorInfo& { return generator(generate->value.text); });
      for (const GeneratorArgument& a : info->arguments) arguments.push_back(generator_key(a));
    }
    Section s = section("mesh", arguments);
    spec.place = s.place();
    if (s.has("file") == s.has("generate"))
      refuse(s.place(), s.has("file") ? "mesh has both \"file\" and \"generate\"; one of them is meant." : "mesh lacks \"file\" or \"generate\".");
    if (s.has("file")) {
      spec.place = s.place("file");
      const Path given = s.text("file");
      const Path file = (given.is_absolute() ? given : problem_.file.parent_path() / given).lexically_normal();
      const PeriodicSides sides = s.flag("periodic") ? PeriodicSides::joined : PeriodicSides::apart;
      spec.make = [file, sides] { return read_gmsh(file.string(), sides); };
      s.note("file", Value::of(file.string()));
    } else {
      if (s.has("periodic")) refuse(s.place("periodic"), "mesh.periodic is for mesh files; generators close their surfaces themselves.");
      GeneratorOptions generator{s.text("generate"), {}, {}};
      for (const GeneratorArgument& a : info->arguments) generator_argument(s, a, generator);
      spec.make = [generator] { return karcher::generate(generator); };
      mesh_order_ = static_cast<int>(generator.numbers.at("order").front());
    }
    spec.refine = s.integer("refine");
    note(s);
  }

  /// Of a mesh file, by reading it: that mesh is then the first that is made.
  int mesh_order() {
    if (mesh_order_ > 0) return mesh_order_;
    MeshSpec& spec = problem_.mesh;
    const auto read = std::make_shared<std::optional<Mesh>>(at_place(spec.place, spec.make));
    spec.make = [read, again = spec.make] { return *read ? *std::exchange(*read, std::nullopt) : again(); };
    return mesh_order_ = (*read)->order();
  }

  /// The generator's entry as a part of the table of keys.
  static KeyInfo generator_key(const GeneratorArgument& a) {
    if (a.is_choice()) return {.name = a.name, .kind = KeyKind::word, .standard = a.words.front(), .words = a.words};
    std::vector<Value> numbers;
    for (const double x : a.numbers) numbers.push_back(Value::of(x));
    return {.name = a.name, .kind = KeyKind::constant, .standard = numbers, .size = a.numbers.size()};
  }

  void generator_argument(Section& s, const GeneratorArgument& a, GeneratorOptions& generator) {
    if (a.is_choice()) {
      generator.words[a.name] = s.word(a.name);
      return;
    }
    const std::vector<double> values = s.constants(a.name, problem_.scope);
    for (const double x : values) {
      if (a.integer && (x != std::floor(x) || std::abs(x) > 1e8)) refuse(s.place(a.name), s.path(a.name) + " must be a whole number.");
      if (x < a.minimum || (x == a.minimum && !a.minimum_allowed))
        refuse(s.place(a.name),
               fmt::format("{} must be {} {}, not {}.", s.path(a.name), a.minimum_allowed ? "at least" : "greater than", a.minimum, x));
    }
    generator.numbers[a.name] = values;
    std::vector<Value> items;
    for (const double x : values) items.push_back(a.integer ? Value::of(static_cast<long long>(x)) : Value::of(x));
    s.note(a.name, items.size() == 1 ? items.front() : Value::of(items));
  }

  void regions() {
    Value all;
    for (const Entry& e : named_tables("regions")) {
      Section s(&e.value, "regions." + e.key, e.value.place, section_info("regions").keys);
      check_name(e.place, "region", e.key);
      if (e.key == "all") refuse(e.place, "the region \"all\" is the whole mesh and cannot be defined anew.");
      RegionSpec& spec = problem_.regions.emplace_back();
      spec.name = e.key;
      spec.place = e.place;
      if (s.has("where") && s.has("near")) refuse(s.place("near"), s.path() + " has both \"where\" and \"near\"; one of them is meant.");
      if (s.has("near")) {
        spec.dim = s.integer("dim", 0);
        if (spec.dim != 0) refuse(s.place("dim"), fmt::format("{} is {}, but \"near\" selects a node, of dimension 0.", s.path("dim"), spec.dim));
        const std::vector<double> near = s.constants("near", problem_.scope);
        spec.near = Vec3<double>{{near[0], near[1], near[2]}};
      } else {
        if (!s.has("where")) refuse(s.place(), s.path() + " lacks the key \"where\" (or \"near\").");
        spec.dim = s.integer("dim");
        const Expression where = s.expression("where", problem_.scope);
        spec.where = [where](const Vec3<double>& x) { return where(x, 0) != 0; };
        if (where.uses_t()) refuse(s.place("where"), s.path("where") + " must not depend on t.");
      }
      spec.boundary = s.flag("boundary");
      all.append(e.key, {}, s.resolved());
    }
    if (!all.entries.empty()) note("regions", all);
  }

  void reference() {
    if (!find("reference")) return;
    Section s = section("reference");
    const std::vector<Expression> position = s.expressions("position", problem_.scope);
    for (const Expression& e : position)
      if (e.uses_t()) refuse(s.place("position"), "reference.position must not depend on t.");
    problem_.reference.position = [position](const Vec3<double>& x) {
      return Vec3<double>{{position[0](x, 0), position[1](x, 0), position[2](x, 0)}};
    };
    const int deformation = problem_.deformation();
    problem_.reference.order = s.integer("order", deformation < 0 ? 2 : problem_.fields[static_cast<std::size_t>(deformation)].order);
    note_before_terms("reference", s.resolved());
  }

  void fields(const Section& top) {
    if (!top.has("fields")) top.missing("fields");
    for (const Entry& e : named_tables("fields")) {
      Section s(&e.value, "fields." + e.key, e.value.place, section_info("fields").keys);
      check_name(e.place, "field", e.key);
      FieldSpec& spec = problem_.fields.emplace_back();
      spec.name = e.key;
      spec.place = e.place;
      const std::string manifold = s.text("manifold");
      spec.manifold = &at_place(s.place("manifold"), [&]() -> const ManifoldOps& { return manifold_by_name(manifold); });
      spec.order = s.has("order") ? s.integer("order") : s.integer("order", mesh_order());
      const bool linear = spec.manifold->linear;
      const std::string rule = s.word("interpolation", spec.manifold->has_projection || linear ? "projection" : "geodesic");
      spec.rule = rule == "projection" ? Rule::projection : Rule::geodesic;
      if (spec.rule == Rule::projection && !linear && !spec.manifold->has_projection)
        refuse(s.place("interpolation"), "points of the ambient space have no closest point in " + manifold +
                                             ", so the projection rule is not defined there; use interpolation = \"geodesic\".");
      spec.on = s.text("on");
      spec.on_place = s.place("on");
      field_sections_.push_back(s);
    }
    if (problem_.fields.empty()) refuse(find("fields")->place, "fields has no field; write [fields.NAME].");
  }

  void exact() {
    for (const Entry& e : named_tables("exact")) {
      Section s(&e.value, "exact." + e.key, e.value.place, section_info("exact").keys);
      const int field = field_index(e.key, e.place);
      const Value* v = s.raw("value");
      if (!v) s.missing("value");
      problem_.exact_values[field] = PointValue(*v, s.path("value"), *problem_.fields[static_cast<std::size_t>(field)].manifold, problem_.scope);
      problem_.exact[field] = problem_.exact_values[field].function();
      exact_resolved_.append(e.key, {}, s.resolved());
    }
  }

  void terms(const Section& top) {
    read_terms("energies", array_of_tables("energies"), problem_);
    read_terms("loads", array_of_tables("loads"), problem_);
    if (problem_.terms.empty() && problem_.exact.empty() && !top.has("energies")) top.missing("energies");
  }

  /// Whether a field is a director that is normal to a shell unless something else is said.
  bool is_normal(int field) const {
    for (const TermSpec& t : problem_.terms)
      for (std::size_t k = 0; k < t.fields.size(); ++k)
        if (t.fields[k] == field && t.info.fields[k].normal) return true;
    return false;
  }

  /// After the energies, which tell whether a field is a deformation.
  void initial_values() {
    Value all;
    for (std::size_t i = 0; i < problem_.fields.size(); ++i) {
      FieldSpec& spec = problem_.fields[i];
      Section& s = field_sections_[i];
      const Value* v = s.raw("initial");
      std::optional<Section> earlier;
      if (v && v->is(Value::Kind::table)) {
        earlier = start_from_results(spec, s.path("initial"), *v);
        v = earlier->raw("values");
      }
      const bool linear = spec.manifold->linear;
      const bool deforms = linear && problem_.is_deformation(static_cast<int>(i));
      if (v && v->is(Value::Kind::text) && v->text == "reference") {
        if (!linear) refuse(v->place, s.path("initial") + ": the reference position is no point of " + spec.manifold->name + ".");
        // no function: the reference position
      } else if (v && v->is(Value::Kind::text) && v->text == "exact") {
        const auto known = problem_.exact.find(static_cast<int>(i));
        if (known == problem_.exact.end()) refuse(v->place, s.path("initial") + " is \"exact\", but there is no [exact." + spec.name + "].");
        spec.initial = known->second;
      } else if (v ? v->is(Value::Kind::text) && v->text == "normal" : is_normal(static_cast<int>(i))) {
        if (!spec.manifold->directions) refuse(v->place, s.path("initial") + ": the normal of a surface is no point of " + spec.manifold->name + ".");
        spec.normal = true;
        s.note("initial", Value::of("normal"));
      } else if (v) {
        spec.initial = PointValue(*v, s.path("initial"), *spec.manifold, problem_.scope).function();
      } else if (deforms) {
        s.note("initial", Value::of("reference"));
      } else {
        spec.initial = PointValue::constant(spec.manifold->standard_point, s.path("initial"), *spec.manifold).function();
        std::vector<Value> items;
        for (const double x : spec.manifold->standard_point) items.push_back(Value::of(x));
        s.note("initial", Value::of(items));
      }
      if (earlier) {
        earlier->note("values", v ? *v : s.resolved().find("initial")->value);
        s.note("initial", earlier->resolved());
      }
      all.append(spec.name, {}, s.resolved());
    }
    note_before_terms("fields", all);
  }

  Section start_from_results(FieldSpec& spec, const std::string& path, const Value& table) const {
    Section s(&table, path, table.place, section_info("fields.initial").keys);
    StartSpec start;
    start.place = s.place("results");
    start.field = s.text("field", spec.name);
    const Path given = s.text("results");
    start.results = (given.is_absolute() ? given : problem_.file.parent_path() / given).lexically_normal();
    s.note("results", Value::of(start.results.string()));
    if (s.has("step")) start.step = s.integer("step");
    spec.start = start;
    return s;
  }

  void dirichlet() {
    std::vector<Value> all;
    for (const Value& v : array_of_tables("dirichlet")) {
      Section s(&v, fmt::format("dirichlet.{}", all.size()), v.place, section_info("dirichlet").keys);
      read_dirichlet(s, problem_);
      all.push_back(s.resolved());
    }
    if (!all.empty()) note("dirichlet", Value::of(all));
  }

  void continuation() {
    Section s = section("continuation");
    ContinuationOptions& c = problem_.continuation;
    c.from = s.constant("from", problem_.scope);
    c.to = s.constant("to", problem_.scope);
    c.steps = s.integer("steps");
    c.adaptive = s.flag("adaptive");
    c.smallest = s.number("smallest");
    for (const std::string& sentence : c.validate()) refuse(s.place(), "continuation: " + sentence);
    for (const TimeSeries& series : series_) require_range(series, c.from, c.to);
    note(s);
  }

  void solver() {
    Section s = section("solver");
    SolverOptions& o = problem_.solver;
    // One option after the other, so that the one that is wrong is the one that is named.
    const auto check = [&](const std::string& key) {
      for (const std::string& sentence : o.validate()) refuse(s.place(key), s.path(key) + ": " + sentence);
    };
    const auto text = [&](const char* key, std::string& x) { x = s.text(key), check(key); };
    const auto number = [&](const char* key, double& x) { x = s.number(key), check(key); };
    text("method", o.method);
    text("subproblem", o.subproblem);
    text("norm", o.norm);
    number("gradient_tolerance", o.gradient_tolerance);
    number("absolute_gradient_tolerance", o.absolute_gradient_tolerance);
    number("step_tolerance", o.step_tolerance);
    o.max_iterations = s.integer("max_iterations"), check("max_iterations");
    number("initial_radius", o.initial_radius);
    o.max_corrections = s.integer("max_corrections"), check("max_corrections");
    o.escape = s.flag("escape");
    if (o.method == "gradient-flow" && !(problem_.continuation.to > problem_.continuation.from))
      refuse(s.place("method"), "a gradient flow needs a time interval: continuation.to must be greater than continuation.from.");
    note(s);
  }

  void quadrature() {
    if (!find("quadrature")) return;
    Section s = section("quadrature");
    for (const CellKind kind : {CellKind::line, CellKind::triangle, CellKind::quadrilateral, CellKind::tetrahedron, CellKind::hexahedron}) {
      const std::string own(name(kind));
      const std::string key = s.has(own) ? own : "degree";
      if (!s.has(key)) continue;
      const int degree = s.integer(key);
      at_place(s.place(key), [&] { karcher::quadrature(kind, degree); });
      problem_.quadrature[kind] = degree;
    }
    note(s);
  }

  void probes() {
    if (!exact_resolved_.entries.empty()) note("exact", exact_resolved_);
    std::vector<Value> all;
    std::map<std::string, Place> places;  // by name
    for (const Value& v : array_of_tables("probes")) {
      Section s(&v, fmt::format("probes.{}", all.size()), v.place, section_info("probes").keys);
      ProbeSpec spec;
      spec.place = s.place();
      spec.name = s.text("name");
      check_name(s.place("name"), "probe", spec.name);
      const auto [known, is_new] = places.emplace(spec.name, spec.place);
      if (!is_new) refuse(s.place("name"), "there is a probe \"" + spec.name + "\" already (" + known->second.text() + ").");
      spec.field = field_index(s.text("field"), s.place("field"));
      const std::vector<double> at = s.constants("at", problem_.scope);
      for (int i = 0; i < 3; ++i) spec.at[i] = at[static_cast<std::size_t>(i)];
      const ManifoldOps& m = *problem_.fields[static_cast<std::size_t>(spec.field)].manifold;
      std::vector<std::string> quantities{"value"};
      if (m.linear) quantities.push_back("displacement");
      for (const Quantity& q : m.quantities) quantities.push_back(q.name);
      spec.quantity = s.word("quantity", {}, quantities);
      if (s.has("at")) known->second = spec.place = s.place("at");
      problem_.probes.push_back(spec);
      all.push_back(s.resolved());
    }
    if (!all.empty()) note("probes", Value::of(all));
  }

  void output() {
    Section s = section("output");
    OutputSpec& o = problem_.output;
    const Path base = problem_.file.parent_path();
    Path standard = base / problem_.file.stem();
    if (standard == problem_.file) standard += ".results";
    const Path given = s.text("directory", standard.string());
    o.directory = given.is_absolute() ? given : base / given;
    if (!options_.output.empty()) o.directory = std::filesystem::absolute(options_.output);
    o.directory = o.directory.lexically_normal();
    s.note("directory", Value::of(o.directory.string()));
    const Place place = options_.output.empty() ? s.place("directory") : Place{"--output", 0, 0};
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(o.directory, error);
    if (status.type() == std::filesystem::file_type::none)
      refuse(place, "the directory of results, " + shortened(o.directory.string()) + ", cannot be: " + error.message() + ".");
    if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
      refuse(place, "the directory of results, " + o.directory.string() + ", is a file.");
    o.vtu = s.flag("vtu");
    o.report = s.flag("report");
    o.every = s.integer("every");
    note(s);
  }

  int field_index(const std::string& name, const Place& place) const { return app::field_index(problem_, name, place); }

  ReadOptions options_;
  Value root_;
  ProblemFile problem_;
  std::vector<TimeSeries> series_;
  std::vector<Section> field_sections_;
  Value exact_resolved_;
  int mesh_order_ = 0;  ///< 0: not known yet
};

}  // namespace

Problem read_problem(const Path& file, const ReadOptions& options) { return Reader(file, options).read(); }

}  // namespace karcher::app
