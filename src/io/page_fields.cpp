#include "io/page_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <unordered_set>

namespace karcher {
namespace {

using json = nlohmann::ordered_json;
using Values = std::vector<float>;

constexpr float missing = std::numeric_limits<float>::quiet_NaN();
constexpr double degree = 180 / std::numbers::pi;

/// Finds what a part has, by name.
int index_of(const std::vector<StoredArray>& list, const std::string& name) {
  for (std::size_t k = 0; k < list.size(); ++k)
    if (list[k].name == name) return static_cast<int>(k);
  return -1;
}

class Fields {
 public:
  Fields(const Store& store, const std::vector<int>& states, const PageGeometry& shape, PageArrays& arrays)
      : store_(store), states_(states), shape_(shape), arrays_(arrays) {}

  json list = json::array(), glyphs = json::array();
  std::string first_field, first_glyphs;

  /// Numbers at every facet: value(state, facet) of the facet's own cell, or of the cell below it. array: the cell data that they are made of; empty: of several.
  void add_cell_field(const std::string& name, const std::string& label, const std::string& array,
                      const std::function<float(int part, const StoredValues&, std::size_t cell)>& value) {
    json numbers = json::array();
    long bad = 0;
    for (const int s : states_) {
      const StoredState& state = store_.states[static_cast<std::size_t>(s)];
      Values v;
      std::set<std::pair<int, int>> bad_cells;
      for (const PageFacet& f : shape_.facets) {
        float x = value(f.part, state.parts[static_cast<std::size_t>(f.part)], static_cast<std::size_t>(f.cell));
        if (std::isnan(x) && f.below_part >= 0)
          x = value(f.below_part, state.parts[static_cast<std::size_t>(f.below_part)], static_cast<std::size_t>(f.below_cell));
        if (!std::isfinite(x) && here(array, f)) bad_cells.insert({f.part, f.cell});
        v.push_back(x);
      }
      bad += static_cast<long>(bad_cells.size());
      numbers.push_back(arrays_.add_quantised(v));
    }
    list.push_back({{"name", name}, {"label", label}, {"kind", "scalar"}, {"at", "cell"}, {"arrays", std::move(numbers)}, {"not_finite", bad}});
  }

  /// Numbers at every vertex (three for a direction, else one) from the interpolated numbers of some arrays, one after the other.
  void add_vertex_field(const std::string& name, const std::string& label, const std::string& kind, const std::vector<std::string>& from,
                        const std::function<void(const double* in, double* out)>& value) {
    const std::size_t size = kind == "direction" ? 3 : 1;
    json numbers = json::array();
    long bad = 0;
    std::vector<double> in = room_for(from);
    for (const int s : states_) {
      const StoredState& state = store_.states[static_cast<std::size_t>(s)];
      Values v(shape_.vertices.size() * size, missing);
      for (std::size_t i = 0; i < shape_.vertices.size(); ++i) {
        double out[3];
        if (!interpolate(i, state, from, in.data())) continue;
        value(in.data(), out);
        bad += !std::all_of(out, out + size, [](double x) { return std::isfinite(x); });
        for (std::size_t c = 0; c < size; ++c) v[i * size + c] = static_cast<float>(out[c]);
      }
      numbers.push_back(arrays_.add_quantised(v, static_cast<int>(size)));
    }
    list.push_back({{"name", name}, {"label", label}, {"kind", kind}, {"at", "vertex"}, {"arrays", std::move(numbers)}, {"not_finite", bad}});
  }

  /// Angle in degrees, 0 to 90, between a direction and the normal of the deformed surface. director(in, n0, d): d from the interpolated arrays and the
  /// normal of the reference surface.
  void add_normal_angle(const std::string& label, const std::vector<std::string>& from,
                        const std::function<Vec3<double>(const double* in, const Vec3<double>& n0)>& director) {
    json numbers = json::array();
    long bad = 0;
    const std::vector<Vec3<double>> reference = normals(nullptr);
    std::vector<double> in = room_for(from);
    for (const int s : states_) {
      const StoredState& state = store_.states[static_cast<std::size_t>(s)];
      const std::vector<Vec3<double>> normal = normals(&state);
      Values v(shape_.vertices.size(), missing);
      for (std::size_t i = 0; i < v.size(); ++i) {
        if (store_.parts[part_of(i)].dim != 2 || !interpolate(i, state, from, in.data())) continue;
        const Vec3<double> d = director(in.data(), reference[i]), c = cross(d, normal[i]);
        const double angle = std::atan2(std::sqrt(dot(c, c)), std::abs(dot(d, normal[i]))) * degree;
        v[i] = static_cast<float>(angle);
        bad += !std::isfinite(angle);
      }
      numbers.push_back(arrays_.add_quantised(v));
    }
    list.push_back(
        {{"name", "normal_angle"}, {"label", label}, {"kind", "scalar"}, {"at", "vertex"}, {"arrays", std::move(numbers)}, {"not_finite", bad}});
  }

