#include "karcher/problem/discrete_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/assembly/nodal_normals.hpp"
#include "karcher/io/summary.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/mesh/reference_geometry.hpp"
#include "karcher/mesh/refine.hpp"
#include "karcher/mesh/seams.hpp"
#include "karcher/problem/enclosure.hpp"
#include "karcher/problem/free_axes.hpp"
#include "karcher/problem/mesh_points.hpp"
#include "karcher/problem/mirror_planes.hpp"
#include "karcher/problem/probes.hpp"
#include "karcher/problem/reference_energy.hpp"
#include "karcher/problem/start_values.hpp"
#include "karcher/problem/supports.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/spread.hpp"
#include "karcher/solve/together.hpp"
#include "problem/problem_size.hpp"

namespace karcher {
namespace {

int order_of(const FieldSpec& field, const Mesh& mesh) { return field.order > 0 ? field.order : mesh.order(); }

void add_region(Mesh& mesh, const RegionSpec& spec) {
  if (mesh.regions.contains(spec.name)) refuse(spec.place, "the mesh has a region \"" + spec.name + "\" already; take another name.");
  if (spec.dim > mesh.dim)
    refuse(spec.place, "regions." + spec.name + ".dim is " + std::to_string(spec.dim) + ", but the cells of the mesh have dimension " +
                           std::to_string(mesh.dim) + ".");
  mesh.regions[spec.name] = at_place(spec.place, [&] {
    return spec.near ? nearest_node(mesh, spec.name, spec.boundary, *spec.near) : select(mesh, spec.name, spec.dim, spec.boundary, spec.where);
  });
}

std::vector<Vec3<double>> reference_normals(const Problem& problem, const FieldSpec& spec, const Space& space,
                                            const std::vector<unsigned char>& mirrors) {
  if (space.region().dim != 2)
    refuse(spec.place,
           fmt::format("the field \"{}\" starts at the normals of a surface, but lives on \"{}\" of dimension {}; give it initial values.", spec.name,
                       space.region().name, space.region().dim));
  const ReferenceSpec stress_free = reference(problem, space.mesh());
  return at_place(spec.place, [&] { return nodal_normals(space, space.region(), {space.mesh(), stress_free.position, stress_free.order}, mirrors); });
}

std::vector<double> initial_values(const Problem& problem, const FieldSpec& spec, const Space& space, const std::vector<unsigned char>& mirrors) {
  const int n = spec.manifold->ambient;
  std::vector<double> values(static_cast<std::size_t>(space.node_count() * n));
  if (!spec.initial) {
    const std::vector<Vec3<double>> positions = spec.normal ? reference_normals(problem, spec, space, mirrors) : reference_positions(problem, space);
    for (int node = 0; node < space.node_count(); ++node)
      for (int i = 0; i < std::min(n, 3); ++i) values[static_cast<std::size_t>(node * n + i)] = positions[static_cast<std::size_t>(node)][i];
    return values;
  }
  const std::vector<MeshPoint> places = mesh_points(space, spec.initial.asks_for_normal);
  for (std::size_t node = 0; node < places.size(); ++node)
    spec.initial.value(places[node], problem.continuation.from, values.data() + node * static_cast<std::size_t>(n));
  return values;
}

/// Where copies of a node are one for a field, the initial values must agree there: those in `values` are of one of the copies.
void require_periodic(const Problem& problem, int f, const Space& space, const std::vector<double>& values) {
  if (!space.joins_copies()) return;
  const FieldSpec& spec = problem.fields[static_cast<std::size_t>(f)];
  if (problem.is_deformation(f) || (spec.manifold->linear && !spec.initial))
    refuse(spec.place,
           fmt::format("the field \"{}\" has positions as values, which differ at the two sides of a periodic mesh; leave the sides apart with "
                       "mesh.periodic = false, or join their nodes in the mesh.",
                       spec.name));
  if (spec.initial.asks_for_normal || spec.normal) return;
  const auto ambient = static_cast<std::size_t>(spec.manifold->ambient);
  std::vector<double> here(ambient);
  for (const Cell& cell : space.region().cells) {
    const std::vector<int> nodes = space.entity_nodes(cell);
    const std::vector<Vec3<double>> places = space.entity_positions(cell);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3<double>& first = space.position(nodes[i]);
      if (norm2(places[i] - first) <= 1e-20 * (1 + norm2(first))) continue;
      const double* value = values.data() + static_cast<std::size_t>(nodes[i]) * ambient;
      spec.initial.value({places[i], {}}, problem.continuation.from, here.data());
      double difference = 0;
      if (spec.manifold->linear)
        for (std::size_t k = 0; k < ambient; ++k) difference = std::max(difference, std::abs(here[k] - value[k]) / (1 + std::abs(value[k])));
      else
        difference = spec.manifold->dist(here.data(), value);
      if (difference <= 1e-9) continue;
      const Vec3<double>& x = places[i];
      refuse(spec.place,
             fmt::format("the initial values of \"{}\" differ at ({:.6g}, {:.6g}, {:.6g}) and ({:.6g}, {:.6g}, {:.6g}), which are one node of the "
                         "periodic mesh.",
                         spec.name, first[0], first[1], first[2], x[0], x[1], x[2]));
    }
  }
}

std::unique_ptr<Term> build_term(const Problem& problem, const TermSpec& spec, const ReferenceSpec& stress_free, const Discretisation& d,
                                 const std::shared_ptr<const Configuration>& initial, const Layout& layout, std::vector<std::string>& warnings) {
  const Region& whole = d.mesh->region(spec.on);
  TermInput input;
  input.mesh = d.mesh;
  input.region.name = whole.name;
  input.region.dim = whole.dim;
  for (const Cell& c : whole.cells)
    if (layout.ranks() == 1 || layout.cell_rank(c) == layout.rank()) input.region.cells.push_back(c);
  input.all_fields = d.fields;
  input.fields = spec.fields;
  input.parameters = spec.parameters;
  if (spec.info.enclosure) {
    const Enclosure e = enclosure(problem, spec, d);
    for (int i = 0; i < 3; ++i) {
      input.parameters[fmt::format("share[{}]", i)] = e.share[i];
      input.parameters[fmt::format("origin[{}]", i)] = e.origin[i];
    }
    if (!e.warning.empty()) warnings.push_back(spec.place.text() + ": " + e.warning);
  }
  input.choices = spec.choices;
  input.quadrature_degree = problem.quadrature;
  input.reference_position = stress_free.position;
  input.reference_order = stress_free.order;
  input.t = problem.continuation.from;
  input.initial = initial;
  for (const int f : spec.fields) input.mirrors.push_back(d.mirrors[static_cast<std::size_t>(f)]);
  if (spec.info.one_axis) input.free_axes = free_axes(spec, d);
  return at_place(spec.place, [&] { return spec.make(std::move(input)); });
}

void check_region_of_term(const TermSpec& spec, const Discretisation& d) {
  const Region& region = at_place(spec.on_place, [&]() -> const Region& { return d.mesh->region(spec.on); });
  const std::vector<int>& dims = spec.info.dimensions;
  if (std::find(dims.begin(), dims.end(), region.dim) == dims.end()) {
    std::string allowed;
    for (const int dim : dims) allowed += (allowed.empty() ? "" : " or ") + std::to_string(dim);
    refuse(spec.on_place, spec.path + ": " + spec.info.type + " is an integral over a region of dimension " + allowed + ", but \"" + spec.on +
                              "\" has dimension " + std::to_string(region.dim) + ".");
  }
  for (const int f : spec.fields) {
    const Field& field = d.fields[static_cast<std::size_t>(f)];
    if (field.space->region().name == "all" || field.space->region().name == spec.on) continue;
    for (const Cell& c : region.cells)
      if (field.space->entity_nodes(c).empty())
        refuse(spec.on_place, spec.path + ": the field \"" + field.name + "\" lives on \"" + field.space->region().name +
                                  "\", which does not contain all of the region \"" + spec.on + "\".");
  }
}

}  // namespace

