#pragma once
/// \file
/// FieldKernel: what a FieldState is for a term that does not know the type of its field. Local coordinates y and what depends on them: interpolation.hpp.

#include <algorithm>
#include <memory>

#include "karcher/assembly/field_state.hpp"
#include "karcher/assembly/with_rule.hpp"

namespace karcher {

/// Matrices are row-major; `stride` is the distance of their rows.
class FieldKernel {
 public:
  using T = NativeScalar;
  virtual ~FieldKernel() = default;
  virtual std::size_t ambient() const = 0;
  virtual std::size_t dim() const = 0;
  /// Local coordinates.
  virtual std::size_t local() const = 0;

  virtual MaskOf<T> gather(const Configuration& u, int field, const Batch& batch, const KindData& kind, std::size_t slot) = 0;
  virtual MaskOf<T> move_to(const BatchPoint& point, const KindData& kind, std::size_t slot, int q) = 0;
  /// The jet z: the value, and the derivatives one after the other, in ambient coordinates.
  virtual void jet(T* value, T* derivatives) const = 0;
  /// Finds the derivatives of the jet, the second ones if asked for, and those of the local coordinates by the nodes.
  virtual void differentiate(Want want) = 0;
  /// dz/dy row after row, of which the entries that do not vanish are set.
  virtual void rows(T* value, T* derivatives, std::size_t stride) const = 0;
  /// f += l dz/dy
  virtual void add_covector(const T* l, T* f) const = 0;
  /// c += l d2z/dy2, upper triangle.
  virtual void add_curvature(const T* l, T* c, std::size_t stride) const = 0;
  /// gradient_i += A_i^T f
  virtual void add_gradient(const T* f, T* gradient) const = 0;
  /// hessian_ij += A_i^T c A_j for i <= j, where c has its upper triangle, and the contraction of f with the second variation.
  virtual void add_hessian(const T* c, std::size_t stride, T* hessian, std::size_t hessian_stride) = 0;
  virtual void add_second_variation(const T* f) = 0;
  /// Those second variations, at the end of the cell.
  virtual void finish(T* hessian, std::size_t stride) = 0;
  /// r = c A_j, r with `dim` columns.
  virtual void times_map(const T* c, std::size_t stride, std::size_t rows, std::size_t j, T* r) const = 0;
  /// hessian_i += A_i^T c for all i.
  virtual void add_transposed(const T* c, std::size_t columns, T* hessian, std::size_t stride) const = 0;
};

template <class I, int D>
class FieldKernelOf final : public FieldKernel {
  using M = typename I::Manifold;
  using State = FieldState<I, D>;
  static constexpr int N = M::ambient, k = M::dim, L = State::local;
  static constexpr bool unit = requires { M::unit_scale; }
  &&std::is_same_v<typename I::Chart, ProjectionChart>;
  static constexpr bool by_jets = !unit && !is_linear<M>;

 public:
  std::size_t ambient() const override { return N; }
  std::size_t dim() const override { return k; }
  std::size_t local() const override { return L; }

  MaskOf<T> gather(const Configuration& u, int field, const Batch& batch, const KindData& kind, std::size_t slot) override {
    const auto count = static_cast<std::size_t>(kind.shapes[slot].nodes);
    second_.assign(count * count, {});
    return state_.gather(u, field, batch, kind, slot);
  }
  MaskOf<T> move_to(const BatchPoint& point, const KindData& kind, std::size_t slot, int q) override { return state_.move_to(point, kind, slot, q); }

  void jet(T* value, T* derivatives) const override {
    const auto& jet = state_.interpolation.jet();
    std::copy(jet.value.e.begin(), jet.value.e.end(), value);
    for (std::size_t a = 0; a < D; ++a) std::copy(jet.d[a].e.begin(), jet.d[a].e.end(), derivatives + a * N);
  }

  void differentiate(Want want) override {
    state_.linearize();
    if constexpr (by_jets) {
      if (want == Want::hessian)
        set(second_order_);
      else
        set(first_order_);
      want_ = want;
    }
  }

  // By jets, or in closed form: y are the derivatives themselves, or those of a unit vector in the projection chart (see seeded_jet), with 1/s^2 = curvature
  //   q(w) = q + E w - |w|^2/(2 s^2) q,  d_a q = E k_a - (w.k_a)/s^2 (q + E w) - |w|^2/(2 s^2) E k_a.

