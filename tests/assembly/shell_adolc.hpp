#pragma once
/// \file
/// Energy, gradient and Hessian of a shell element by ADOL-C: the whole element energy is taped in its tangent coordinates.

#include "assembly/adolc.hpp"
#include "assembly/shell_oracle.hpp"

namespace karcher::shell_oracle {

using adolc::Derivatives;

inline Derivatives by_adolc(const Element& element) {
  return adolc::differentiate(static_cast<std::size_t>(element.unknowns()), [&](const adouble* x) { return energy(element, x); });
}

}  // namespace karcher::shell_oracle