void check_solvable(const Problem& problem) {
  if (problem.terms.empty())
    throw InputError((problem.file.empty() ? std::string() : problem.file.string() + ":1:1: ") +
                     "there are no energies, so there is nothing to minimise.");
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    const bool used = std::any_of(problem.terms.begin(), problem.terms.end(), [&](const TermSpec& t) {
      return std::find(t.fields.begin(), t.fields.end(), static_cast<int>(i)) != t.fields.end();
    });
    if (!used) refuse(problem.fields[i].place, "no energy uses the field \"" + problem.fields[i].name + "\".");
  }
}

bool Problem::is_deformation(int field) const {
  for (const TermSpec& t : terms)
    for (std::size_t k = 0; k < t.fields.size(); ++k)
      if (t.fields[k] == field && t.info.fields[k].moves) return true;
  return false;
}

int Problem::deformation() const {
  for (const TermSpec& t : terms)
    for (std::size_t k = 0; k < t.fields.size(); ++k)
      if (t.info.fields[k].moves) return t.fields[k];
  return -1;
}

ReferenceSpec reference(const Problem& problem, const Mesh& mesh) {
  int order = 0;  // lowest of a deformation
  for (const TermSpec& t : problem.terms)
    for (std::size_t k = 0; k < t.fields.size(); ++k) {
      if (!t.info.fields[k].moves) continue;
      const int own = order_of(problem.fields[static_cast<std::size_t>(t.fields[k])], mesh);
      order = order == 0 ? own : std::min(order, own);
    }
  ReferenceSpec result = problem.reference;
  if (!result.position && order > 0 && order < mesh.order()) {
    result.position = [](const Vec3<double>& x) { return x; };
    result.order = order;
  }
  if (result.order == 0) result.order = order > 0 ? order : 2;
  return result;
}

