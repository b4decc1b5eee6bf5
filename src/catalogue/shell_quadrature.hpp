#pragma once
/// \file
/// The quadrature of the Cosserat shell for other energies of surfaces.

#include <algorithm>

#include "karcher/assembly/shell_term.hpp"
#include "karcher/assembly/term_input.hpp"

namespace karcher::catalogue {

/// Chooses degrees where the problem names none.
inline void choose_shell_quadrature(TermInput& input) {
  int order = 1;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) order = std::max(order, input.field(slot).space->order());
  for (const CellKind kind : {CellKind::triangle, CellKind::quadrilateral})
    input.quadrature_degree.try_emplace(kind, default_shell_degree(kind, order));
}

}  // namespace karcher::catalogue
