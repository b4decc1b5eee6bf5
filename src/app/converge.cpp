#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/launch.hpp"
#include "app/signals.hpp"
#include "app/verbs.hpp"
#include "karcher/interpolation/evaluate.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/probes_csv.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/mesh/refine.hpp"
#include "karcher/problem/discretisation_error.hpp"
#include "karcher/problem/probes.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/continuation.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Level {
  std::shared_ptr<const Mesh> mesh;
  std::vector<Field> fields;
  Configuration u;                                     ///< complete
  std::map<std::string, std::vector<Child>> children;  ///< where the cells come from on the level before
  long cells = 0, unknowns = 0;
  double energy = unknown;
  std::string status;
  std::map<std::string, Summary::Error> errors, orders;
  std::map<std::string, std::vector<double>> probes;
};

/// Where a point of a cell of `fine` lies on an earlier level.
struct Ancestor {
  int cell = 0;
  Vec3<double> xi;
};
Ancestor ancestor(const std::vector<Level>& levels, std::size_t fine, std::size_t coarse, const std::string& region, CellKind kind, int cell,
                  Vec3<double> xi) {
  for (std::size_t k = fine; k > coarse; --k) {
    const Child& child = levels[k].children.at(region)[static_cast<std::size_t>(cell)];
    xi = in_parent(child, kind, xi);
    cell = child.parent;
  }
  return {cell, xi};
}

/// The function of the level before as nodal values of the last level; nodes where it is not defined keep their values.
/// Nodes with boundary data keep theirs, too.
void prolong(const std::vector<Level>& levels, const Constraints& constraints, Configuration& u) {
  const Configuration initial = u;
  const std::size_t fine = levels.size() - 1;
  const Level& coarse = levels[fine - 1];
  for (std::size_t f = 0; f < coarse.fields.size(); ++f) {
    const Field& from = coarse.fields[f];
    const Space& to = *levels[fine].fields[f].space;
    const int n = from.manifold->ambient;
    for (std::size_t c = 0; c < to.region().cells.size(); ++c) {
      const Cell& cell = to.region().cells[c];
      const auto& points = lagrange_nodes(cell.kind, to.order());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Ancestor a = ancestor(levels, fine, fine - 1, to.region().name, cell.kind, static_cast<int>(c), points[i]);
        const Cell& parent = from.space->region().cells[static_cast<std::size_t>(a.cell)];
        std::vector<double> nodes;
        for (const int node : from.space->cell_nodes(a.cell))
          nodes.insert(nodes.end(), coarse.u.values[f].begin() + node * n, coarse.u.values[f].begin() + (node + 1) * n);
        const FieldAtPoint at = evaluate_field(*from.manifold, from.rule, nodes, lagrange(parent.kind, from.space->order(), a.xi).value);
        if (!at.defined) continue;
        std::copy(at.value.begin(), at.value.end(), u.values[f].begin() + to.cell_nodes(static_cast<int>(c))[i] * n);
      }
    }
    const std::vector<char>& fixed = constraints.fixed()[f];
    const int dim = from.manifold->dim;
    for (int node = 0; node < to.node_count(); ++node)
      for (int i = 0; i < dim; ++i) {
        if (!fixed[static_cast<std::size_t>(node * dim + i)]) continue;
        const auto first = static_cast<std::size_t>(node * n + (n == dim ? i : 0)), count = static_cast<std::size_t>(n == dim ? 1 : n);
        std::copy_n(initial.values[f].begin() + static_cast<std::ptrdiff_t>(first), count, u.values[f].begin() + static_cast<std::ptrdiff_t>(first));
      }
  }
}

