#pragma once
/// \file
/// The strains of bodies with rotations as independent field (rods, plates), in the axes of the rotated body: v_a = R^T d_a m and u_a = axl(R^T d_a R) for the
/// D directions of the reference.
///
/// A density with `template <class W, class S> void add_energy(W& w, const BodyStrains<D, S>& e) const` is a density of them: its derivatives come from jets W in the
/// 6 D strains and the closed derivatives of the strains (assembly/body_strain_derivatives.hpp), a fraction of the work of jets in the local coordinates of both
/// fields. The strains are then variables, S a Combination<T, 6 D> (math/combination.hpp): they, their sums and multiples enter W by
/// add_scaled, add_square and add_product only.

#include <array>

#include "karcher/manifold/quaternion.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

template <int D, class S>
struct BodyStrains {
  std::array<Vec3<S>, static_cast<std::size_t>(D)> v{}, u{};
};

/// \param m, q  jets of the deformation and of the rotation (unit quaternions)
template <class M, class Q>
auto body_strains(const M& m, const Q& q) {
  using S = std::decay_t<decltype(m.value[0])>;
  BodyStrains<M::directions, S> e;
  const Mat3<S> rotation = rotation_matrix(q.value);
  for (std::size_t a = 0; a < e.v.size(); ++a) {
    e.v[a] = transpose_times(rotation, m.d[a]);
    const Quaternion<S> half = quaternion_product(conjugate(q.value), q.d[a]);
    e.u[a] = 2.0 * Vec3<S>{{half[1], half[2], half[3]}};
  }
  return e;
}

}  // namespace karcher
