#include "app/read_dirichlet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/read_terms.hpp"

namespace karcher::app {
namespace {

class Reader {
 public:
  explicit Reader(ProblemFile& problem) : problem_(problem) {}

  void read(Section& s) {
    const std::vector<std::string> ways{"value", "support", "symmetry", "diaphragm"};
    std::string way;
    for (const std::string& key : ways) {
      if (!s.has(key)) continue;
      if (!way.empty()) refuse(s.place(key), fmt::format("{} has both \"{}\" and \"{}\"; one of them is meant.", s.path(), way, key));
      way = key;
    }
    if (way.empty()) refuse(s.place(), s.path() + " lacks the key \"value\" (or one of support, symmetry, diaphragm).");
    DirichletSpec spec;
    spec.path = s.path();
    spec.place = s.place();
    if (way == "value" || s.has("field")) spec.field = field_index(problem_, s.text("field"), s.place("field"));
    spec.on = s.text("on");
    spec.on_place = s.place("on");
    if (s.has("from")) spec.from = s.constant("from", problem_.scope);
    if (s.has("to")) spec.to = s.constant("to", problem_.scope);
    if (s.has("name")) {
      spec.name = s.text("name");
      check_name(s.place("name"), "condition", spec.name);
      for (const DirichletSpec& other : problem_.dirichlet)
        if (other.name == spec.name)
          refuse(s.place("name"), fmt::format("{}: {} ({}) has the name \"{}\", too.", s.path("name"), other.path, other.place.text(), spec.name));
    } else {
      spec.name = spec.on + "." + (way == "value" ? s.text("field") : way == "support" ? s.text("support") : way);
    }
    if (way == "value")
      read_value(s, spec);
    else
      read_support(s, way, spec);
  }

 private:
  void read_value(Section& s, DirichletSpec spec) {
    const ManifoldOps& m = *problem_.fields[static_cast<std::size_t>(spec.field)].manifold;
    const Value* v = s.raw("value");
    const std::string key = s.path("value");
    using Component = DirichletSpec::Component;
    if (v->is(Value::Kind::text) && (v->text == "initial" || v->text == "current")) {
      spec.components.assign(static_cast<std::size_t>(m.dim), v->text == "initial" ? Component::initial : Component::current);
    } else if (v->is(Value::Kind::text) && v->text == "exact") {
      const auto known = problem_.exact_values.find(spec.field);
      if (known == problem_.exact_values.end()) refuse(v->place, key + " is \"exact\", but the field has no [exact] value.");
      spec.components.assign(static_cast<std::size_t>(m.dim), Component::value);
      spec.value = m.linear ? of_components(spec.components, known->second.entries()) : known->second.function();
    } else if (v->is(Value::Kind::text) && m.ambient > 1 && !(v->text == "identity" && m.has_identity)) {
      std::vector<std::string> words{"initial", "current", "exact"};
      if (m.has_identity) words.push_back("identity");
      refuse_name(v->place, key + " cannot be", v->text, words);
    } else if (v->is(Value::Kind::table)) {
      spec.components = axis_free(*v, key, m, s.has("from") ? Component::current : Component::initial);
    } else if (m.linear) {
      linear_components(spec, *v, key, m);
    } else {
      if (v->is(Value::Kind::array))
        for (const Value& item : v->items)
          if (component_word(item))
            refuse(item.place, key + ": components of a point of " + m.name + " cannot be \"" + item.text + "\"; fix the whole point" +
                                   (m.body_axes ? ", or leave an axis free: value = {axis-free = \"e3\"}." : "."));
      spec.components.assign(static_cast<std::size_t>(m.dim), Component::value);
      spec.value = PointValue(*v, key, m, problem_.scope).function();
    }
    problem_.dirichlet.push_back(std::move(spec));
  }

  /// A support in a word: what it holds of the deformation and of the rotations that share an energy with it (docs/supports.md).
  void read_support(Section& s, const std::string& way, const DirichletSpec& entry) {
    using Component = DirichletSpec::Component;
    const std::string word = s.word(way);
    const bool clamped = way == "support" && word == "clamped", symmetry = way == "symmetry";
    const int axis = way == "support" ? -1 : word.front() - 'x';
    if (symmetry && s.has("from"))
      refuse(s.place("from"), s.path() + ": a plane of symmetry cannot set in: a body that is bent has no mirror image there.");
    // What is there when the support sets in is held: the initial values where it holds from the start.
    const Component kept = s.has("from") ? Component::current : Component::initial;
    std::vector<int> fields{entry.field};
    if (!s.has("field")) fields = supported_fields();
    if (fields.empty())
      refuse(s.place(way), fmt::format("{}: no energy has a deformation that could be held; write \"field\" and \"value\".", s.path(way)));
    for (const int f : fields) {
      const ManifoldOps& m = *problem_.fields[static_cast<std::size_t>(f)].manifold;
      const std::string& name = problem_.fields[static_cast<std::size_t>(f)].name;
      DirichletSpec spec = entry;
      spec.field = f;
      spec.normal = axis;
      spec.components.assign(static_cast<std::size_t>(m.dim), kept);
      if (m.linear && axis >= m.dim) refuse(s.place(way), fmt::format("{}: the field \"{}\" has no component along {}.", s.path(way), name, word));
      if (m.linear && !clamped && axis >= 0)
        for (int i = 0; i < m.dim; ++i)
          if ((i == axis) != symmetry) spec.components[static_cast<std::size_t>(i)] = Component::free;
      if (!m.linear && !clamped && !symmetry) {
        if (s.has("field"))
          refuse(s.place("field"), fmt::format("{}: a {} support leaves the field \"{}\" free.", s.path(way), way == "support" ? word : way, name));
        continue;
      }
      if (!m.linear && symmetry && !m.body_axes && !m.directions)
        refuse(s.place(way),
               fmt::format("{}: what a plane of symmetry means for the field \"{}\" with values in {} is not known; write \"field\" and \"value\".",
                           s.path(way), name, m.name));
      // A rotation may live on a part of the body only.
      spec.may_be_absent = !m.linear && !s.has("field");
      problem_.dirichlet.push_back(std::move(spec));
    }
  }

