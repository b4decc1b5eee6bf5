#pragma once
/// \file
/// Harmonic maps: W = scale/2 |grad u|^2 with the metric of the manifold. `scale = 1` is the Dirichlet energy 1/2 int |grad u|^2
/// (Eells, Sampson 1964; Helein, Wood, "Harmonic maps", Handbook of Global Analysis 2008).

#include <span>

#include "karcher/math/tensor.hpp"

namespace karcher {

template <class P>
struct Harmonic {
  P scale;
  static Harmonic of(std::span<const P> p) { return {p[0]}; }

  template <class Jet>
  auto operator()(const Jet& u) const {
    auto sum = 0.5 * Jet::Manifold::inner(u.value, u.d[0], u.d[0]);
    for (std::size_t a = 1; a < u.d.size(); ++a) sum += 0.5 * Jet::Manifold::inner(u.value, u.d[a], u.d[a]);
    return sum * scale;
  }
};

}  // namespace karcher
