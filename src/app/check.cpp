#include <fmt/format.h>

#include <cmath>
#include <random>

#include "app/verbs.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/problem/reference_energy.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {
namespace {

/// Mean edge length of the cells: steps of positions are measured in it.
double cell_size(const Mesh& mesh) {
  double sum = 0;
  for (const Cell& c : mesh.cells) {
    const Vec3<double> a = mesh.nodes[static_cast<std::size_t>(c.nodes[0])], b = mesh.nodes[static_cast<std::size_t>(c.nodes[1])];
    sum += std::sqrt(norm2(b - a));
  }
  return sum / static_cast<double>(mesh.cells.size());
}

/// A random step: positions move by parts of a cell, other fields by parts of a radian.
std::vector<double> random_step(const DiscreteProblem& model, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> step(static_cast<std::size_t>(model.layout->local_dofs()), 0.0);
  const double length = cell_size(*model.discretisation.mesh);
  for (std::size_t f = 0; f < model.fields().size(); ++f) {
    const Field& field = model.fields()[f];
    for (int node = 0; node < field.space->node_count(); ++node) {
      const int first = model.layout->first_dof(static_cast<int>(f), node);
      for (int i = 0; i < field.manifold->dim && first >= 0; ++i)
        if (!model.layout->fixed(first + i))
          step[static_cast<std::size_t>(first + i)] = size * (field.manifold->lengths[static_cast<std::size_t>(i)] ? length : 1.0) * uniform(random);
    }
  }
  return step;
}

/// v^T H v of the stored upper triangle.
double quadratic_form(const Layout& layout, const BlockMatrix& h, const std::vector<double>& v) {
  const int n = h.block_size;
  double sum = 0;
  for (int row = 0; row < layout.local_blocks(); ++row)
    for (int k = h.row_begin[static_cast<std::size_t>(row)]; k < h.row_begin[static_cast<std::size_t>(row) + 1]; ++k) {
      const int column = h.column[static_cast<std::size_t>(k)];
      double block = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          block += v[static_cast<std::size_t>(row * n + i)] * h.values[static_cast<std::size_t>((k * n + j) * n + i)] *
                   v[static_cast<std::size_t>(column * n + j)];
      sum += (row == column ? 1 : 2) * block;
    }
  return sum;
}

/// Taylor remainders of the energy along a random direction, from a random point near the initial configuration. \returns true if their slopes are 2 and 3
bool derivatives(DiscreteProblem& model) {
  std::mt19937 random(20240611);
  const Layout& layout = *model.layout;
  const Functional& functional = *model.functional;
  Configuration u = model.discretisation.start, trial = u;
  layout.retract(model.discretisation.start, random_step(model, 0.02, random), u);
  const std::vector<double> direction = random_step(model, 0.05, random);
  std::vector<double> g(direction.size());
  BlockMatrix h = functional.make_matrix();
  const Evaluation at = functional.hessian(u, g, h);
  if (at.failure) {
    fmt::print("\nderivatives cannot be checked: {}\n", at.failure->sentence());
    return false;
  }
  double first = 0;
  for (std::size_t i = 0; i < g.size(); ++i) first += g[i] * direction[i];
  const double second = quadratic_form(layout, h, direction);

  fmt::print("\nderivatives against differences, from a random point near the initial configuration:\n");
  fmt::print("{:>12} {:>16} {:>8} {:>16} {:>8}\n", "step", "E - E0 - g.s", "slope", "... - s.Hs/2", "slope");
  double before2 = 0, before3 = 0, best2 = 0, best3 = 0;
  // Remainders near rounding say nothing.
  double size = std::abs(at.energy);
  for (const double term : at.terms) size = std::max(size, std::abs(term));
  const double rounding = 1e3 * 2.2e-16 * size;
  bool measured = false, exact = true;
  for (double step = 1; step > 1e-4; step /= 2) {
    std::vector<double> s = direction;
    for (double& x : s) x *= step;
    layout.retract(u, s, trial);
    const Evaluation e = functional.energy(trial);
    if (e.failure) continue;
    const double r2 = std::abs(e.energy - at.energy - step * first);
    const double r3 = std::abs(e.energy - at.energy - step * first - 0.5 * step * step * second);
    const double slope2 = before2 > 0 ? std::log2(before2 / r2) : std::nan(""), slope3 = before3 > 0 ? std::log2(before3 / r3) : std::nan("");
    if (r3 > rounding) exact = false;
    if (before3 > 0 && r3 > rounding) {
      measured = true;
      best2 = slope2;
      best3 = slope3;
    }
    fmt::print("{:>12.4e} {:>16.6e} {:>8.3f} {:>16.6e} {:>8.3f}\n", step, r2, slope2, r3, slope3);
    before2 = r2;
    before3 = r3;
    if (r3 <= rounding) break;
  }
  const bool good = exact || (measured && best3 > 2.7 && best2 > 1.8);
  fmt::print("{}\n", exact  ? "the energy is quadratic here, and gradient and Hessian are exact"
                     : good ? fmt::format("gradient and Hessian are right: the remainders fall with slopes {:.2f} and {:.2f}", best2, best3)
                            : fmt::format("gradient or Hessian is wrong: the remainders fall with slopes {:.2f} and {:.2f} instead of 2 and 3", best2,
                                          best3));
  return good;
}

}  // namespace

int check(const CheckOptions& options) {
  Problem problem;
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    problem = read_problem(options.file, options.read);
    mesh = build_mesh(problem);
  });
  if (options.derivatives && world_size() > 1) throw SharedInputError("check --derivatives runs on one rank.");
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
  if (const std::string sentence = reference_sentence(model); !sentence.empty()) fmt::print("{}\n", sentence);
  fmt::print("unknowns  {} free, blocks of {}\n", model.layout->free_dofs(), model.layout->block_size());
  for (const std::string& warning : model.warnings) fmt::print("warning: {}\n", warning);
  if (options.derivatives && !derivatives(model)) return 1;
  return 0;
}

}  // namespace karcher::app
