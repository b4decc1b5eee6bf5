#pragma once
/// \file
/// The norm of steps: |s|^2 = sum_d M_d s_d^2 over all tangent coordinates, M the lumped mass (diagonal scaling of Hinton, Rock, Zienkiewicz 1976: the diagonal of
/// the consistent mass matrix, scaled so that a cell keeps its measure; positive for every order).
///
/// Fields are made comparable, and the norm free of units: each field's mass is divided by the measure of its region, and that of a coordinate that is a length
/// (ManifoldOps::lengths: those of R^n) by length^2, with length half the diagonal of the mesh's bounding box. So |s| is the root of the sum over fields of the
/// mean square of |s_R^n| / length, of rotation angles, and of distances in the other manifolds.
/// The dual norm of gradients is |g|_* = sqrt(sum_d g_d^2 / M_d).

#include <vector>

#include "karcher/field/layout.hpp"

namespace karcher {

/// integral of the basis functions of a space over its region, by diagonal scaling: positive, sums to the measure of the region. [node]
std::vector<double> lumped_mass(const Space& space);

/// M_d for every local dof of the layout, fixed ones included. \throws InputError, on all ranks, where M_d is not positive and finite.
std::vector<double> step_mass(const Layout& layout);

}  // namespace karcher