/// Errors of every level against the finest, integrated over the finest mesh.
void errors_against_finest(std::vector<Level>& levels, const DiscreteProblem& finest_model) {
  const std::size_t fine = levels.size() - 1;
  for (std::size_t coarse = 0; coarse < fine; ++coarse) {
    for (std::size_t f = 0; f < levels[fine].fields.size(); ++f) {
      const Field& field = levels[fine].fields[f];
      const Space& space = *field.space;
      std::vector<double> sums{0, 0};
      for (std::size_t c = 0; c < space.region().cells.size(); ++c) {
        const Cell& cell = space.region().cells[c];
        if (finest_model.layout->ranks() > 1 && finest_model.layout->cell_rank(cell) != finest_model.layout->rank()) continue;
        const auto dim = static_cast<std::size_t>(dimension(cell.kind));
        const Quadrature& rule = quadrature(cell.kind, 2 * space.order() + 10);
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
          const Metric metric(geometry(*levels[fine].mesh, cell, rule.points[q]), static_cast<int>(dim));
          const FieldSample a = sample_field(field, levels[fine].u.values[f], static_cast<int>(c), rule.points[q]);
          const Ancestor at = ancestor(levels, fine, coarse, space.region().name, cell.kind, static_cast<int>(c), rule.points[q]);
          const FieldSample b = sample_field(levels[coarse].fields[f], levels[coarse].u.values[f], at.cell, at.xi);
          // The map to the ancestor is affine; its derivative from differences of unit steps is exact.
          std::array<std::array<double, 3>, 3> map{};
          for (std::size_t k = 0; k < dim; ++k) {
            Vec3<double> step = rule.points[q];
            step[static_cast<int>(k)] += 1;
            const Ancestor moved = ancestor(levels, fine, coarse, space.region().name, cell.kind, static_cast<int>(c), step);
            for (int j = 0; j < 3; ++j) map[k][static_cast<std::size_t>(j)] = moved.xi[j] - at.xi[j];
          }
          if (!a.defined || !b.defined) {
            sums = {unknown, unknown};
            continue;
          }
          double value = 0, slope = 0;
          for (std::size_t i = 0; i < a.value.size(); ++i) {
            value += (a.value[i] - b.value[i]) * (a.value[i] - b.value[i]);
            std::array<double, 3> e{};
            for (std::size_t k = 0; k < dim; ++k) {
              e[k] = a.d[k][i];
              for (std::size_t j = 0; j < dim; ++j) e[k] -= map[k][j] * b.d[j][i];
            }
            for (std::size_t k = 0; k < dim; ++k)
              for (std::size_t j = 0; j < dim; ++j) slope += metric.inverse[k][j] * e[k] * e[j];
          }
          sums[0] += rule.weights[q] * metric.measure * value;
          sums[1] += rule.weights[q] * metric.measure * slope;
        }
      }
      sum_over_ranks(sums);
      levels[coarse].errors[field.name] = {std::sqrt(sums[0]), std::sqrt(sums[1])};
    }
  }
}

void observed_orders(std::vector<Level>& levels) {
  for (std::size_t k = 1; k < levels.size(); ++k)
    for (const auto& [field, error] : levels[k].errors) {
      const auto before = levels[k - 1].errors.find(field);
      if (before == levels[k - 1].errors.end()) continue;
      levels[k].orders[field] = {std::log2(before->second.l2 / error.l2), std::log2(before->second.h1 / error.h1)};
    }
}

nlohmann::ordered_json number(double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr); }

std::string json_text(const std::vector<Level>& levels) {
  nlohmann::ordered_json all;
  all["levels"] = nlohmann::ordered_json::array();
  for (const Level& level : levels) {
    nlohmann::ordered_json l;
    l["cells"] = level.cells;
    l["unknowns"] = level.unknowns;
    l["energy"] = number(level.energy);
    l["status"] = level.status;
    for (const auto& [key, values] : {std::pair("errors", &level.errors), {"orders", &level.orders}}) {
      l[key] = nlohmann::ordered_json::object();
      for (const auto& [field, e] : *values) l[key][field] = {{"l2", number(e.l2)}, {"h1", number(e.h1)}};
    }
    l["probes"] = nlohmann::ordered_json::object();
    for (const auto& [probe, values] : level.probes)
      for (const double x : values) l["probes"][probe].push_back(number(x));
    all["levels"].push_back(l);
  }
  return all.dump(2) + "\n";
}

const Summary::Error* find(const std::map<std::string, Summary::Error>& all, const std::string& field) {
  const auto it = all.find(field);
  return it == all.end() ? nullptr : &it->second;
}

std::string csv_text(const std::vector<Level>& levels) {
  std::string text = "level,cells,unknowns,energy,status";
  for (const Field& f : levels.front().fields) text += fmt::format(",l2_{0},h1_{0},order_l2_{0},order_h1_{0}", f.name);
  for (const std::string& name : probe_columns(levels.front().probes)) text += "," + name;
  text += '\n';
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format(",{}", x) : std::string(","); };
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Level& l = levels[k];
    text += fmt::format("{},{},{}{},{}", k, l.cells, l.unknowns, cell(l.energy), l.status);
    for (const Field& f : l.fields)
      for (const auto* values : {&l.errors, &l.orders}) {
        const Summary::Error* e = find(*values, f.name);
        text += cell(e ? e->l2 : unknown) + cell(e ? e->h1 : unknown);
      }
    for (const auto& [probe, values] : l.probes)
      for (const double x : values) text += cell(x);
    text += '\n';
  }
  return text;
}

