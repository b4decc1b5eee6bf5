#include "karcher/io/output.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "karcher/interpolation/evaluate.hpp"
#include "karcher/io/summary.hpp"
#include "karcher/mesh/orientation.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {
namespace {

/// Vertices in ascending order: what tells entities of one dimension apart (check_identity in mesh.hpp).
using EntityKey = std::vector<int>;

EntityKey key_of(const Cell& cell) {
  EntityKey key(cell.nodes.begin(), cell.nodes.begin() + vertex_count(cell.kind));
  std::sort(key.begin(), key.end());
  return key;
}

std::map<EntityKey, int> index_of(const Region& region) {
  std::map<EntityKey, int> index;
  for (std::size_t c = 0; c < region.cells.size(); ++c) index.emplace(key_of(region.cells[c]), static_cast<int>(c));
  return index;
}

bool same_entities(const std::map<EntityKey, int>& index, int dim, const Region& region) {
  return region.dim == dim && region.cells.size() == index.size() &&
         std::all_of(region.cells.begin(), region.cells.end(), [&](const Cell& c) { return index.count(key_of(c)) > 0; });
}

/// Highest degree that every kind of cell has a rule for; the measure of a curved cell is an integral of a square root, exact for no degree.
constexpr int measure_degree = 8;

double measure_of(const ReferenceGeometry& reference, const Cell& cell) {
  const int dim = dimension(cell.kind);
  if (dim == 0) return 1;
  const Quadrature& rule = quadrature(cell.kind, measure_degree);
  const std::vector<GeometryJet> jets = reference.at(cell, rule.points);
  double measure = 0;
  for (std::size_t q = 0; q < jets.size(); ++q) measure += rule.weights[q] * cell_frame(jets[q], dim).measure;
  return measure;
}

/// A cell that has an output node, and the node's number there.
struct NodeOfCell {
  int cell = -1, local = 0;
};

const std::vector<std::string> xyz{"x", "y", "z"};

/// Of an array of points, or of vectors, in space; of quaternions.
std::vector<std::string> component_names(int components, bool body_axes = false) {
  if (body_axes && components == 4) return {"w", "x", "y", "z"};
  return components == 2 || components == 3 ? std::vector<std::string>(xyz.begin(), xyz.begin() + components) : std::vector<std::string>();
}

/// Whether the files have the columns d_1, d_2, d_3 of the rotation that a point is.
bool has_directors(const ManifoldOps& m) {
  return m.drawing.directors && m.arrays.size() == 3 && std::ranges::all_of(m.arrays, [](const Quantity& q) { return q.components == 3; });
}

bool has_array(const Field& field, const std::string& name) {
  return std::ranges::any_of(field.manifold->arrays, [&](const Quantity& q) { return q.name == name; });
}

}  // namespace

struct OutputSampler::Part {
  /// A field on the part: its nodes on every cell.
  struct Carried {
    int field = 0;
    std::vector<std::vector<int>> cell_nodes;
  };
  std::unique_ptr<Space> space;  ///< of the output nodes
  std::map<EntityKey, int> index;
  std::vector<Carried> fields;
  std::vector<NodeOfCell> place;
  std::vector<Vec3<double>> reference;
  std::vector<Vec3<double>> normals;  ///< of the stress-free surface, where a field turns them
  std::vector<double> measure;
  std::vector<OutputCell> cells;
};

std::string quantity_name(const std::string& quantity, const std::string& term) {
  const std::size_t dot = quantity.find('.');
  return dot == std::string::npos ? quantity + "." + term : quantity.substr(0, dot) + "." + term + quantity.substr(dot);
}

void set_terms(OutputModel& model, const Functional& functional) {
  std::vector<std::string> names;
  model.term_parts.clear();
  model.quantities.clear();
  model.headless.clear();
  model.loads.clear();
  for (const auto& term : functional.terms()) {
    names.push_back(term->name());
    model.term_parts.push_back(term->part_names());
    model.quantities.push_back(term->info().quantities);
    model.headless.insert(model.headless.end(), term->info().headless.begin(), term->info().headless.end());
  }
  model.terms = distinct_names(std::move(names));
  for (std::size_t t = 0; t < model.terms.size(); ++t)
    if (functional.terms()[t]->info().load) model.loads.push_back(model.terms[t]);
}