  /// Things at the nodes of the parts that have the array, thinned to one in every box of an even grid if there are too many.
  void add_glyphs(const std::string& name, const std::string& kind, const std::string& array, int size, int most,
                  const std::function<void(const float* in, double* out)>& value) {
    const auto has = [&](const StoredPart& q) { return index_of(q.point_data, array) >= 0; };
    const auto first = std::find_if(store_.parts.begin(), store_.parts.end(), has);  // later parts with it lie inside this one
    if (first == store_.parts.end()) return;
    const StoredPart& part = *first;
    const auto p = static_cast<std::size_t>(first - store_.parts.begin());
    const auto components = static_cast<std::size_t>(part.point_data[static_cast<std::size_t>(index_of(part.point_data, array))].components);
    std::vector<std::size_t> chosen(part.points);
    std::iota(chosen.begin(), chosen.end(), 0);
    for (double boxes = 4 * std::cbrt(most); chosen.size() > static_cast<std::size_t>(most); boxes *= 0.9) chosen = one_in_each_box(part, boxes);
    Values reference;
    for (const std::size_t i : chosen)
      reference.insert(reference.end(), part.reference.begin() + static_cast<std::ptrdiff_t>(3 * i),
                       part.reference.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    json numbers = json::array(), displacement = json::array();
    const auto k = static_cast<std::size_t>(index_of(part.point_data, array));
    for (const int s : states_) {
      const StoredValues& values = store_.states[static_cast<std::size_t>(s)].parts[p];
      Values v, u;
      for (const std::size_t i : chosen) {
        float in[most_read] = {};
        double out[6];
        std::copy_n(&values.point_data[k][i * components], std::min(components, most_read), in);
        value(in, out);
        for (int c = 0; c < size; ++c) v.push_back(static_cast<float>(out[c]));
        if (part.moves)
          u.insert(u.end(), values.displacement.begin() + static_cast<std::ptrdiff_t>(3 * i),
                   values.displacement.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
      }
      numbers.push_back(arrays_.add_quantised(v, size));
      if (part.moves) displacement.push_back(arrays_.add_quantised(u, 3));
    }
    glyphs.push_back({{"name", name},
                      {"kind", kind},
                      {"reference", arrays_.add_floats(reference, 3)},
                      {"displacement", std::move(displacement)},
                      {"arrays", std::move(numbers)}});
  }

 private:
  static constexpr std::size_t most_read = 9;  ///< of the numbers of a point: three directors, or a matrix

  std::size_t part_of(std::size_t vertex) const {
    return static_cast<std::size_t>(shape_.facets[static_cast<std::size_t>(shape_.vertices[vertex].facet)].part);
  }

  /// Room for the arrays at a vertex, and for all that is read of them where a file has fewer.
  std::vector<double> room_for(const std::vector<std::string>& from) const {
    std::size_t most = most_read;
    for (const StoredPart& part : store_.parts) {
      std::size_t sum = 0;
      for (const std::string& name : from)
        if (const int k = index_of(part.point_data, name); k >= 0)
          sum += static_cast<std::size_t>(part.point_data[static_cast<std::size_t>(k)].components);
        else
          sum += 3;  // displacement
      most = std::max(most, sum);
    }
    return std::vector<double>(most);
  }

  /// The arrays at a vertex, one after the other; false where its part does not have them.
  bool interpolate(std::size_t vertex, const StoredState& state, const std::vector<std::string>& from, double* out) const {
    const std::size_t p = part_of(vertex);
    const StoredPart& part = store_.parts[p];
    for (const std::string& name : from) {
      const bool moved = name == "displacement";
      const int k = moved ? -1 : index_of(part.point_data, name);
      if (moved ? !part.moves : k < 0) return false;
      const int components = moved ? 3 : part.point_data[static_cast<std::size_t>(k)].components;
      shape_.interpolate(vertex, moved ? state.parts[p].displacement : state.parts[p].point_data[static_cast<std::size_t>(k)], components, out);
      out += components;
    }
    return true;
  }

  /// Sums of the normals of the triangles around every vertex, weighted by area and aligned with the first one (the surface need not have two sides);
  /// of the reference surface for a null state.
  std::vector<Vec3<double>> normals(const StoredState* state) const {
    const std::size_t n = shape_.vertices.size();
    std::vector<Vec3<double>> x(n), out(n, Vec3<double>{});
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t p = part_of(i);
      shape_.interpolate(i, store_.parts[p].reference, 3, &x[i][0]);
      if (!state || !store_.parts[p].moves) continue;
      Vec3<double> u;
      shape_.interpolate(i, state->parts[p].displacement, 3, &u[0]);
      x[i] += u;
    }
    for (std::size_t t = 0; t < shape_.triangle_facets.size(); ++t) {
      const std::uint32_t* v = &shape_.triangles[3 * t];
      const Vec3<double> a = cross(x[v[1]] - x[v[0]], x[v[2]] - x[v[0]]);
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3<double>& sum = out[v[k]];
        sum = dot(sum, a) < 0 ? sum - a : sum + a;
      }
    }
    return out;
  }