std::vector<Vec3<double>> reference_positions(const Problem& problem, const Space& space) {
  std::vector<Vec3<double>> positions(static_cast<std::size_t>(space.node_count()));
  const ReferenceSpec stress_free = reference(problem, space.mesh());
  if (!stress_free.position) {
    for (int node = 0; node < space.node_count(); ++node) positions[static_cast<std::size_t>(node)] = space.position(node);
    return positions;
  }
  const ReferenceGeometry geometry(space.mesh(), stress_free.position, stress_free.order);
  for (std::size_t c = 0; c < space.region().cells.size(); ++c) {
    const Cell& cell = space.region().cells[c];
    const std::vector<int>& nodes = space.cell_nodes(static_cast<int>(c));
    const std::vector<GeometryJet> jets = geometry.at(cell, lagrange_nodes(cell.kind, space.order()));
    for (std::size_t i = 0; i < nodes.size(); ++i) positions[static_cast<std::size_t>(nodes[i])] = jets[i].x;
  }
  return positions;
}

std::shared_ptr<const Mesh> build_mesh(const Problem& problem) {
  const MeshSpec& spec = problem.mesh;
  auto mesh = std::make_shared<Mesh>(at_place(spec.place, spec.make));
  at_place(spec.place, [&] { require_room(problem, *mesh); });
  for (int i = 0; i < spec.refine; ++i) *mesh = refine(*mesh).mesh;
  for (const RegionSpec& region : problem.regions) add_region(*mesh, region);
  return mesh;
}

Discretisation discretise(const Problem& problem, std::shared_ptr<const Mesh> mesh) {
  Discretisation d;
  d.mesh = std::move(mesh);
  d.initial.t = problem.continuation.from;
  for (const FieldSpec& spec : problem.fields) {
    const Region& region = at_place(spec.on_place, [&]() -> const Region& { return d.mesh->region(spec.on); });
    const auto space = at_place(spec.place, [&] { return std::make_shared<const Space>(d.mesh, region, order_of(spec, *d.mesh)); });
    d.fields.push_back({spec.name, spec.manifold, spec.rule, space});
    const int number = static_cast<int>(d.fields.size()) - 1;
    d.mirrors.push_back(spec.manifold->directions ? mirror_planes(problem, number, *space) : std::vector<unsigned char>());
    d.initial.values.push_back(initial_values(problem, spec, *space, d.mirrors.back()));
    require_periodic(problem, number, *space, d.initial.values.back());
  }
  for (const TermSpec& spec : problem.terms) check_region_of_term(spec, d);
  d.constraints = Constraints(problem, d.fields, d.initial);
  d.start = d.initial;
  for (std::size_t f = 0; f < problem.fields.size(); ++f)
    if (const FieldSpec& spec = problem.fields[f]; spec.start) d.start.values[f] = start_values(problem, spec, *spec.start, *d.fields[f].space);
  d.constraints.restore(d.start);
  return d;
}

