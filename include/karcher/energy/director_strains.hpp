#pragma once
/// \file
/// The products of tangents and director from which the strains of a shell with one director d are made, in the two directions of the reference.
///
/// A density with `template <class W, class S> void add_energy(W& w, const DirectorStrains<S>& e) const` is a density of them: its derivatives come from jets W in the eight
/// products and the closed derivatives of these (assembly/director_strain_derivatives.hpp). S as in body_strains.hpp.

#include <array>

#include "karcher/math/tensor.hpp"

namespace karcher {

template <class S>
struct DirectorStrains {
  std::array<S, 3> metric{};   ///< m_1 . m_1, m_2 . m_2, m_1 . m_2
  std::array<S, 3> bending{};  ///< m_1 . d_1, m_2 . d_2, (m_1 . d_2 + m_2 . d_1)/2
  std::array<S, 2> shear{};    ///< m_1 . d, m_2 . d
};

/// \param m  tangents m_1, m_2  \param d  jet of the director
template <class S, class D>
DirectorStrains<S> director_strains(const std::array<Vec3<S>, 2>& m, const D& d) {
  return {{dot(m[0], m[0]), dot(m[1], m[1]), dot(m[0], m[1])},
          {dot(m[0], d.d[0]), dot(m[1], d.d[1]), 0.5 * (dot(m[0], d.d[1]) + dot(m[1], d.d[0]))},
          {dot(m[0], d.value), dot(m[1], d.value)}};
}

}  // namespace karcher