  void rows(T* value, T* derivatives, std::size_t stride) const override {
    if constexpr (is_linear<M>) {
      for (std::size_t i = 0; i < k; ++i) value[i * stride + i] = T(1.0);
      for (std::size_t i = k; i < L; ++i) derivatives[(i - k) * stride + i] = T(1.0);
    } else if constexpr (unit) {
      const auto& e = state_.interpolation.frame();
      const auto y = state_.interpolation.local_coordinates();
      const auto& q = state_.interpolation.jet().value;
      for (int c = 0; c < N; ++c) {
        T* row = value + static_cast<std::size_t>(c) * stride;
        for (int i = 0; i < k; ++i) row[i] = e(c, i);
        for (int a = 0; a < D; ++a) {
          T* slope = derivatives + static_cast<std::size_t>(a * N + c) * stride;
          const T back = -(curvature * q[c]);
          for (int i = 0; i < k; ++i) {
            slope[i] = back * y[(1 + a) * k + i];
            slope[(1 + a) * k + i] = e(c, i);
          }
        }
      }
    } else {
      for_each(second_order_,
               [&](std::size_t r, const auto& z) { std::ranges::copy(z.g, r < N ? value + r * stride : derivatives + (r - N) * stride); });
    }
  }
  void add_covector(const T* l, T* f) const override {
    if constexpr (is_linear<M>) {
      for (std::size_t i = 0; i < L; ++i) f[i] += l[i];
    } else if constexpr (unit) {
      const auto y = state_.interpolation.local_coordinates();
      add_in_frame(l, f);
      for (int a = 0; a < D; ++a) {
        const T inward = curvature * along(l, 1 + a, state_.interpolation.jet().value);
        for (int i = 0; i < k; ++i) f[i] -= inward * y[(1 + a) * k + i];
        add_in_frame(l + (1 + a) * N, f + (1 + a) * k);
      }
    } else {
      const auto add = [&](std::size_t r, const auto& slopes) {
        for (std::size_t i = 0; i < L; ++i) f[i] += l[r] * slopes[i];
      };
      if (want_ == Want::hessian)
        for_each(second_order_, [&](std::size_t r, const auto& z) { add(r, z.g); });
      else
        for_each(first_order_, [&](std::size_t r, const auto& z) { add(r, z.d); });
    }
  }
  void add_curvature(const T* l, T* c, std::size_t stride) const override {
    if constexpr (unit) {
      const auto y = state_.interpolation.local_coordinates();
      const auto& jet = state_.interpolation.jet();
      T diagonal = along(l, 0, jet.value);
      for (int a = 0; a < D; ++a) {
        diagonal += along(l, 1 + a, jet.d[static_cast<std::size_t>(a)]);
        const T inward = curvature * along(l, 1 + a, jet.value);
        T tangential[k]{};
        add_in_frame(l + (1 + a) * N, tangential);
        const T* ka = y.e.data() + (1 + a) * k;
        for (std::size_t i = 0; i < k; ++i) {
          c[i * stride + static_cast<std::size_t>(1 + a) * k + i] -= inward;
          for (std::size_t j = i; j < k; ++j) c[i * stride + j] -= curvature * (tangential[i] * ka[j] + ka[i] * tangential[j]);
        }
      }
      for (std::size_t i = 0; i < k; ++i) c[i * stride + i] -= curvature * diagonal;
    } else if constexpr (by_jets) {
      Jet<T, L> sum;
      for_each(second_order_, [&](std::size_t r, const auto& z) {
        for (std::size_t p = 0; p < sum.h.size(); ++p) sum.h[p] += l[r] * z.h[p];
      });
      for (int i = 0; i < L; ++i)
        for (int j = i; j < L; ++j) c[static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j)] += sum.h[sum.index(i, j)];
    }
  }