DiscreteProblem build(const Problem& problem, std::shared_ptr<const Mesh> mesh) {
  DiscreteProblem m;
  together([&] {
    m.discretisation = discretise(problem, std::move(mesh));
    const int ranks = world_size();
    const CellRanks cell_ranks = partition_cells(*m.discretisation.mesh, ranks);
    m.layout = std::make_shared<Layout>(m.discretisation.fields, m.discretisation.constraints.fixed(), cell_ranks, world_rank(), ranks);
  });
  together([&] {
    m.warnings = m.discretisation.mesh->warnings;
    std::vector<std::unique_ptr<Term>> terms;
    std::vector<std::string> names;
    const ReferenceSpec stress_free = reference(problem, *m.discretisation.mesh);
    const auto initial = std::make_shared<const Configuration>(m.discretisation.initial);
    for (const TermSpec& spec : problem.terms) {
      terms.push_back(build_term(problem, spec, stress_free, m.discretisation, initial, *m.layout, m.warnings));
      names.push_back(terms.back()->name());
      for (const std::string& warning : terms.back()->warnings()) m.warnings.push_back(spec.place.text() + ": " + warning);
    }
    m.term_names = distinct_names(names);
    m.functional = std::make_unique<Functional>(m.layout, std::move(terms));
  });
  m.exchange = std::make_unique<Exchange>(*m.layout);
  measure_reference(problem, m);
  for (const std::string& sentence : seams(*m.discretisation.mesh)) m.warnings.push_back(sentence);
  for (const std::string& sentence : free_motions(problem, m)) m.warnings.push_back(sentence);
  if (const Spread spread = widest_spread(*m.layout, m.discretisation.start); spread.ratio > Spread::wide)
    m.warnings.push_back("initially " + spread.sentence + ".");
  return m;
}

void require_energy(const Problem& problem, const DiscreteProblem& model) {
  const Configuration& u = model.discretisation.start;
  together([&] {
    model.functional->set_load_parameter(u.t);
    // Formulas may have infinite slopes where they are finite.
    std::vector<double> g(static_cast<std::size_t>(model.layout->local_dofs()));
    const bool formulas = std::any_of(problem.terms.begin(), problem.terms.end(), [](const TermSpec& t) { return t.info.formula; });
    const Evaluation e = formulas ? model.functional->gradient(u, g) : model.functional->energy(u);
    if (e.failure)
      refuse(problem.terms[static_cast<std::size_t>(e.failure->index)].place,
             "the energy of the initial configuration is not defined: " + e.failure->sentence());
  });
}

void rehearse(const Problem& problem, const DiscreteProblem& model) {
  together([&] {
    probe_values(problem, model, model.discretisation.start);
    model.functional->set_load_parameter(problem.continuation.to);
  });
  require_energy(problem, model);
}

BoundaryValues boundary_values(const DiscreteProblem& model) {
  if (!model.discretisation.constraints.has_values()) return {};
  return [&constraints = model.discretisation.constraints](double t, Configuration& u) { constraints.apply(t, u); };
}

ChangingSupports changing_supports(const DiscreteProblem& model) {
  const Constraints& constraints = model.discretisation.constraints;
  const auto& phases = constraints.phases();
  ChangingSupports supports;
  if (phases.size() == 1) return supports;
  for (std::size_t k = 1; k < phases.size(); ++k) supports.changes.push_back(phases[k].begin);
  supports.hold = [&constraints, layout = model.layout, now = phases.size()](double t) mutable {
    const std::size_t phase = constraints.phase(t);
    if (phase == now) return false;
    now = phase;
    layout->fix(constraints.phases()[phase].fixed);
    return true;
  };
  return supports;
}

OutputModel output_model(const Problem& problem, const DiscreteProblem& model) {
  OutputModel o;
  o.fields = model.fields();
  o.deformation = problem.deformation();
  set_terms(o, *model.functional);
  const ReferenceSpec stress_free = reference(problem, *model.discretisation.mesh);
  o.reference_position = stress_free.position;
  o.reference_order = stress_free.order;
  return o;
}

}  // namespace karcher
