#pragma once
/// \file
/// FieldState: one field of a term on one batch of cells, moved from quadrature point to quadrature point: nodal values, weights, interpolation.

#include <array>
#include <cmath>
#include <vector>

#include "karcher/assembly/cell_batches.hpp"
#include "karcher/interpolation/interpolation.hpp"
#include "karcher/manifold/traits.hpp"

namespace karcher {

template <class I, int D>
struct FieldState {
  using T = NativeScalar;
  using M = typename I::Manifold;
  static constexpr int dim = M::dim, local = local_dim<M, D>;

  I interpolation;
  std::vector<Point<M, T>> nodes;
  std::vector<std::array<T, D>> dl;
  Weights<D, T> weights;
  std::vector<Mat<T, local, dim>> maps;

  /// \param field  number of the field in u  \param slot  its number in the term
  MaskOf<T> gather(const Configuration& u, int field, const Batch& batch, const KindData& kind, std::size_t slot) {
    const auto count = static_cast<std::size_t>(kind.shapes[slot].nodes);
    nodes.resize(count);
    dl.resize(count);
    maps.resize(count);
    for (std::size_t n = 0; n < count; ++n)
      for (int lane = 0; lane < native_width; ++lane) {
        const int node = batch.nodes[(static_cast<std::size_t>(kind.first_block[slot]) + n) * native_width + static_cast<std::size_t>(lane)];
        const double* x = u.at(field, node, M::ambient);
        for (int c = 0; c < M::ambient; ++c) set_lane(nodes[n][c], lane, x[c]);
      }
    return interpolation.begin_cell(nodes.data(), static_cast<int>(count));
  }

  MaskOf<T> move_to(const BatchPoint& point, const KindData& kind, std::size_t slot, int q) {
    const ShapeTable& shape = kind.shapes[slot];
    const auto first = static_cast<std::size_t>(q) * static_cast<std::size_t>(shape.nodes);
    const int cell_dim = dimension(kind.kind);
    if constexpr (D > 0) {
      for (std::size_t n = 0; n < static_cast<std::size_t>(shape.nodes); ++n)
        for (std::size_t a = 0; a < D; ++a) {
          T s = T(0.0);
          for (std::size_t c = 0; c < static_cast<std::size_t>(cell_dim); ++c) s += point.to_frame[a][c] * T(shape.gradient[first + n][c]);
          dl[n][a] = s;
        }
    }
    weights = {shape.nodes, shape.value.data() + first, dl.data()};
    return interpolation.evaluate(nodes.data(), weights);
  }

  // The maps A_i of R^n are multiples of the identity, l_i I and l_{i,a} I one above the other, and not made.
  void linearize() {
    if constexpr (!is_linear<M>) interpolation.linearize(nodes.data(), maps);
  }
  /// c A_i. With `first` = 1, c has no columns for the value of a field in R^n, on which what it is of does not depend.
  template <int first = 0, int R>
  Mat<T, R, dim> times_map(const Mat<T, R, local - first * dim>& c, std::size_t i) const {
    if constexpr (!is_linear<M>) {
      return c * maps[i];
    } else {
      const auto l = multiples<first>(i);
      Mat<T, R, dim> r;
      for (int row = 0; row < R; ++row)
        for (int x = 0; x < dim; ++x) {
          T sum = l[0] * c(row, x);
          for (std::size_t a = 1; a < l.size(); ++a) sum += l[a] * c(row, static_cast<int>(a) * dim + x);
          r(row, x) = sum;
        }
      return r;
    }
  }
  /// A_i^T c, the same with the rows of c.
  template <int first = 0, int C>
  Mat<T, dim, C> transposed_map_times(std::size_t i, const Mat<T, local - first * dim, C>& c) const {
    if constexpr (!is_linear<M>) {
      return transpose_times(maps[i], c);
    } else {
      const auto l = multiples<first>(i);
      Mat<T, dim, C> r;
      for (int x = 0; x < dim; ++x)
        for (int column = 0; column < C; ++column) {
          T sum = l[0] * c(x, column);
          for (std::size_t a = 1; a < l.size(); ++a) sum += l[a] * c(static_cast<int>(a) * dim + x, column);
          r(x, column) = sum;
        }
      return r;
    }
  }
  /// The gradient by node i of what has the derivative f in the local coordinates.
  Vec<T, dim> gradient(std::size_t i, const Vec<T, local>& f) const {
    Mat<T, local, 1> c;
    c.e = f.e;
    return column(transposed_map_times(i, c), 0);
  }

 private:
  /// l_i, l_{i,1}, ..., from number `first` on.
  template <int first>
  std::array<T, static_cast<std::size_t>(1 + D - first)> multiples(std::size_t i) const {
    std::array<T, static_cast<std::size_t>(1 + D - first)> l;
    if constexpr (first == 0) l[0] = T(weights.l[i]);
    for (std::size_t a = 0; a < D; ++a) l[a + 1 - first] = weights.dl[i][a];
    return l;
  }
};

/// All lanes of an entry.
template <class T>
void store_lanes(const T& x, std::size_t entry, AlignedVector<double>& to) {
  if constexpr (lanes<T> == 1)
    to[entry] = lane(x, 0);
  else
    x.store(to.data() + entry * native_width);
}
inline void store_lanes(const std::vector<NativeScalar>& from, AlignedVector<double>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) store_lanes(from[i], i, to);
}

/// Energies of a batch and what is wrong with them, lane by lane.
inline void report_lanes(const NativeScalar& energy, const MaskOf<NativeScalar>& defined, BatchResult& out) {
  for (int lane = 0; lane < native_width; ++lane) {
    const auto l = static_cast<std::size_t>(lane);
    out.energy[l] = karcher::lane(energy, lane);
    const bool lane_defined = karcher::lane(select(defined, NativeScalar(1.0), NativeScalar(0.0)), lane) > 0;
    out.trouble[l] = !lane_defined               ? Trouble::undefined_interpolation
                     : std::isinf(out.energy[l]) ? Trouble::infinite_energy
                     : std::isnan(out.energy[l]) ? Trouble::not_finite
                                                 : Trouble::none;
  }
}

}  // namespace karcher
