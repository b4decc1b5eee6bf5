#pragma once
/// \file
/// FieldKernel: what a FieldState is for a term that does not know the type of its field. Local coordinates y and what depends on them: interpolation.hpp.

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
  /// Value and derivatives in ambient coordinates, one after the other.
  virtual void jet(T* z) const = 0;
  /// Finds the derivatives of the jet, the second ones if asked for, and those of the local coordinates by the nodes.
  virtual void differentiate(Want want) = 0;
  /// dz/dy, of which the entries that do not vanish are set.
  virtual void rows(T* g, std::size_t stride) const = 0;
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

  void jet(T* z) const override {
    const auto& jet = state_.interpolation.jet();
    std::copy(jet.value.e.begin(), jet.value.e.end(), z);
    for (std::size_t a = 0; a < D; ++a) std::copy(jet.d[a].e.begin(), jet.d[a].e.end(), z + (1 + a) * N);
  }

  void differentiate(Want want) override {
    state_.linearize();
    if constexpr (!is_linear<M>) {
      if (want == Want::hessian)
        set(second_order_);
      else
        set(first_order_);
    }
    want_ = want;
  }
  void rows(T* g, std::size_t stride) const override {
    if constexpr (is_linear<M>) {
      for (std::size_t i = 0; i < L; ++i) g[i * stride + i] = T(1.0);
    } else {
      for_each(second_order_, [&](std::size_t r, const auto& z) { std::copy(z.g.begin(), z.g.end(), g + r * stride); });
    }
  }
  void add_covector(const T* l, T* f) const override {
    if constexpr (is_linear<M>) {
      for (std::size_t i = 0; i < L; ++i) f[i] += l[i];
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
    if constexpr (!is_linear<M>) {
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
  static void add_block(const Mat<T, k, k>& block, T* to, std::size_t stride) {
    for (std::size_t r = 0; r < k; ++r)
      for (std::size_t s = 0; s < k; ++s) to[r * stride + s] += block(static_cast<int>(r), static_cast<int>(s));
  }

  State state_;
  Want want_ = Want::energy;
  std::conditional_t<is_linear<M>, char, FieldJet<M, D, Jet<T, L>>> second_order_;
  std::conditional_t<is_linear<M>, char, FieldJet<M, D, Dual<T, L>>> first_order_;
  std::vector<Mat<T, k, k>> second_;
};

/// The kernel of a field with values in M in D directions.
template <class M, int D>
std::unique_ptr<FieldKernel> field_kernel(const Field& field) {
  return with_rule<M, D>(field, []<class I>() -> std::unique_ptr<FieldKernel> { return std::make_unique<FieldKernelOf<I, D>>(); });
}

}  // namespace karcher
