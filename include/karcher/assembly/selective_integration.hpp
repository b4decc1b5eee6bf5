#pragma once
/// \file
/// Selective reduced integration of thin shells (Arnold, Brezzi, "Locking-free finite element methods for shells", Math. Comp. 66, 1997): of the energy of membrane
/// and transverse shear, which locks, the share alpha = min(1, h^2/d^2) is integrated with all points, h the thickness and d the diameter of the cell, and 1 - alpha
/// with few; bending with all. What the few points do not see of the shear is then as stiff as bending is, so that no motion is free. Energy, gradient and Hessian
/// belong together, since each is a sum of terms with quadratures of their own.
///
/// Quadrilaterals of order p have p x p points. On triangles of order 2 the strains at three points are more conditions than there are unknowns, so that membrane strains
/// have three points and transverse shear has one.

#include <memory>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"

namespace karcher {

/// What a part counts of an energy: constant + slope alpha of its membrane and of its transverse shear energy, and a multiple of the rest.
struct SelectiveFactors {
  double membrane_constant = 1, membrane_slope = 0, shear_constant = 1, shear_slope = 0, rest = 1;
};
SelectiveFactors selective_factors(SelectivePart part);

/// The degree of the few points of a part, for fields up to this order: on quadrilaterals 2 p - 1; on triangles 2 p - 2 for the membrane, 2 p - 3 for the shear (1 at least).
int reduced_degree(SelectivePart part, CellKind kind, int highest_order);

/// The parts whose sum is the energy on this region, all_points first.
std::vector<SelectivePart> selective_parts(const Region& region);

/// d of every cell of the region in the stress-free configuration: the largest distance of two vertices.
std::vector<double> cell_diameters(const TermInput& input);

/// The sum of terms of the same cells. Quantities are those of the second one, at few points, where the strains are not those that lock.
std::unique_ptr<Term> make_sum_of_parts(std::vector<std::unique_ptr<Term>> parts);

}  // namespace karcher
