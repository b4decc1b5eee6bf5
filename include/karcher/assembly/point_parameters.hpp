#pragma once
/// \file
/// PointParameters: parameters of a term at the quadrature points of its batches.

#include <span>
#include <vector>

#include "karcher/assembly/cell_batches.hpp"
#include "karcher/energy/parameter.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

class PointParameters {
 public:
  using T = NativeScalar;

  PointParameters(const CellBatches& batches, std::vector<ParameterValue> parameters, double t)
      : parameters_(std::move(parameters)), values_(batches.point_count() * parameters_.size()) {
    compute(batches, t, true);
  }
  /// Anew where they depend on t.
  void set_load_parameter(const CellBatches& batches, double t) { compute(batches, t, false); }

  std::size_t count() const { return parameters_.size(); }
  std::span<const T> at(std::size_t point) const { return {values_.data() + point * count(), count()}; }
  std::span<T> at(std::size_t point) { return {values_.data() + point * count(), count()}; }

 private:
  void compute(const CellBatches& batches, double t, bool all) {
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      if (!all && !parameters_[p].depends_on_t) continue;
      for (int b = 0; b < batches.count(); ++b)
        for (int q = 0; q < batches.kind(b).quadrature->size(); ++q)
          for (int lane = 0; lane < native_width; ++lane) {
            Vec3<double> x;
            for (int c = 0; c < 3; ++c) x[c] = karcher::lane(batches.point(b, q).x[c], lane);
            set_lane(at(batches.point_index(b, q))[p], lane, parameters_[p](x, t));
          }
    }
  }

  std::vector<ParameterValue> parameters_;
  std::vector<T> values_;  // [point][parameter]
};

}  // namespace karcher
