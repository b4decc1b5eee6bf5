#include "karcher/problem/reference_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "karcher/solve/collectives.hpp"

namespace karcher {
namespace {

constexpr double stretch = 0.01, smallest_part = 1e-12;

/// This rank's part of the energy of a term; not a number where it is not defined.
double energy_of(const Term& term, const Configuration& u) {
  BatchResult result;
  double sum = 0;
  for (int b = 0; b < term.batch_count(); ++b) {
    term.evaluate(u, b, Want::energy, result);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(term.batch(b).cells_used); ++lane)
      sum += result.trouble[lane] == Trouble::none ? result.energy[lane] : std::nan("");
  }
  return sum;
}

/// Whether the problem itself says that the reference is strained.
bool prestretched(const TermSpec& term) {
  return term.info.prestretch && std::ranges::any_of(std::array{"prestretch[0]", "prestretch[1]"}, [&](const char* key) {
           const auto found = term.parameters.find(key);
           return found != term.parameters.end() && !found->second.is(1);
         });
}

/// The fields of a term in the stress-free configuration, enlarged about its middle.
Configuration at_reference(const Problem& problem, const DiscreteProblem& model, std::size_t t, double enlarged) {
  const TermSpec& term = problem.terms[t];
  Configuration u = model.discretisation.initial;
  for (std::size_t k = 0; k < term.fields.size(); ++k) {
    const auto f = static_cast<std::size_t>(term.fields[k]);
    const Field& field = model.fields()[f];
    const int nodes = field.space->node_count(), n = field.manifold->ambient;
    if (!term.info.fields[k].moves) {
      if (std::vector<double> values = model.functional->terms()[t]->stress_free(term.fields[k]); !values.empty()) {
        u.values[f] = std::move(values);
        continue;
      }
      for (int node = 0; node < nodes; ++node) std::ranges::copy(field.manifold->standard_point, u.at(term.fields[k], node, n));
      continue;
    }
    const std::vector<Vec3<double>> places = reference_positions(problem, *field.space);
    Vec3<double> middle;
    for (const Vec3<double>& x : places) middle += (1.0 / nodes) * x;
    for (int node = 0; node < nodes; ++node) {
      const Vec3<double>& x = places[static_cast<std::size_t>(node)];
      for (int i = 0; i < std::min(n, 3); ++i) u.at(term.fields[k], node, n)[i] = x[i] + (enlarged - 1) * (x[i] - middle[i]);
    }
  }
  return u;
}

}  // namespace

void measure_reference(const Problem& problem, DiscreteProblem& model) {
  model.reference_energies.assign(problem.terms.size(), std::nullopt);
  for (std::size_t t = 0; t < problem.terms.size(); ++t) {
    const TermSpec& spec = problem.terms[t];
    if (!spec.info.stress_free || (spec.info.constant && spec.info.constant->holds(spec.choices))) continue;
    const Term& term = *model.functional->terms()[t];
    std::vector<double> sums;
    for (const double size : {1.0, 1.0 + stretch}) sums.push_back(energy_of(term, at_reference(problem, model, t, size)));
    sum_over_ranks(sums);
    model.reference_energies[t] = sums[0];
    if (!(sums[0] > smallest_part * sums[1]) || prestretched(spec)) continue;
    std::string cause;
    const ReferenceSpec stress_free = reference(problem, *model.discretisation.mesh);
    for (std::size_t k = 0; k < spec.fields.size(); ++k) {
      const Field& field = model.fields()[static_cast<std::size_t>(spec.fields[k])];
      if (spec.info.fields[k].moves && field.space->order() < stress_free.order)
        cause = fmt::format(": the field \"{}\" of order {} cannot take the reference of order {}; give both the same order", field.name,
                            field.space->order(), stress_free.order);
    }
    model.warnings.push_back(fmt::format("{}{}{} has the energy {:.3g} in the stress-free configuration, as if it were strained by {:.2g}{}.",
                                         spec.place.text(), spec.place.text().empty() ? "" : ": ", model.term_names[t], sums[0],
                                         stretch * std::sqrt(sums[0] / sums[1]), cause));
  }
}

std::string reference_sentence(const DiscreteProblem& model) {
  std::string list;
  for (std::size_t t = 0; t < model.reference_energies.size(); ++t)
    if (const auto& energy = model.reference_energies[t])
      list += fmt::format("{}{:.3g} ({})", list.empty() ? "" : ", ", *energy, model.term_names[t]);
  return list.empty() ? list : "energy at the reference: " + list;
}

}  // namespace karcher
