#pragma once
/// \file
/// Value, gradient and Hessian of a density of director strains (energy/director_strains.hpp) in the local coordinates of deformation and director: jets in the
/// strains, composed with the derivatives of the strains in closed form.
///
/// Local coordinates (interpolation.hpp): m_a itself, and w, k_a of the director in the projection chart of the sphere with the frame E at d, where to second order
///   d(w) = d + E w - |w|^2/2 d,      d_a(w, k) = E k_a - (w . k_a)(d + E w) - |w|^2/2 E k_a.

#include <array>

#include "karcher/energy/director_strains.hpp"
#include "karcher/interpolation/interpolation.hpp"
#include "karcher/math/combination.hpp"
#include "karcher/math/jet.hpp"

namespace karcher {

/// A density of the director strains.
template <class Density, class T>
concept OfDirectorStrains = requires(const Density& w, Jet<T, 8>& sum, const DirectorStrains<Combination<T, 8>>& e) {
  w.add_energy(sum, e);
};

/// S: Dual<T, 15> or Jet<T, 15> in the local coordinates m, m_1, m_2, w, k_1, k_2.
/// \param m  m_1 and m_2  \param d  the jet of the director  \param frame  E  \param k  k_1 and k_2
template <class S, class T, class DirectorJet, class Density>
S of_director_strains(const Density& density, const std::array<Vec3<T>, 2>& m, const DirectorJet& d, const Mat<T, 3, 2>& frame,
                      const std::array<Vec<T, 2>, 2>& k) {
  constexpr bool with_hessian = requires(S s) { s.h; };
  constexpr int strains = 8, first = 3, w = 9;  // the value of m counts nothing; m_a from 3 + 3 a, k_a from 11 + 2 a
  constexpr int coordinates = 12;
  using E = std::conditional_t<with_hessian, Jet<T, strains>, Dual<T, strains>>;
  const DirectorStrains<T> at = director_strains(m, d);
  using Variable = Combination<T, strains>;
  DirectorStrains<Variable> e;
  for (std::size_t i = 0; i < 3; ++i) {
    e.metric[i] = Variable::variable(at.metric[i], static_cast<int>(i));
    e.bending[i] = Variable::variable(at.bending[i], 3 + static_cast<int>(i));
  }
  for (std::size_t a = 0; a < 2; ++a) e.shear[a] = Variable::variable(at.shear[a], 6 + static_cast<int>(a));
  E energy(0.0);
  density.add_energy(energy, e);
  std::array<T, strains> f;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = chart_detail::slope(energy, static_cast<int>(i));

  // Derivatives of the strains by the coordinates from m_1 on.
  Mat<T, strains, coordinates> g;
  const auto set = [&](int strain, int from, const auto& x, double factor) {
    for (int i = 0; i < x.size(); ++i) g(strain, from + i) += T(factor) * x[i];
  };
  std::array<Vec<T, 2>, 2> tangential;  // E^T m_a
  std::array<T, 2> normal;              // d . m_a
  for (std::size_t a = 0; a < 2; ++a) {
    tangential[a] = transpose_times(frame, m[a]);
    normal[a] = at.shear[a];
  }
  for (std::size_t a = 0; a < 2; ++a) {
    const int ma = 3 * static_cast<int>(a);
    set(static_cast<int>(a), ma, m[a], 2);
    set(2, ma, m[1 - a], 1);
    set(6 + static_cast<int>(a), ma, d.value, 1);
    set(6 + static_cast<int>(a), w - first, tangential[a], 1);
    for (std::size_t b = 0; b < 2; ++b) {  // m_a . d_b
      const int strain = a == b ? 3 + static_cast<int>(a) : 5;
      const double factor = a == b ? 1 : 0.5;
      set(strain, ma, d.d[b], factor);
      set(strain, w - first, -normal[a] * k[b], factor);
      set(strain, w - first + 2 + 2 * static_cast<int>(b), tangential[a], factor);
    }
  }

  S result;
  result.v = energy.v;
  for (int c = 0; c < coordinates; ++c) {
    T sum = f[0] * g(0, c);
    for (int s = 1; s < strains; ++s) sum += f[static_cast<std::size_t>(s)] * g(s, c);
    chart_detail::slope(result, first + c) = sum;
  }

  if constexpr (with_hessian) {
    Mat<T, strains, coordinates> cg;
    for (int s = 0; s < strains; ++s)
      for (int r = 0; r < strains; ++r) {
        const T& c = energy.hessian(s, r);
        for (int i = 0; i < coordinates; ++i) cg(s, i) += c * g(r, i);
      }
    for (int i = 0; i < coordinates; ++i)
      for (int j = i; j < coordinates; ++j) {
        T sum = g(0, i) * cg(0, j);
        for (int s = 1; s < strains; ++s) sum += g(s, i) * cg(s, j);
        result.h[S::index(first + i, first + j)] = sum;
      }
    const auto add = [&](int i, int j, const T& x) { result.h[S::index(i, j)] += x; };
    const Mat<T, 2, 2> couple{{f[3], T(0.5) * f[5], T(0.5) * f[5], f[4]}};  // of m_a . d_b
    for (int i = 0; i < 3; ++i) {
      add(3 + i, 3 + i, T(2.0) * f[0]);
      add(6 + i, 6 + i, T(2.0) * f[1]);
      add(3 + i, 6 + i, f[2]);
    }
    for (int a = 0; a < 2; ++a) {
      const auto shear = f[static_cast<std::size_t>(6 + a)];
      for (int j = 0; j < 2; ++j) {
        const T turned = couple(a, 0) * k[0][j] + couple(a, 1) * k[1][j];
        for (int i = 0; i < 3; ++i) {
          add(3 + 3 * a + i, w + j, shear * frame(i, j) - turned * d.value[i]);
          for (int b = 0; b < 2; ++b) add(3 + 3 * a + i, w + 2 + 2 * b + j, couple(a, b) * frame(i, j));
        }
      }
    }
    T pull = f[6] * normal[0] + f[7] * normal[1];  // what works along d
    for (int b = 0; b < 2; ++b) {
      const Vec<T, 2>& kb = k[static_cast<std::size_t>(b)];
      const Vec<T, 2> along = couple(0, b) * tangential[0] + couple(1, b) * tangential[1];
      const T inward = couple(0, b) * normal[0] + couple(1, b) * normal[1];
      pull += dot(along, kb);
      for (int i = 0; i < 2; ++i) {
        add(w + i, w + 2 + 2 * b + i, -inward);
        for (int j = i; j < 2; ++j) add(w + i, w + j, -(along[i] * kb[j] + along[j] * kb[i]));
      }
    }
    for (int i = 0; i < 2; ++i) add(w + i, w + i, -pull);
  }
  return result;
}

}  // namespace karcher
