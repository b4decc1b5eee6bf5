#pragma once
/// \file
/// The quadrature of the Cosserat shell for other energies of surfaces, and the selective one of shells.

#include <algorithm>

#include "karcher/assembly/selective_integration.hpp"
#include "karcher/assembly/shell_term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/energy/energy_info.hpp"

namespace karcher::catalogue {

inline int highest_order(const TermInput& input) {
  int order = 1;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) order = std::max(order, input.field(slot).space->order());
  return order;
}

/// Chooses degrees where the problem names none.
inline void choose_shell_quadrature(TermInput& input) {
  const int order = highest_order(input);
  for (const CellKind kind : {CellKind::triangle, CellKind::quadrilateral})
    input.quadrature_degree.try_emplace(kind, default_shell_degree(kind, order));
}

inline Choice integration_choice() {
  return {"integration",
          {"full", "selective"},
          "selective: for shells that are thin for their cells, membrane and transverse shear partly at fewer points"};
}

/// The term that `make` makes, or a sum of such where the problem chooses selective integration.
template <class Make>
std::unique_ptr<Term> selectively(const TermInput& given, Make make) {
  const auto choice = given.choices.find("integration");
  if (choice == given.choices.end() || choice->second == "full") return make(given);
  std::vector<std::unique_ptr<Term>> terms;
  for (const SelectivePart part : selective_parts(given.region)) {
    TermInput input = given;
    input.part = part;
    if (part != SelectivePart::all_points)
      for (const CellKind kind : {CellKind::triangle, CellKind::quadrilateral})
        input.quadrature_degree[kind] = reduced_degree(part, kind, highest_order(given));
    terms.push_back(make(input));
  }
  return make_sum_of_parts(std::move(terms));
}

}  // namespace karcher::catalogue
