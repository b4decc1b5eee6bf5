#include "karcher/problem/largest_strain.hpp"

#include <fmt/format.h>

#include <cmath>

#include "karcher/solve/collectives.hpp"

namespace karcher {
namespace {

/// Place of the term's strain among the components of its quantities; -1 if it tells none.
int strain_component(const TermInfo& info) {
  int component = 0;
  for (const QuantityInfo& q : info.quantities) {
    if (std::isfinite(q.small_up_to)) return component;
    component += q.components;
  }
  return -1;
}

}  // namespace

std::optional<LargestStrain> largest_strain(const DiscreteProblem& model, const Configuration& u) {
  LargestStrain largest;
  double term_of_largest = -1;
  for (std::size_t t = 0; t < model.functional->terms().size(); ++t) {
    const Term& term = *model.functional->terms()[t];
    const int component = strain_component(term.info());
    for (int b = 0; b < term.batch_count() && component >= 0; ++b) {
      const auto strains = term.batch_quantities(u, b)[static_cast<std::size_t>(component)];
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(term.batch(b).cells_used); ++lane)
        if (strains[lane] > largest.value) {
          largest.value = strains[lane];
          largest.place = middle(*model.discretisation.mesh, term.cell(term.batch(b).cells[lane]));
          term_of_largest = static_cast<double>(t);
        }
    }
  }
  const double value = max_over_ranks(largest.value);
  const bool mine = largest.value == value && term_of_largest >= 0;
  const double speaker = -max_over_ranks(mine ? -static_cast<double>(model.layout->rank()) : -model.layout->ranks());
  double numbers[4] = {largest.place[0], largest.place[1], largest.place[2], term_of_largest};
  if (speaker != model.layout->rank())
    for (double& x : numbers) x = 0;
  sum_over_ranks(numbers);
  if (speaker >= model.layout->ranks()) return {};
  return LargestStrain{model.term_names[static_cast<std::size_t>(numbers[3])], value, {{numbers[0], numbers[1], numbers[2]}}};
}

std::string strain_warning(const DiscreteProblem& model, const LargestStrain& strain) {
  for (std::size_t t = 0; t < model.term_names.size(); ++t) {
    if (model.term_names[t] != strain.energy) continue;
    for (const QuantityInfo& q : model.functional->terms()[t]->info().quantities)
      if (strain.value > q.small_up_to)
        return fmt::format(
            "{} is made for strains up to about {:.2g}, but around ({:.4g}, {:.4g}, {:.4g}) they are {:.3g}. Are loads, moduli and lengths in units "
            "that "
            "fit each other?",
            strain.energy, q.small_up_to, strain.place[0], strain.place[1], strain.place[2], strain.value);
  }
  return {};
}

}  // namespace karcher