OutputSampler::OutputSampler(OutputModel model) : model_(std::move(model)) {
  // Distinct regions that carry fields, the main one first.
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < model_.fields.size(); ++f) order.push_back(f);
  const auto rank = [&](std::size_t f) { return static_cast<int>(f) == model_.deformation ? 4 : model_.fields[f].space->region().dim; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  for (const std::size_t f : order) {
    const Region& region = model_.fields[f].space->region();
    const auto known = [&](const std::unique_ptr<Part>& p) { return same_entities(p->index, p->space->region().dim, region); };
    if (std::any_of(parts_.begin(), parts_.end(), known)) continue;

    auto part = std::make_unique<Part>();
    part->index = index_of(region);
    int p = 1;
    for (const Cell& c : region.cells) p = std::max(p, c.order);
    if (model_.reference_position) p = std::max(p, model_.reference_order);
    for (std::size_t g = 0; g < model_.fields.size(); ++g) {
      Part::Carried carried{static_cast<int>(g), {}};
      for (const Cell& c : region.cells) {
        carried.cell_nodes.push_back(model_.fields[g].space->entity_nodes(c));
        if (carried.cell_nodes.back().empty()) break;
      }
      if (carried.cell_nodes.back().empty()) continue;
      p = std::max(p, model_.fields[g].space->order());
      part->fields.push_back(std::move(carried));
    }
    part->space = std::make_unique<Space>(model_.fields[f].space->mesh_ptr(), region, p, Space::Copies::apart);

    const Mesh& mesh = part->space->mesh();
    const bool turned = std::ranges::any_of(
        part->fields, [&](const Part::Carried& c) { return has_directors(*model_.fields[static_cast<std::size_t>(c.field)].manifold); });
    std::optional<Orientation> orientation;
    if (turned && region.dim == 2) orientation.emplace(mesh, region);
    const ReferenceGeometry reference(mesh, model_.reference_position, model_.reference_order);
    const auto nodes = static_cast<std::size_t>(part->space->node_count());
    part->place.resize(nodes);
    part->reference.resize(nodes);
    if (orientation) part->normals.resize(nodes);
    for (std::size_t c = 0; c < region.cells.size(); ++c) {
      const Cell& cell = region.cells[c];
      const std::vector<int>& on_cell = part->space->cell_nodes(static_cast<int>(c));
      const std::vector<GeometryJet> jets = reference.at(cell, lagrange_nodes(cell.kind, p));
      for (std::size_t k = 0; k < on_cell.size(); ++k) {
        const auto n = static_cast<std::size_t>(on_cell[k]);
        const Vec3<double> own = cross(jets[k].d[0], jets[k].d[1]);
        if (orientation && norm2(own) > 0) {
          const Vec3<double> normal = (orientation->sign(cell) / std::sqrt(norm2(own))) * own;
          // On a surface of one side the cells at a node need not agree.
          part->normals[n] += dot(normal, part->normals[n]) < 0 ? -normal : normal;
        }
        if (part->place[n].cell >= 0) continue;
        part->place[n] = {static_cast<int>(c), static_cast<int>(k)};
        part->reference[n] = jets[k].x;
      }
      part->measure.push_back(measure_of(reference, cell));
      part->cells.push_back({cell.kind, on_cell});
    }
    for (Vec3<double>& n : part->normals)
      if (norm2(n) > 0) n = (1 / std::sqrt(norm2(n))) * n;
    parts_.push_back(std::move(part));
  }
}

OutputSampler::OutputSampler(OutputSampler&&) noexcept = default;
OutputSampler::~OutputSampler() = default;

