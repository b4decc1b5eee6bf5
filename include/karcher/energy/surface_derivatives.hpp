#pragma once
/// \file
/// Derivatives in space of a vector field with values in R^3 on a domain of any dimension in R^3, from those in the directions t_a of its reference
/// (reference_point.hpp): div u = sum_a t_a . d_a u, curl u = sum_a t_a x d_a u.

#include <type_traits>

#include "karcher/energy/reference_point.hpp"
#include "karcher/math/scalar.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <class S, class Jet>
auto divergence(const S& s, const Jet& u) {
  if constexpr (Jet::directions == 3) {  // the directions are the axes
    return u.d[0][0] + u.d[1][1] + u.d[2][2];
  } else {
    std::decay_t<decltype(u.value[0])> sum(0.0);
    for (std::size_t a = 0; a < u.d.size(); ++a)
      for (int i = 0; i < 3; ++i) add_scaled(sum, u.d[a][i], s.tangent[a][i]);
    return sum;
  }
}

template <class S, class Jet>
auto curl(const S& s, const Jet& u) {
  using T = std::decay_t<decltype(u.value[0])>;
  if constexpr (Jet::directions == 3) {
    return Vec<T, 3>{{u.d[1][2] - u.d[2][1], u.d[2][0] - u.d[0][2], u.d[0][1] - u.d[1][0]}};
  } else {
    Vec<T, 3> r;
    for (int i = 0; i < 3; ++i) {
      r[i] = T(0.0);
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (std::size_t a = 0; a < u.d.size(); ++a) {
        add_scaled(r[i], u.d[a][k], s.tangent[a][j]);
        add_scaled(r[i], u.d[a][j], -s.tangent[a][k]);
      }
    }
    return r;
  }
}

}  // namespace karcher
