#pragma once
/// \file
/// Dead loads: W = - f . u with a force density f that does not follow the motion (per reference volume, area or length; on nodes: a force).

#include <span>

#include "karcher/energy/parameter.hpp"
#include "karcher/manifold/manifold.hpp"

namespace karcher {

template <class M, class P>
struct DeadLoad {
  Vec<P, M::ambient> f;

  template <class Jet>
  auto operator()(const Jet& u) const {
    auto work = u.value[0] * f[0];
    for (int c = 1; c < M::ambient; ++c) work += u.value[c] * f[c];
    return -work;
  }
};

/// Parameters: value[0], value[1], ... in ambient coordinates.
template <class M>
struct DeadLoadModel {
  template <class P>
  DeadLoad<M, P> at(std::span<const P> p) const {
    DeadLoad<M, P> load;
    for (int c = 0; c < M::ambient; ++c) load.f[c] = p[static_cast<std::size_t>(c)];
    return load;
  }
  std::vector<std::string> part_names() const { return {}; }
};

/// volume, traction, line and point loads; they differ in the dimension of the region.
std::vector<EnergyInfo> dead_load_infos();

}  // namespace karcher
