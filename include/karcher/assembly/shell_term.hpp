#pragma once
/// \file
/// The Cosserat shell as a term of the functional, on the fast kernel of shell_kernel.hpp.

#include <memory>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"

namespace karcher {

/// Fields: deformation (R3), rotation (SO3, either rule), each of its own order 1..3, on triangles and quadrilaterals in any mixture. The deformation may live on a
/// larger region, for instance the solid whose boundary the shell covers. Parameters and choices: src/catalogue/cosserat_shell.cpp. Expressions among the
/// parameters are evaluated at the quadrature points, at the place on the mesh (not on the stress-free configuration, where that is another one).
/// Parts: "membrane" (Wm(E)), "bending" (everything with E b + c K or the mixed strain), "curvature" (Wcurv).
/// \throws InputError for fields that do not fit, parameters out of range or not finite, a degenerate reference surface, or a thickness h with
/// h |kappa| >= 2 for a principal curvature kappa; also from set_load_parameter.
std::unique_ptr<Term> make_shell_term(TermInfo info, TermInput input);

/// Default quadrature degree from the higher of the two field orders: 2, 5, 7 on triangles (3, 7, 15 points or fewer), 3, 5, 7 on quadrilaterals
/// (2 x 2, 3 x 3, 4 x 4 points).
int default_shell_degree(CellKind kind, int highest_order);

}  // namespace karcher