// Layout of the energies: part of the mesh after part, and for each of them column after column (a term, its own parts, the components of its quantities): the
// number of cells that have the column, then the number of every cell.
std::vector<double> OutputSampler::cell_energies(const Functional& functional, const Configuration& u) const {
  assert(functional.terms().size() == model_.terms.size());
  const auto parts_shown = [&](std::size_t term) { return term < model_.term_parts.size() ? model_.term_parts[term].size() : 0; };
  const auto quantities_shown = [&](std::size_t term) {
    std::size_t components = 0;
    if (term < model_.quantities.size())
      for (const QuantityInfo& q : model_.quantities[term]) components += static_cast<std::size_t>(q.components);
    return components;
  };
  std::size_t columns = 0;
  for (std::size_t t = 0; t < model_.terms.size(); ++t) columns += 1 + parts_shown(t) + quantities_shown(t);
  std::vector<std::size_t> begin;
  std::size_t size = 0;
  for (const auto& part : parts_) {
    begin.push_back(size);
    size += columns * (1 + part->cells.size());
  }
  std::vector<double> energies(size, 0.0);
  BatchResult result;
  std::size_t first_column = 0;
  for (std::size_t t = 0; t < model_.terms.size(); ++t) {
    const Term& term = *functional.terms()[t];
    for (int b = 0; b < term.batch_count(); ++b) {
      const Batch& batch = term.batch(b);
      term.evaluate(u, b, Want::energy, result);
      const auto parts_of_term = parts_shown(t) > 0 ? term.batch_part_energies(u, b) : std::vector<std::array<double, native_width>>();
      const auto quantities = quantities_shown(t) > 0 ? term.batch_quantities(u, b) : std::vector<std::array<double, native_width>>();
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.cells_used); ++lane) {
        const Cell& cell = term.cell(batch.cells[lane]);
        const EntityKey key = key_of(cell);
        for (std::size_t p = 0; p < parts_.size(); ++p) {
          if (parts_[p]->space->region().dim != dimension(cell.kind)) continue;
          const auto found = parts_[p]->index.find(key);
          if (found == parts_[p]->index.end()) continue;
          const auto add = [&](std::size_t column, double energy) {
            double* block = energies.data() + begin[p] + column * (1 + parts_[p]->cells.size());
            block[0] += 1;
            block[1 + found->second] += result.trouble[lane] == Trouble::none ? energy : std::numeric_limits<double>::quiet_NaN();
          };
          add(first_column, result.energy[lane]);
          for (std::size_t k = 0; k < std::min(parts_shown(t), parts_of_term.size()); ++k) add(first_column + 1 + k, parts_of_term[k][lane]);
          for (std::size_t k = 0; k < std::min(quantities_shown(t), quantities.size()); ++k)
            add(first_column + 1 + parts_shown(t) + k, quantities[k][lane]);
        }
      }
    }
    first_column += 1 + parts_shown(t) + quantities_shown(t);
  }
  return energies;
}

namespace {

/// Values of a field at all output nodes of a part.
std::vector<double> nodal_values(const Field& field, int field_index, const std::vector<std::vector<int>>& cell_nodes,
                                 const std::vector<NodeOfCell>& places, const Space& output, const Configuration& u) {
  const auto ambient = static_cast<std::size_t>(field.manifold->ambient);
  const int p = field.space->order();
  // Basis of the field at the output nodes of every kind of cell.
  std::map<CellKind, std::vector<std::vector<double>>> basis;
  std::vector<double> values;
  values.reserve(places.size() * ambient);
  std::vector<double> on_cell;
  for (const auto& [c, local] : places) {
    const CellKind kind = output.region().cells[static_cast<std::size_t>(c)].kind;
    auto& weights = basis[kind];
    if (weights.empty())
      for (const Vec3<double>& xi : lagrange_nodes(kind, output.order())) weights.push_back(lagrange(kind, p, xi).value);
    const std::vector<double>& l = weights[static_cast<std::size_t>(local)];
    const std::vector<int>& nodes = cell_nodes[static_cast<std::size_t>(c)];
    // At a node of the field its value stands in the file bit for bit.
    const auto own = std::find_if(l.begin(), l.end(), [](double w) { return w > 1 - 1e-12 && w < 1 + 1e-12; });
    if (own != l.end()) {
      const double* value = u.at(field_index, nodes[static_cast<std::size_t>(own - l.begin())], field.manifold->ambient);
      values.insert(values.end(), value, value + ambient);
      continue;
    }
    on_cell.clear();
    for (const int n : nodes) {
      const double* value = u.at(field_index, n, field.manifold->ambient);
      on_cell.insert(on_cell.end(), value, value + ambient);
    }
    FieldAtPoint at = evaluate_field(*field.manifold, field.rule, on_cell, l);
    if (!at.defined) at.value.assign(ambient, std::numeric_limits<double>::quiet_NaN());
    values.insert(values.end(), at.value.begin(), at.value.end());
  }
  return values;
}

}  // namespace