std::string table_text(const std::vector<Level>& levels, bool exact) {
  std::string text = fmt::format("errors against {}\n", exact ? "the exact solution" : "the finest level");
  text += fmt::format("{:>5} {:>9} {:>10} {:>20}", "level", "cells", "unknowns", "energy");
  std::vector<std::string> names;
  for (const Field& f : levels.front().fields)
    if (levels.front().errors.contains(f.name)) names.push_back(f.name);
  for (const std::string& n : names) text += fmt::format(" {:>12} {:>6} {:>12} {:>6}", "L2(" + n + ")", "order", "H1(" + n + ")", "order");
  text += "  status\n";
  const auto error = [](double x) { return std::isfinite(x) ? fmt::format("{:.4e}", x) : std::string("-"); };
  const auto order = [](double x) { return std::isfinite(x) ? fmt::format("{:.2f}", x) : std::string("-"); };
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Level& l = levels[k];
    text += fmt::format("{:>5} {:>9} {:>10} {:>20}", k, l.cells, l.unknowns, std::isfinite(l.energy) ? fmt::format("{:.12e}", l.energy) : "-");
    for (const std::string& n : names) {
      const Summary::Error *e = find(l.errors, n), *o = find(l.orders, n);
      text += fmt::format(" {:>12} {:>6} {:>12} {:>6}", error(e ? e->l2 : unknown), order(o ? o->l2 : unknown), error(e ? e->h1 : unknown),
                          order(o ? o->h1 : unknown));
    }
    text += "  " + l.status + "\n";
  }
  const std::vector<std::string> columns = probe_columns(levels.front().probes);
  if (columns.empty()) return text;
  text += "probes at the end\nlevel";
  for (const std::string& name : columns) text += fmt::format(" {:>18}", name);
  text += '\n';
  for (std::size_t k = 0; k < levels.size(); ++k) {
    text += fmt::format("{:>5}", k);
    for (const auto& [probe, values] : levels[k].probes)
      for (const double x : values) text += fmt::format(" {:>18.10g}", x);
    text += '\n';
  }
  return text;
}

/// Solves on the last level. \returns the status
Status solve(const Problem& problem, DiscreteProblem& model, Configuration& u, bool prolonged) {
  ContinuationOptions continuation = problem.continuation;
  if (prolonged && problem.solver.method != "gradient-flow") {
    // The coarse solution belongs to the last load already.
    continuation.steps = 1;
    continuation.adaptive = false;
  }
  return run_continuation(*model.functional, u, boundary_values(model), continuation, problem.solver, {}, {}, changing_supports(model)).status;
}

}  // namespace

int converge(const ConvergeOptions& options) {
  catch_interrupts();
  const bool talks = world_rank() == 0;
  Problem problem;
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    problem = read_problem(options.file, options.read);
    mesh = build_mesh(problem);
  });
  const bool solves = !problem.terms.empty(), exact = !problem.exact.empty();
  std::vector<Level> levels;
  DiscreteProblem model;
  Status status = Status::converged;
  for (int k = 0; k <= options.levels; ++k) {
    Level& level = levels.emplace_back();
    if (k > 0) {
      Refinement refinement = refine(*mesh);
      mesh = std::make_shared<const Mesh>(std::move(refinement.mesh));
      level.children = std::move(refinement.children);
    }
    model = build(problem, mesh);
    level.mesh = mesh;
    level.fields = model.fields();
    level.cells = static_cast<long>(mesh->cells.size());
    for (const Field& f : level.fields) level.unknowns += static_cast<long>(f.space->node_count()) * f.manifold->dim;
    if (talks && isatty(STDERR_FILENO)) fmt::print(stderr, "level {}: {} unknowns\n", k, level.unknowns);
    level.u = model.discretisation.start;
    // Where supports change, the solution depends on the way there.
    const bool same_supports = model.discretisation.constraints.phases().size() == 1;
    const bool prolonged = solves && k > 0 && options.start == "prolonged" && same_supports;
    if (!prolonged) require_energy(problem, model);
    if (prolonged) prolong(levels, model.discretisation.constraints, level.u);
    Status reached = Status::converged;
    if (solves) {
      reached = solve(problem, model, level.u, prolonged);
      complete(*model.layout, level.u);
      level.energy = sum_over_ranks(model.functional->energy(level.u).energy);
    }
    level.status = solves ? std::string(name(reached)) : "interpolated";
    if (reached != Status::converged) status = reached;
    level.probes = probe_values(problem, model, level.u);
    if (exact) level.errors = errors_against_exact(problem, model, level.u);
    if (reached == Status::interrupted) break;
  }
  if (!exact) errors_against_finest(levels, model);
  observed_orders(levels);

  together([&] {
    if (!talks) return;
    std::error_code code;
    std::filesystem::create_directories(problem.output.directory, code);
    if (code) throw Error("The directory " + problem.output.directory.string() + " cannot be made: " + code.message() + ".");
    write_atomically(problem.output.directory / "convergence.csv", csv_text(levels));
    write_atomically(problem.output.directory / "convergence.json", json_text(levels));
  });
  if (talks && options.json) fmt::print("{}", json_text(levels));
  if (talks && !options.json && !options.quiet) {
    fmt::print("{}\n{}", problem.title, table_text(levels, exact));
    fmt::print("written to {}: convergence.csv, convergence.json\n", problem.output.directory.string());
  }
  return status == Status::converged ? 0 : status == Status::interrupted ? 130 : 1;
}

}  // namespace karcher::app