  /// The deformations, and the fields that share an energy with one and are no positions.
  std::vector<int> supported_fields() const {
    std::vector<int> fields;
    for (int f = 0; f < static_cast<int>(problem_.fields.size()); ++f) {
      const bool linear = problem_.fields[static_cast<std::size_t>(f)].manifold->linear;
      const bool goes_along = std::any_of(problem_.terms.begin(), problem_.terms.end(), [&](const TermSpec& t) {
        const bool has = std::find(t.fields.begin(), t.fields.end(), f) != t.fields.end();
        return has && std::any_of(t.fields.begin(), t.fields.end(), [&](int g) { return problem_.is_deformation(g); });
      });
      if (linear ? problem_.is_deformation(f) : goes_along) fields.push_back(f);
    }
    return fields;
  }

  static std::optional<DirichletSpec::Component> component_word(const Value& v) {
    using Component = DirichletSpec::Component;
    if (!v.is(Value::Kind::text)) return {};
    return v.text == "free"      ? std::optional(Component::free)
           : v.text == "initial" ? std::optional(Component::initial)
           : v.text == "current" ? std::optional(Component::current)
                                 : std::nullopt;
  }

  void linear_components(DirichletSpec& spec, const Value& v, const std::string& key, const ManifoldOps& m) {
    using Component = DirichletSpec::Component;
    const bool array = v.is(Value::Kind::array);
    const std::size_t count = array ? v.items.size() : 1;
    if (count != static_cast<std::size_t>(m.dim) || (!array && m.dim > 1))
      refuse(v.place, fmt::format("{} has {} entries, but a point of {} has {}; \"free\" leaves one free.", key, count, m.name, m.dim));
    std::vector<Expression> entries;
    for (std::size_t i = 0; i < count; ++i) {
      const Value& item = array ? v.items[i] : v;
      const std::optional<Component> word = component_word(item);
      spec.components.push_back(word.value_or(Component::value));
      entries.push_back(word ? Expression(0.0) : expression_of(item, array ? fmt::format("{}.{}", key, i) : key, problem_.scope));
    }
    if (std::all_of(spec.components.begin(), spec.components.end(), [](Component c) { return c == Component::free; }))
      refuse(v.place, key + " leaves every component free.");
    if (std::any_of(spec.components.begin(), spec.components.end(), [](Component c) { return c == Component::value; }))
      spec.value = of_components(spec.components, entries);
  }

  /// Writes the coordinates of R^n that have a value.
  static PointFunction of_components(const std::vector<DirichletSpec::Component>& components, const std::vector<Expression>& entries) {
    PointFunction f;
    f.depends_on_t = std::any_of(entries.begin(), entries.end(), [](const Expression& e) { return e.uses_t(); });
    f.value = [components, entries](const MeshPoint& s, double t, double* point) {
      for (std::size_t i = 0; i < entries.size(); ++i)
        if (components[i] == DirichletSpec::Component::value) point[i] = entries[i](s.x, t);
    };
    return f;
  }

  /// Tangent coordinates are the body rotation vector: with the axis e_k of the body free, a step turns about d_k, which stays where it is.
  std::vector<DirichletSpec::Component> axis_free(const Value& v, const std::string& key, const ManifoldOps& m, DirichletSpec::Component kept) const {
    Section s(&v, key, v.place, {{.name = "axis-free", .kind = KeyKind::word, .words = {"e1", "e2", "e3"}}});
    const std::string axis = s.word("axis-free");
    if (!m.body_axes) refuse(v.place, key + ": axis-free is for rotations (SO3), not for " + m.name + ".");
    std::vector components(3, kept);
    components[static_cast<std::size_t>(axis[1] - '1')] = DirichletSpec::Component::free;
    return components;
  }

  ProblemFile& problem_;
};

}  // namespace

void read_dirichlet(Section& section, ProblemFile& problem) { Reader(problem).read(section); }

}  // namespace karcher::app
