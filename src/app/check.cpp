#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/check_terms.hpp"
#include "app/verbs.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/problem/reference_energy.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {

namespace {

/// "m on left: value, free, value, t > 0.5"
std::string held(const Problem& problem, const DirichletSpec& d) {
  using Component = DirichletSpec::Component;
  const FieldSpec& field = problem.fields[static_cast<std::size_t>(d.field)];
  const auto word = [](Component c) {
    return c == Component::value ? "value" : c == Component::initial ? "initial" : c == Component::current ? "current" : "free";
  };
  std::string what;
  if (!field.manifold->linear && d.normal >= 0)
    what = (field.manifold->body_axes ? "turns only about " : "no component along ") + std::string(1, static_cast<char>('x' + d.normal));
  else if (std::ranges::all_of(d.components, [&](Component c) { return c == d.components.front(); }))
    what = word(d.components.front());
  else
    for (const Component c : d.components) what += std::string(what.empty() ? "" : ", ") + word(c);
  std::string when;
  if (std::isfinite(d.from)) when += fmt::format(", t > {:g}", d.from);
  if (std::isfinite(d.to)) when += fmt::format(", t <= {:g}", d.to);
  return fmt::format("{} on {}: {}{}", field.name, d.on, what, when);
}

}  // namespace

int check(const CheckOptions& options) {
  Problem problem;
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    problem = read_problem(options.file, options.read);
    mesh = build_mesh(problem);
  });
  if ((options.derivatives || options.objectivity) && world_size() > 1)
    throw SharedInputError(std::string("check --") + (options.derivatives ? "derivatives" : "objectivity") + " runs on one rank.");
  DiscreteProblem model = build(problem, mesh);
  rehearse(problem, model);
  if (world_rank() != 0) return 0;
  fmt::print("{}\n\nmesh      {} cells of dimension {}, {} nodes\n", problem.title, mesh->cells.size(), mesh->dim, mesh->nodes.size());
  fmt::print("regions\n");
  for (const auto& [name, region] : mesh->regions) fmt::print("  {:<20} {} entities of dimension {}\n", name, region.cells.size(), region.dim);
  fmt::print("fields\n");
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    const FieldSpec& f = problem.fields[i];
    const std::string rule = f.manifold->linear ? "" : f.rule == Rule::projection ? ", projection" : ", geodesic";
    long fixed = 0;
    for (const char c : model.discretisation.constraints.fixed()[i]) fixed += c != 0;
    const int nodes = model.fields()[i].space->node_count();
    fmt::print("  {:<20} {} of order {}{} on {}: {} nodes, {} unknowns, {} fixed\n", f.name, f.manifold->name, model.fields()[i].space->order(), rule,
               f.on, nodes, nodes * f.manifold->dim, fixed);
  }
  fmt::print("energies and loads\n");
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    std::string fields;
    for (const int f : problem.terms[i].fields) fields += (fields.empty() ? "" : ", ") + problem.fields[static_cast<std::size_t>(f)].name;
    fmt::print("  {:<20} of {} on {}\n", model.term_names[i], fields, problem.terms[i].on);
  }
  if (!problem.dirichlet.empty()) fmt::print("boundary data\n");
  for (const DirichletSpec& d : problem.dirichlet) fmt::print("  {:<20} {}\n", d.name, held(problem, d));
  if (const std::string sentence = reference_sentence(model); !sentence.empty()) fmt::print("{}\n", sentence);
  fmt::print("unknowns  {} free, blocks of {}\n", model.layout->free_dofs(), model.layout->block_size());
  for (const std::string& warning : model.warnings) fmt::print("warning: {}\n", warning);
  const bool right = !options.derivatives || check_derivatives(model);
  const bool objective = !options.objectivity || check_objectivity(problem, model);
  return right && objective ? 0 : 1;
}

}  // namespace karcher::app
