#pragma once
/// \file
/// W = weight/2 dist(u, target)^2 with the Riemannian distance: fidelity terms, and one step of a gradient flow (weight = 1/tau, target = the old map).

#include <span>

#include "karcher/manifold/manifold.hpp"

namespace karcher {

template <class M, class P>
struct L2Distance {
  P weight;
  Point<M, P> target;
  static L2Distance of(std::span<const P> p) {
    L2Distance w{p[0], {}};
    for (int c = 0; c < M::ambient; ++c) w.target[c] = p[static_cast<std::size_t>(1 + c)];
    return w;
  }

  template <class Jet>
  auto operator()(const Jet& u) const {
    using S = std::decay_t<decltype(u.value[0])>;
    const Vec<S, M::ambient> a = M::log(u.value, cast<S>(target));
    return 0.5 * M::inner(u.value, a, a) * weight;
  }
};

template <class M>
struct L2DistanceTo {
  template <class P>
  using Density = L2Distance<M, P>;
};

}  // namespace karcher