std::vector<OutputPart> OutputSampler::sample(const Configuration& u, std::span<const double> energies) const {
  struct Column {  // one array of cell data, of as many columns as it has components
    std::string name;
    int components = 1;
    bool density = true;  ///< to be divided by the measure of the cell
  };
  std::vector<Column> columns;
  for (std::size_t t = 0; t < model_.terms.size(); ++t) {
    columns.push_back({"energy_density." + model_.terms[t]});
    if (t < model_.term_parts.size())
      for (const std::string& p : model_.term_parts[t]) columns.push_back({"energy_density." + model_.terms[t] + "." + p});
    if (t < model_.quantities.size())
      for (const QuantityInfo& q : model_.quantities[t]) columns.push_back({quantity_name(q.name, model_.terms[t]), q.components, false});
  }
  std::vector<OutputPart> out;
  std::size_t block = 0;
  for (const auto& part : parts_) {
    OutputPart o;
    o.region = part->space->region().name;
    o.dim = part->space->region().dim;
    o.order = part->space->order();
    o.cells = part->cells;
    const std::size_t nodes = part->reference.size();
    for (std::size_t n = 0; n < nodes; ++n) o.points.push_back(part->space->position(static_cast<int>(n)));

    for (const Part::Carried& carried : part->fields) {
      const Field& field = model_.fields[static_cast<std::size_t>(carried.field)];
      const int ambient = field.manifold->ambient;
      std::vector<double> values = nodal_values(field, carried.field, carried.cell_nodes, part->place, *part->space, u);
      if (carried.field == model_.deformation && field.manifold->linear && ambient <= 3) {
        std::vector<double> reference, displacement;
        for (std::size_t n = 0; n < nodes; ++n) {
          Vec3<double> m = part->reference[n];  // coordinates that the field does not have stay where they are
          for (int i = 0; i < ambient; ++i) m[i] = values[n * static_cast<std::size_t>(ambient) + static_cast<std::size_t>(i)];
          o.points[n] = m;
          for (int i = 0; i < 3; ++i) {
            reference.push_back(part->reference[n][i]);
            displacement.push_back(m[i] - part->reference[n][i]);
          }
        }
        o.point_data.push_back({"displacement", 3, std::move(displacement), xyz});
        o.point_data.push_back({"reference", 3, std::move(reference), xyz});
      }
      for (const Quantity& q : field.manifold->arrays) {
        const auto size = static_cast<std::size_t>(q.components);
        std::vector<double> numbers(size * nodes);
        for (std::size_t n = 0; n < nodes; ++n) q.value(&values[n * static_cast<std::size_t>(ambient)], &numbers[n * size]);
        const auto fields = std::ranges::count_if(model_.fields, [&](const Field& f) { return has_array(f, q.name); });
        o.point_data.push_back(
            {(fields > 1 ? field.name + "." : std::string()) + q.name, q.components, std::move(numbers), component_names(q.components)});
      }
      if (!part->normals.empty() && has_directors(*field.manifold)) {
        const std::size_t first = o.point_data.size() - 3;
        std::vector<double> normal(3 * nodes, 0.0);
        for (std::size_t n = 0; n < nodes; ++n)
          for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
              normal[3 * n + i] += o.point_data[first + k].values[3 * n + i] * part->normals[n][static_cast<int>(k)];
        const auto fields = std::ranges::count_if(model_.fields, [](const Field& f) { return has_directors(*f.manifold); });
        o.point_data.push_back({(fields > 1 ? field.name + "." : std::string()) + "normal", 3, std::move(normal), xyz, false});
      }
      o.point_data.push_back({field.name, ambient, std::move(values), component_names(ambient, field.manifold->body_axes)});
    }

    if (!energies.empty())
      for (const Column& column : columns) {
        const auto components = static_cast<std::size_t>(column.components);
        const std::size_t stride = 1 + o.cells.size();
        if (energies[block] > 0) {
          std::vector<double> values;
          for (std::size_t c = 0; c < o.cells.size(); ++c)
            for (std::size_t k = 0; k < components; ++k)
              values.push_back(energies[block + k * stride + 1 + c] / (column.density ? part->measure[c] : 1.0));
          o.cell_data.push_back({column.name, column.components, std::move(values)});
        }
        block += components * stride;
      }
    out.push_back(std::move(o));
  }
  return out;
}

}  // namespace karcher
