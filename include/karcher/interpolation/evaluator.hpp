#pragma once
/// \file
/// FieldEvaluator of a manifold type (see evaluate.hpp).

#include "karcher/interpolation/evaluate.hpp"
#include "karcher/interpolation/rules.hpp"

namespace karcher {

/// An empty dl asks for the value alone.
template <class Interpolation0, class Interpolation3>
FieldAtPoint evaluate_with(std::span<const double> values, std::span<const double> l, std::span<const std::array<double, 3>> dl) {
  using M = typename Interpolation0::Manifold;
  std::vector<Point<M>> nodes(l.size());
  for (std::size_t i = 0; i < l.size(); ++i)
    for (int c = 0; c < M::ambient; ++c) nodes[i][c] = values[i * M::ambient + static_cast<std::size_t>(c)];
  FieldAtPoint out;
  const auto take = [&](auto interpolation, const auto& weights) {
    out.defined = interpolation.begin_cell(nodes.data(), static_cast<int>(nodes.size()));
    out.defined = out.defined & interpolation.evaluate(nodes.data(), weights);
    const auto& jet = interpolation.jet();
    out.value.assign(jet.value.e.begin(), jet.value.e.end());
    for (std::size_t a = 0; a < jet.d.size(); ++a) out.d[a].assign(jet.d[a].e.begin(), jet.d[a].e.end());
  };
  if (dl.empty())
    take(Interpolation0{}, Weights<0, double>{static_cast<int>(l.size()), l.data(), nullptr});
  else
    take(Interpolation3{}, Weights<3, double>{static_cast<int>(l.size()), l.data(), dl.data()});
  return out;
}

template <class M>
FieldEvaluator field_evaluator() {
  FieldEvaluator e;
  e.geodesic = &evaluate_with<GeodesicInterpolation<M, 0, double>, GeodesicInterpolation<M, 3, double>>;
  if constexpr (HasProjection<M> || is_linear<M>)
    e.projection = &evaluate_with<ProjectionInterpolation<M, 0, double>, ProjectionInterpolation<M, 3, double>>;
  return e;
}

}  // namespace karcher
