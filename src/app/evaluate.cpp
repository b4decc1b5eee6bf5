#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/verbs.hpp"
#include "karcher/problem/discretisation_error.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/norm.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {
namespace {

/// |g|_* over the free dofs, see solve/norm.hpp.
double gradient_norm(const DiscreteProblem& model, std::vector<double> gradient) {
  const Layout& layout = *model.layout;
  model.exchange->sum(gradient);
  const std::vector<double> mass = step_mass(layout);
  double sum = 0;
  for (int i = 0; i < layout.owned_dofs(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!layout.fixed(i) && mass[k] > 0) sum += gradient[k] * gradient[k] / mass[k];
  }
  return std::sqrt(sum_over_ranks(sum));
}

nlohmann::ordered_json number(double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr); }

}  // namespace

int evaluate(const EvaluateOptions& options) {
  Problem problem;
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    problem = read_problem(options.file, options.read);
    mesh = build_mesh(problem);
  });
  DiscreteProblem model = build(problem, mesh);
  const Configuration& u = model.discretisation.start;
  std::vector<double> gradient(static_cast<std::size_t>(model.layout->local_dofs()));
  require_energy(problem, model);
  const Evaluation evaluation = model.functional->gradient(u, gradient);

  const auto& terms = model.functional->terms();
  std::vector<double> sums = evaluation.terms;
  for (const auto& term : terms) {
    const std::vector<double> parts = term->part_energies(u);
    sums.insert(sums.end(), parts.begin(), parts.end());
  }
  sum_over_ranks(sums);
  double energy = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) energy += sums[i];
  const double norm = gradient_norm(model, gradient);
  const std::map<std::string, Summary::Error> errors = errors_against_exact(problem, model, u);
  if (model.layout->rank() != 0) return 0;

  for (const std::string& warning : model.warnings) fmt::print(stderr, "warning: {}\n", warning);
  if (options.json) {
    nlohmann::ordered_json json;
    json["energy"] = number(energy);
    json["energies"] = nlohmann::ordered_json::object();
    std::size_t k = terms.size();
    for (std::size_t i = 0; i < terms.size(); ++i) {
      json["energies"][model.term_names[i]] = number(sums[i]);
      for (const std::string& part : terms[i]->part_names()) json["parts"][model.term_names[i]][part] = number(sums[k++]);
    }
    json["gradient_norm"] = number(norm);
    json["errors"] = nlohmann::ordered_json::object();
    for (const auto& [field, error] : errors) json["errors"][field] = {{"l2", number(error.l2)}, {"h1", number(error.h1)}};
    fmt::print("{}\n", json.dump(2));
    return 0;
  }
  fmt::print("{} at the initial configuration, t = {:.6g}\n", problem.title, u.t);
  fmt::print("  {:<24} {:.16g}\n", "energy", energy);
  std::size_t k = terms.size();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    fmt::print("    {:<22} {:.16g}\n", model.term_names[i], sums[i]);
    for (const std::string& part : terms[i]->part_names()) fmt::print("      {:<20} {:.16g}\n", part, sums[k++]);
  }
  fmt::print("  {:<24} {:.6e}\n", "norm of the gradient", norm);
  for (const auto& [field, error] : errors) fmt::print("  {:<24} L2 {:.6e}   H1 {:.6e}\n", "error of " + field, error.l2, error.h1);
  return 0;
}

}  // namespace karcher::app
