#pragma once
/// \file
/// Dead loads: W = - f . u with a force density f that does not follow the motion (per reference volume, area or length; on nodes: a force).

#include <span>

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/list.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher {

template <class M, class P>
struct DeadLoad {
  Vec<P, M::ambient> f;
  static DeadLoad of(std::span<const P> p) {
    DeadLoad load;
    for (int c = 0; c < M::ambient; ++c) load.f[c] = p[static_cast<std::size_t>(c)];
    return load;
  }

  template <class Jet>
  auto operator()(const Jet& u) const {
    auto work = u.value[0] * f[0];
    for (int c = 1; c < M::ambient; ++c) work += u.value[c] * f[c];
    return -work;
  }
};

template <class M>
struct DeadLoadOn {
  template <class P>
  using Density = DeadLoad<M, P>;
};

/// Where a force works: R^n, and spheres by their ambient space.
using LoadManifold = ManifoldList<Euclidean<1>, Euclidean<2>, Euclidean<3>, Sphere<1>, Sphere<2>, Sphere<3>>;

}  // namespace karcher