  void add_gradient(const T* f, T* gradient) const override {
    Vec<T, L> covector;
    std::copy_n(f, L, covector.e.begin());
    for (std::size_t i = 0; i < state_.nodes.size(); ++i) {
      const auto g = state_.gradient(i, covector);
      for (std::size_t c = 0; c < k; ++c) gradient[i * k + c] += g[static_cast<int>(c)];
    }
  }
  void add_hessian(const T* upper, std::size_t stride, T* hessian, std::size_t hessian_stride) override {
    Mat<T, L, L> c;
    for (int i = 0; i < L; ++i)
      for (int j = i; j < L; ++j) c(i, j) = c(j, i) = upper[static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j)];
    for (std::size_t j = 0; j < state_.nodes.size(); ++j) {
      const auto ca = state_.times_map(c, j);
      for (std::size_t i = 0; i <= j; ++i) add_block(state_.transposed_map_times(i, ca), hessian + i * k * hessian_stride + j * k, hessian_stride);
    }
  }
  void add_second_variation(const T* f) override {
    Vec<T, L> covector;
    std::copy_n(f, L, covector.e.begin());
    state_.interpolation.add_second_variation(state_.nodes.data(), covector, second_.data());
  }
  void finish(T* hessian, std::size_t stride) override {
    const std::size_t count = state_.nodes.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i; j < count; ++j) add_block(second_[i * count + j], hessian + i * k * stride + j * k, stride);
  }

  void times_map(const T* c, std::size_t stride, std::size_t rows, std::size_t j, T* r) const override {
    for (std::size_t row = 0; row < rows; ++row) {
      Mat<T, 1, L> one;
      std::copy_n(c + row * stride, L, one.e.begin());
      const Mat<T, 1, k> product = state_.times_map(one, j);
      std::copy(product.e.begin(), product.e.end(), r + row * k);
    }
  }
  void add_transposed(const T* c, std::size_t columns, T* hessian, std::size_t stride) const override {
    for (std::size_t x = 0; x < columns; ++x) {
      Vec<T, L> column;
      for (std::size_t y = 0; y < L; ++y) column[static_cast<int>(y)] = c[y * columns + x];
      for (std::size_t i = 0; i < state_.nodes.size(); ++i) {
        const auto product = state_.gradient(i, column);
        for (std::size_t y = 0; y < k; ++y) hessian[(i * k + y) * stride + x] += product[static_cast<int>(y)];
      }
    }
  }

 private:
  template <class S>
  void set(FieldJet<M, D, S>& jet) const {
    const auto& interpolation = state_.interpolation;
    jet = seeded_jet<M, D, typename I::Chart, S>(interpolation.jet().value, interpolation.frame(), interpolation.local_coordinates(), 0);
  }
  /// f(row, z) for all components z of the jet.
  template <class S, class F>
  static void for_each(const FieldJet<M, D, S>& jet, const F& f) {
    for (int c = 0; c < N; ++c) f(static_cast<std::size_t>(c), jet.value[c]);
    for (std::size_t a = 0; a < D; ++a)
      for (int c = 0; c < N; ++c) f((1 + a) * N + static_cast<std::size_t>(c), jet.d[a][c]);
  }
  /// l . x for the part of l that belongs to the value or a derivative.
  static T along(const T* l, int part, const Vec<T, N>& x) {
    T sum = T(0.0);
    for (int c = 0; c < N; ++c) sum += l[part * N + c] * x[c];
    return sum;
  }
  /// f += E^T l
  void add_in_frame(const T* l, T* f) const {
    const auto& e = state_.interpolation.frame();
    for (int c = 0; c < N; ++c)
      for (int i = 0; i < k; ++i) f[i] += l[c] * e(c, i);
  }
  static void add_block(const Mat<T, k, k>& block, T* to, std::size_t stride) {
    for (std::size_t r = 0; r < k; ++r)
      for (std::size_t s = 0; s < k; ++s) to[r * stride + s] += block(static_cast<int>(r), static_cast<int>(s));
  }

  static constexpr double scale() {
    if constexpr (unit)
      return M::unit_scale;
    else
      return 1;
  }
  static constexpr double curvature = 1 / (scale() * scale());
  struct Nothing {};

  State state_;
  Want want_ = Want::energy;
  std::conditional_t<by_jets, FieldJet<M, D, Jet<T, L>>, Nothing> second_order_;
  std::conditional_t<by_jets, FieldJet<M, D, Dual<T, L>>, Nothing> first_order_;
  std::vector<Mat<T, k, k>> second_;
};

/// The kernel of a field with values in M in D directions.
template <class M, int D>
std::unique_ptr<FieldKernel> field_kernel(const Field& field) {
  return with_rule<M, D>(field, []<class I>() -> std::unique_ptr<FieldKernel> { return std::make_unique<FieldKernelOf<I, D>>(); });
}

}  // namespace karcher
