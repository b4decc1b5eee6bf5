#pragma once
/// \file
/// Which interpolation serves a manifold and a rule: the closed form where there is one, the implicit weighted mean otherwise.

#include "karcher/interpolation/linear.hpp"
#include "karcher/interpolation/sphere_projection.hpp"
#include "karcher/interpolation/unit_vector_mean.hpp"
#include "karcher/interpolation/weighted_mean.hpp"
#include "karcher/manifold/rule.hpp"
#include "karcher/manifold/traits.hpp"

namespace karcher {

namespace rules_detail {
template <class M, int D, class T>
struct Projection {
  using type = WeightedMean<M, ChordFunction, D, T>;
};
template <class M, int D, class T>
requires(M::unit_scale == 1) struct Projection<M, D, T> {
  using type = SphereProjection<M, D, T>;
};
template <class M, int D, class T>
requires(M::unit_scale == 2) struct Projection<M, D, T> {
  using type = UnitVectorMean<M, SquarePotential, D, T>;
};
template <class M, int D, class T>
requires(is_linear<M>) struct Projection<M, D, T> {
  using type = LinearInterpolation<M, D, T>;
};
template <class M, int D, class T>
struct Geodesic {
  using type = WeightedMean<M, LogFunction, D, T>;
};
template <class M, int D, class T>
requires requires { M::unit_scale; }
struct Geodesic<M, D, T> {
  using type = UnitVectorMean<M, ArcPotential, D, T>;
};
template <class M, int D, class T>
requires(is_linear<M>) struct Geodesic<M, D, T> {
  using type = LinearInterpolation<M, D, T>;
};
}  // namespace rules_detail

template <class M, int D, class T>
using ProjectionInterpolation = typename rules_detail::Projection<M, D, T>::type;
template <class M, int D, class T>
using GeodesicInterpolation = typename rules_detail::Geodesic<M, D, T>::type;

}  // namespace karcher
