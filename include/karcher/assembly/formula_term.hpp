#pragma once
/// \file
/// FormulaTerm: the integral of a DensityFormula of fields with values in any manifolds.

#include <functional>
#include <memory>

#include "karcher/assembly/density_formula.hpp"
#include "karcher/assembly/field_kernel.hpp"

namespace karcher {

/// The kernel of a field in so many directions.
using FieldKernels = std::function<std::unique_ptr<FieldKernel>(const Field&, int directions)>;

/// \param formula  of the fields of the input, in the order of DensityVariables
std::unique_ptr<Term> formula_term(TermInfo info, const TermInput& input, DensityFormula formula, FieldKernels kernels);

}  // namespace karcher
