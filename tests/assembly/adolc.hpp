#pragma once
/// \file
/// Energy, gradient and Hessian of any function by ADOL-C, at the origin of its variables.

#include <adolc/adolc.h>

#include <vector>

namespace karcher::adolc {

struct Derivatives {
  double energy = 0;
  std::vector<double> gradient;
  std::vector<std::vector<double>> hessian;  ///< lower triangle: [r][c], c <= r
};

/// The function is taped anew, since its branches may depend on the point. hessian2 is ADOL-C's vector mode over all directions; it is faster than `hessian`.
/// \param f  adouble(const adouble* x), x: n variables
template <class F>
Derivatives differentiate(std::size_t n, const F& f, short tape = 1) {
  Derivatives d;
  d.gradient.resize(n);
  d.hessian.assign(n, std::vector<double>(n));
  std::vector<double> x(n, 0.0);
  {
    std::vector<adouble> y(n);
    trace_on(tape);
    for (std::size_t i = 0; i < n; ++i) y[i] <<= x[i];
    adouble w = f(y.data());
    w >>= d.energy;
    trace_off();
  }
  std::vector<double*> rows;
  for (auto& row : d.hessian) rows.push_back(row.data());
  ::gradient(tape, static_cast<int>(n), x.data(), d.gradient.data());
  hessian2(tape, static_cast<int>(n), x.data(), rows.data());
  return d;
}

}  // namespace karcher::adolc
