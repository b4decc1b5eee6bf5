#pragma once
/// \file
/// Energy, gradient and Hessian of a shell element by ADOL-C: the whole element energy is taped in its tangent coordinates.

#include <adolc/adolc.h>

#include <vector>

#include "assembly/shell_oracle.hpp"

namespace karcher::shell_oracle {

struct Derivatives {
  double energy = 0;
  std::vector<double> gradient;
  std::vector<std::vector<double>> hessian;  ///< lower triangle: [r][c], c <= r
};

/// hessian2 is ADOL-C's vector mode over all directions; it is faster than `hessian`.
inline Derivatives by_adolc(const Element& element, short tape = 1) {
  const auto n = static_cast<std::size_t>(element.unknowns());
  Derivatives d;
  d.gradient.resize(n);
  d.hessian.assign(n, std::vector<double>(n));
  std::vector<double> x(n, 0.0);
  {
    std::vector<adouble> y(n);
    trace_on(tape);
    for (std::size_t i = 0; i < n; ++i) y[i] <<= x[i];
    adouble w = energy(element, y.data());
    w >>= d.energy;
    trace_off();
  }
  std::vector<double*> rows;
  for (auto& row : d.hessian) rows.push_back(row.data());
  ::gradient(tape, static_cast<int>(n), x.data(), d.gradient.data());
  hessian2(tape, static_cast<int>(n), x.data(), rows.data());
  return d;
}

}  // namespace karcher::shell_oracle