  /// Whether the facet carries this cell array at all; elsewhere "no number" is no news.
  bool here(const std::string& array, const PageFacet& f) const {
    return array.empty() || index_of(store_.parts[static_cast<std::size_t>(f.part)].cell_data, array) >= 0;
  }

  static std::vector<std::size_t> one_in_each_box(const StoredPart& part, double boxes) {
    std::array<float, 3> low{HUGE_VALF, HUGE_VALF, HUGE_VALF}, high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
    for (std::size_t i = 0; i < part.reference.size(); ++i)
      low[i % 3] = std::min(low[i % 3], part.reference[i]), high[i % 3] = std::max(high[i % 3], part.reference[i]);
    const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    std::unordered_set<std::uint64_t> taken;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < part.points; ++i) {
      std::uint64_t key = 0;
      for (std::size_t c = 0; c < 3; ++c)
        key = (key << 21) | (static_cast<std::uint64_t>((part.reference[3 * i + c] - low[c]) / size * boxes) & 0x1fffff);
      if (taken.insert(key).second) out.push_back(i);
    }
    return out;
  }

  const Store& store_;
  const std::vector<int>& states_;
  const PageGeometry& shape_;
  PageArrays& arrays_;
};

/// The energy density of all terms that are no loads, then every term and its parts.
void add_energies(const Store& store, Fields& fields) {
  const std::string prefix = "energy_density.";
  std::vector<std::string> names;
  for (const StoredPart& part : store.parts)
    for (const StoredArray& a : part.cell_data)
      if (a.name.rfind(prefix, 0) == 0 && std::find(names.begin(), names.end(), a.name) == names.end()) names.push_back(a.name);
  const auto is_term = [&](const std::string& name) {
    return std::find(store.terms.begin(), store.terms.end(), name.substr(prefix.size())) != store.terms.end();
  };
  const auto counts = [&](const std::string& name) {
    return name.starts_with(prefix) && is_term(name) &&
           std::find(store.loads.begin(), store.loads.end(), name.substr(prefix.size())) == store.loads.end();
  };
  if (std::any_of(names.begin(), names.end(), counts)) {
    fields.add_cell_field("energy", "energy density", "", [&](int part, const StoredValues& v, std::size_t cell) {
      const StoredPart& p = store.parts[static_cast<std::size_t>(part)];
      float sum = 0;
      bool any = false;
      for (std::size_t k = 0; k < p.cell_data.size(); ++k)
        if (counts(p.cell_data[k].name)) sum += v.cell_data[k][cell], any = true;
      return any ? sum : missing;
    });
    fields.first_field = "energy";
  }
  const bool single = std::count_if(names.begin(), names.end(), counts) == 1;
  for (const std::string& name : names) {
    if (single && counts(name)) continue;
    const std::string rest = name.substr(prefix.size());
    const std::size_t dot = is_term(name) ? std::string::npos : rest.rfind('.');
    const std::string label =
        dot == std::string::npos ? "energy density, " + rest : rest.substr(dot + 1) + " energy density" + (single ? "" : ", " + rest.substr(0, dot));
    fields.add_cell_field(name, label, name, [&](int part, const StoredValues& v, std::size_t cell) {
      const int k = index_of(store.parts[static_cast<std::size_t>(part)].cell_data, name);
      return k < 0 ? missing : v.cell_data[static_cast<std::size_t>(k)][cell];
    });
  }
}

/// What the terms tell besides their energies.
void add_quantities(const Store& store, Fields& fields) {
  for (const auto& [name, legend] : store.quantities) {
    int components = 0;
    for (const StoredPart& part : store.parts)
      if (const int k = index_of(part.cell_data, name); k >= 0) components = part.cell_data[static_cast<std::size_t>(k)].components;
    for (int c = 0; c < components; ++c) {
      const std::string key = components == 1 ? name : fmt::format("{}.{}", name, c + 1);
      fields.add_cell_field(
          key, components == 1 ? legend : fmt::format("{}, component {}", legend, c + 1), name,
          [&, name = name](int part, const StoredValues& v, std::size_t cell) {
            const int k = index_of(store.parts[static_cast<std::size_t>(part)].cell_data, name);
            return k < 0 ? missing
                         : v.cell_data[static_cast<std::size_t>(k)][cell * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
          });
    }
  }
}

/// The vector of an arrow or a rod.
template <class T>
Vec3<double> vector_of(const Drawing& drawing, const T* in) {
  Vec3<double> v{};
  for (std::size_t c = 0; c < std::min<std::size_t>(3, drawing.coordinates.size()); ++c) v[static_cast<int>(c)] = in[drawing.coordinates[c]];
  return v;
}

/// Names of the arrays of a frame's axes.
std::vector<std::string> directors_of(const Store& store, const std::string& field) {
  const auto frames = std::count_if(store.drawings.begin(), store.drawings.end(), [](const auto& d) { return d.second.directors; });
  const std::string prefix = frames > 1 ? field + "." : "";
  return {prefix + "director1", prefix + "director2", prefix + "director3"};
}

/// A field that is to be shown.
struct Shown {
  const Store& store;
  const std::string& name;
  const Drawing& drawing;
  int components;  ///< stored ambient coordinates
  int most_glyphs;
  Fields& fields;

  bool moves() const { return !store.deformation.empty(); }
  /// What the page begins with, unless a deformation is more to look at.
  void begin_with(const std::string& field, const std::string& glyphs) const {
    if (moves()) return;
    fields.first_field = field;
    fields.first_glyphs = glyphs;
  }
};

void add_components(const Shown& s) {
  for (int c = 0; c < std::min(s.components, 9); ++c)
    s.fields.add_vertex_field(fmt::format("{}.{}", s.name, c + 1), fmt::format("{}, component {}", s.name, c + 1), "scalar", {s.name},
                              [c](const double* in, double* out) { out[0] = in[c]; });
}

void add_frames(const Shown& s) {
  const std::vector<int>& from = s.drawing.coordinates;
  s.fields.add_glyphs(s.drawing.directors ? "directors of " + s.name : "frame of " + s.name, "frame", s.name, 4, s.most_glyphs,
                      [&](const float* in, double* out) {
                        for (std::size_t c = 0; c < 4; ++c) out[c] = in[from[c]];
                      });
  s.begin_with("", s.fields.glyphs.empty() ? "" : s.fields.glyphs.back()["name"]);  // triads are read most easily on a plain ground
  if (s.drawing.components) add_components(s);
  if (s.drawing.directors)
    s.fields.add_vertex_field(s.name + ".angle", "rotation angle of " + s.name + " in degrees", "scalar", directors_of(s.store, s.name),
                              [](const double* r, double* out) {
                                // r: the columns of the matrix. 2 sin of the angle is the length of the axial vector of R - R^T, 2 cos is the trace less 1.
                                const double x = r[5] - r[7], y = r[6] - r[2], z = r[1] - r[3];
                                out[0] = std::atan2(std::sqrt(x * x + y * y + z * z), r[0] + r[4] + r[8] - 1) * degree;
                              });
}

void add_vectors(const Shown& s) {
  s.fields.add_vertex_field(s.name, s.name + " as colour", "direction", {s.name}, [&](const double* in, double* out) {
    const Vec3<double> v = vector_of(s.drawing, in);
    const double square = norm2(v), scale = square > 0 ? 1 / std::sqrt(square) : 0;
    for (int c = 0; c < 3; ++c) out[c] = scale * v[c];
  });
  const bool rod = s.drawing.glyph == Glyph::rod;
  s.fields.add_glyphs(s.name, rod ? "rod" : "arrow", s.name, 3, s.most_glyphs, [&](const float* in, double* out) {
    const Vec3<double> v = vector_of(s.drawing, in);
    std::copy_n(v.e.begin(), 3, out);
  });
  const bool on_curves = std::all_of(s.store.parts.begin(), s.store.parts.end(), [](const StoredPart& p) { return p.dim == 1; });
  s.begin_with(s.name, on_curves ? s.fields.first_glyphs : s.name);
  if (s.drawing.components) add_components(s);
}

void add_ellipsoids(const Shown& s) {
  const std::vector<int>& from = s.drawing.coordinates;
  const bool flat = from.size() == 3;
  s.fields.add_glyphs(s.name, "ellipsoid", s.name, 6, s.most_glyphs, [&](const float* in, double* out) {
    if (!flat) {
      for (std::size_t c = 0; c < 6; ++c) out[c] = in[from[c]];
    } else {  // as thick as a twentieth of its mean width
      const float xx = in[from[0]], yy = in[from[1]], xy = in[from[2]];
      const double matrix[] = {xx, yy, 0.0025 * 0.5 * (static_cast<double>(xx) + static_cast<double>(yy)), xy, 0, 0};
      std::copy_n(matrix, 6, out);
    }
  });
  s.fields.add_vertex_field(s.name + ".trace", "trace of " + s.name, "scalar", {s.name}, [&](const double* in, double* out) {
    out[0] = in[from[0]] + in[from[1]];
    if (!flat) out[0] += in[from[2]];
  });
  s.begin_with("", s.name);
  if (s.drawing.components) add_components(s);
}

void add_numbers(const Shown& s) {
  if (s.name == s.store.deformation) return;
  const bool single = s.drawing.place && s.components == 1;
  if (single)
    s.fields.add_vertex_field(s.name, s.name, "scalar", {s.name}, [](const double* in, double* out) { out[0] = in[0]; });
  else if (s.drawing.components)
    add_components(s);
  if (s.drawing.place ? !s.moves() && (single || s.fields.first_field.empty()) : s.fields.first_field.empty() && s.components > 0)
    s.fields.first_field = single ? s.name : s.name + ".1";
}

void add_field(const Store& store, const std::string& name, const Drawing& drawing, int most_glyphs, Fields& fields) {
  int components = 0;
  for (const StoredPart& p : store.parts)
    if (const int k = index_of(p.point_data, name); components == 0 && k >= 0) components = p.point_data[static_cast<std::size_t>(k)].components;
  const Shown shown{store, name, drawing, components, most_glyphs, fields};
  switch (drawing.glyph) {
    case Glyph::none:
      return add_numbers(shown);
    case Glyph::arrow:
    case Glyph::rod:
      return add_vectors(shown);
    case Glyph::frame:
      return add_frames(shown);
    case Glyph::ellipsoid:
      return add_ellipsoids(shown);
  }
}

}  // namespace

json shape_header(const Store& store, const std::vector<int>& states, const PageGeometry& shape, int most_glyphs, PageArrays& arrays) {
  json out = {{"vertices", shape.vertices.size()}, {"cells", shape.facets.size()}};
  Values reference(3 * shape.vertices.size());
  double lowest = HUGE_VAL, highest = -HUGE_VAL, size = 0;
  bool moves = false;
  for (const StoredPart& p : store.parts) moves = moves || p.moves;
  for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
    const auto p = static_cast<std::size_t>(shape.facets[static_cast<std::size_t>(shape.vertices[i].facet)].part);
    double x[3];
    shape.interpolate(i, store.parts[p].reference, 3, x);
    for (std::size_t c = 0; c < 3; ++c) reference[3 * i + c] = static_cast<float>(x[c]);
    lowest = std::min(lowest, x[2]);
    highest = std::max(highest, x[2]);
    size = std::max({size, std::abs(x[0]), std::abs(x[1])});
  }
  bool flat = highest - lowest <= 1e-6 * size;
  json list = json::array(), displacement = json::array();
  for (const int s : states) {
    const StoredState& state = store.states[static_cast<std::size_t>(s)];
    list.push_back({{"step", state.state}, {"t", state.t}});
    if (!moves) continue;
    Values u(3 * shape.vertices.size(), 0.0F);
    for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
      const auto p = static_cast<std::size_t>(shape.facets[static_cast<std::size_t>(shape.vertices[i].facet)].part);
      if (!store.parts[p].moves) continue;
      double x[3];
      shape.interpolate(i, state.parts[p].displacement, 3, x);
      for (std::size_t c = 0; c < 3; ++c) u[3 * i + c] = std::isfinite(x[c]) ? static_cast<float>(x[c]) : 0.0F;
      flat = flat && std::abs(x[2]) <= 1e-6 * size;
    }
    displacement.push_back(arrays.add_quantised(u, 3));
  }
  out["flat"] = flat;
  out["reference"] = arrays.add_floats(reference, 3);
  out["states"] = std::move(list);
  out["displacement"] = std::move(displacement);
  if (!shape.triangles.empty()) {
    out["triangles"] = arrays.add_integers(shape.triangles, 3);
    out["triangle_cells"] = arrays.add_integers(shape.triangle_facets);
  }
  if (!shape.curves.empty()) {
    out["curves"] = arrays.add_integers(shape.curves);
    out["curve_lengths"] = arrays.add_integers(shape.curve_lengths);
    out["curve_cells"] = arrays.add_integers(shape.curve_facets);
  }
  if (!shape.edges.empty()) {
    out["edges"] = arrays.add_integers(shape.edges);
    out["edge_lengths"] = arrays.add_integers(shape.edge_lengths);
  }
  out["strong_edges"] = shape.strong_edges;
  if (!shape.inner_triangles.empty()) {
    out["inner"] = arrays.add_integers(shape.inner_triangles, 3);
    out["inner_cells"] = arrays.add_integers(shape.inner_facets);
    out["solid_cells"] = arrays.add_integers(shape.solid_cells);
  }

  Fields fields(store, states, shape, arrays);
  add_energies(store, fields);
  add_quantities(store, fields);
  if (moves) {
    fields.add_vertex_field("displacement", "displacement", "scalar", {"displacement"},
                            [](const double* in, double* v) { v[0] = std::sqrt(in[0] * in[0] + in[1] * in[1] + in[2] * in[2]); });
    const auto on_surface = [&](const std::string& name) {
      return std::any_of(store.parts.begin(), store.parts.end(),
                         [&](const StoredPart& p) { return p.dim == 2 && index_of(p.point_data, name) >= 0; });
    };
    for (const auto& [name, drawing] : store.drawings) {
      if (!on_surface(name)) continue;
      if (drawing.directors)
        fields.add_normal_angle("angle of the director Q n₀ to the surface normal, in degrees", directors_of(store, name),
                                [](const double* r, const Vec3<double>& n) {
                                  Vec3<double> d{};
                                  for (int i = 0; i < 3; ++i) d[i] = r[i] * n[0] + r[3 + i] * n[1] + r[6 + i] * n[2];
                                  return d;
                                });
      if ((drawing.glyph == Glyph::arrow || drawing.glyph == Glyph::rod) && drawing.coordinates.size() == 3)
        fields.add_normal_angle(fmt::format("angle of {} to the surface normal, in degrees", name), {name},
                                [&](const double* in, const Vec3<double>&) { return vector_of(drawing, in); });
    }
  }
  for (const auto& [name, drawing] : store.drawings) add_field(store, name, drawing, most_glyphs, fields);
  if (fields.first_field.empty() && fields.first_glyphs.empty() && moves) fields.first_field = "displacement";
  out["fields"] = std::move(fields.list);
  out["glyphs"] = std::move(fields.glyphs);
  out["start"] = {{"field", fields.first_field}, {"glyphs", fields.first_glyphs}};
  return out;
}

}  // namespace karcher
