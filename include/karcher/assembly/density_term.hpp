#pragma once
/// \file
/// DensityTerm: the generic kernel. Any density of any fields, with exact gradient and Hessian (interpolation.hpp explains the seam).
///
/// A density is called with a jet for every field, operator()(u...), and returns W; or it has parts(u...), which returns a std::array of the parts of W. Where it takes
/// one argument more, that is the reference configuration at the point (reference_point.hpp), before the fields: operator()(s, u...), parts(s, u...).
/// quantities([s,] u...) may give other numbers at the point, as an array, and static quantity_infos() says what they are, component after component.
/// A model has at<P>(span<const P> parameters), the density at a point, P double or a pack.
/// Derivatives of W come from jets in the local coordinates of its fields, those of the fields from the interpolation rules. A density of a deformation and a rotation
/// that offers energy(body strains) (body_strains.hpp), or of a deformation and a director that offers energy(director strains) (director_strains.hpp), has jets in the
/// strains instead. That of one field with values in R^n that offers energy(gradient) (gradient_derivatives.hpp) has them in the gradient, and a Hessian of its own.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>

#include "karcher/assembly/body_strain_derivatives.hpp"
#include "karcher/assembly/cell_batches.hpp"
#include "karcher/assembly/director_strain_derivatives.hpp"
#include "karcher/assembly/field_state.hpp"
#include "karcher/assembly/gradient_derivatives.hpp"
#include "karcher/assembly/point_parameters.hpp"
#include "karcher/interpolation/interpolation.hpp"

namespace karcher {

namespace density_detail {

template <class Density, class S, class... U>
concept Placed = requires(const Density& w, const S& s, const U&... u) {
  w(s, u...);
}
|| requires(const Density& w, const S& s, const U&... u) { w.parts(s, u...); };

/// The parts of W at a point; nothing if the density has none.
template <class Density, class S, class... U>
auto parts(const Density& w, const S& s, const U&... u) {
  if constexpr (requires { w.parts(s, u...); })
    return w.parts(s, u...);
  else if constexpr (requires { w.parts(u...); })
    return w.parts(u...);
  else
    return std::array<double, 0>{};
}

template <class Density, class S, class... U>
auto quantities(const Density& w, const S& s, const U&... u) {
  if constexpr (requires { w.quantities(s, u...); })
    return w.quantities(s, u...);
  else if constexpr (requires { w.quantities(u...); })
    return w.quantities(u...);
  else
    return std::array<double, 0>{};
}

template <class Density, class S, class... U>
auto value(const Density& w, const S& s, const U&... u) {
  if constexpr (requires { w(s, u...); }) {
    return w(s, u...);
  } else if constexpr (requires { w(u...); }) {
    return w(u...);
  } else {
    const auto all = parts(w, s, u...);
    auto sum = all[0];
    for (std::size_t i = 1; i < all.size(); ++i) sum += all[i];
    return sum;
  }
}

}  // namespace density_detail

/// A density without parameters that vary from point to point.
template <class Density>
struct FixedDensity {
  Density density;
  template <class P>
  const Density& at(std::span<const P>) const {
    return density;
  }
};

/// A density whose parameters are numbers of type P at every point: Density<P>::of(span<const P>).
template <template <class> class Density>
struct VaryingDensity {
  template <class P>
  Density<P> at(std::span<const P> p) const {
    return Density<P>::of(p);
  }
};

/// The quadrature degree of densities where nothing else is said: twice the highest order p of the fields plus one, which is exact for the squared gradient of
/// polynomials on affine cells and a little more; on curves and surfaces plus four, since the interpolation is not polynomial (measured for harmonic maps into S^2:
/// 1e-7 relative of the energy for Q1, 1e-11 for Q2).
inline int density_degree(const TermInput& input, CellKind kind) {
  int order = 1;
  for (const int f : input.fields) order = std::max(order, input.all_fields[static_cast<std::size_t>(f)].space->order());
  return 2 * order + (dimension(kind) == 3 ? 1 : 4);
}

template <class Model, int D, class... Interpolation>
class DensityTerm : public Term {
  using T = NativeScalar;
  static constexpr int W = native_width;
  static constexpr std::size_t F = sizeof...(Interpolation);
  static constexpr std::array<int, F> local{local_dim<typename Interpolation::Manifold, D>...};
  static constexpr int L = (local_dim<typename Interpolation::Manifold, D> + ...);
  template <std::size_t f>
  using M = typename std::tuple_element_t<f, std::tuple<Interpolation...>>::Manifold;

  static constexpr int offset(std::size_t f) {
    int o = 0;
    for (std::size_t i = 0; i < f; ++i) o += local[i];
    return o;
  }
  using DensityAtPoint = std::decay_t<decltype(std::declval<const Model&>().template at<T>(std::span<const T>()))>;
  using Reference = ReferencePoint<D, T>;
  using Quantities = decltype(density_detail::quantities(std::declval<const DensityAtPoint&>(), std::declval<const Reference&>(),
                                                         std::declval<const FieldJet<typename Interpolation::Manifold, D, T>&>()...));
  static constexpr bool placed =
      density_detail::Placed<DensityAtPoint, Reference, FieldJet<typename Interpolation::Manifold, D, T>...> || std::tuple_size_v<Quantities> != 0;
  /// 1 where W depends on the derivatives of field f only, so that the rows of its value are left out.
  template <std::size_t f>
  static constexpr int first_row = f == 0 && F == 2 && D > 0 && (OfBodyStrains<DensityAtPoint, D, T> || OfDirectorStrains<DensityAtPoint, T>) ? 1 : 0;
  static constexpr bool of_gradient = [] {
    if constexpr (F == 1 && D > 0) {
      if constexpr (is_linear<M<0>>) return OfGradient<DensityAtPoint, M<0>::dim, D, T>;
    }
    return false;
  }();

 public:
  /// \param parameter_keys  keys of input.parameters in the order in which Model::at expects them
  DensityTerm(TermInfo info, const TermInput& input, Model model, const std::vector<std::string>& parameter_keys)
      : info_(std::move(info)),
        model_(std::move(model)),
        fields_(input.fields),
        batches_(
            input, [&](CellKind kind) { return density_degree(input, kind); }, placed),
        parameters_(batches_, input.of(parameter_keys), input.t) {
    if constexpr (requires { DensityAtPoint::quantity_infos(); }) {
      info_.quantities = DensityAtPoint::quantity_infos();
      std::size_t components = 0;
      for (const QuantityInfo& q : info_.quantities) components += static_cast<std::size_t>(q.components);
      assert(components == std::tuple_size_v<Quantities> && "quantity_infos() describes all components that quantities() gives, and no other");
    }
  }

  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return batches_.count(); }
  const Batch& batch(int b) const override { return batches_.batch(b); }
  const Cell& cell(int c) const override { return batches_.cell(c); }
  void set_load_parameter(double t) override { parameters_.set_load_parameter(batches_, t); }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    if constexpr (of_gradient)
      evaluate_of_gradient(u, b, want, out);
    else
      evaluate_impl(u, b, want, out, std::make_index_sequence<F>{});
  }

  std::vector<std::array<double, native_width>> batch_part_energies(const Configuration& u, int b) const override {
    std::vector<std::array<double, native_width>> sums(part_names().size());
    if (!sums.empty())
      add_up(
          u, b, [](const auto& rho, const auto&... at) { return density_detail::parts(rho, at...); }, sums, std::make_index_sequence<F>{});
    return sums;
  }

  std::vector<std::array<double, native_width>> batch_quantities(const Configuration& u, int b) const override {
    std::vector<std::array<double, native_width>> means(std::tuple_size_v<Quantities>);
    if (means.empty()) return means;
    const MaskOf<T> defined = add_up(
        u, b, [](const auto& rho, const auto&... at) { return density_detail::quantities(rho, at...); }, means, std::make_index_sequence<F>{});
    T measure = T(0.0);
    for (int q = 0; q < batches_.kind(b).quadrature->size(); ++q) measure += batches_.point(b, q).weight;
    const T scale = select(defined, T(1.0) / measure, T(std::numeric_limits<double>::quiet_NaN()));
    for (auto& mean : means)
      for (int lane = 0; lane < W; ++lane) mean[static_cast<std::size_t>(lane)] *= karcher::lane(scale, lane);
    return means;
  }

 protected:
  const CellBatches& batches() const { return batches_; }
  const std::vector<int>& fields() const { return fields_; }
  /// Parameter p at a quadrature point, for models whose data are not expressions.
  T& parameter(int b, int q, std::size_t p) { return parameters_.at(batches_.point_index(b, q))[p]; }

  using States = std::tuple<FieldState<Interpolation, D>...>;

  /// Of the pairs of nodes (i of field f, j of field g), i <= j where f = g, the blocks A_i^T C A_j one after the other: [j][i][row][column].
  struct Workspace {
    States states;
    std::vector<T> gradient;
    std::array<std::array<std::vector<T>, F>, F> blocks;
    std::tuple<std::vector<Mat<T, Interpolation::Manifold::dim, Interpolation::Manifold::dim>>...> second;

    template <std::size_t f, std::size_t... g>
    void begin_blocks(const KindData& kind, std::index_sequence<g...>) {
      const auto size = [&](std::size_t other, int dims) {
        const auto rows = static_cast<std::size_t>(kind.shapes[f].nodes), columns = static_cast<std::size_t>(kind.shapes[other].nodes);
        return (f == other ? rows * (rows + 1) / 2 : f < other ? rows * columns : 0) * static_cast<std::size_t>(dims);
      };
      (blocks[f][g].assign(size(g, M<f>::dim * M<g>::dim), T(0.0)), ...);
    }
  };
  /// Kept from batch to batch, since making it costs as much as a small element.
  static Workspace& workspace() {
    thread_local Workspace work;
    return work;
  }

  template <std::size_t f>
  MaskOf<T> gather(const Configuration& u, int b, States& states) const {
    return std::get<f>(states).gather(u, fields_[f], batches_.batch(b), batches_.kind(b), f);
  }
  template <std::size_t f>
  MaskOf<T> move_to(int b, int q, States& states) const {
    return std::get<f>(states).move_to(batches_.point(b, q), batches_.kind(b), f, q);
  }

  auto density(int b, int q) const { return model_.template at<T>(parameters_.at(batches_.point_index(b, q))); }

  /// W as a function of the local coordinates of all fields.
  template <class S, class Density, std::size_t... f>
  static S density_at(const Density& rho, const Reference& reference, const States& states, std::index_sequence<f...>) {
    if constexpr (F == 2 && D > 0 && OfBodyStrains<Density, D, T>) {
      const auto& rotation = std::get<1>(states).interpolation;
      static_assert(std::is_same_v<typename std::decay_t<decltype(rotation)>::Chart, ProjectionChart>);
      const auto y = rotation.local_coordinates();
      std::array<Vec3<T>, D> rates;
      for (int a = 0; a < D; ++a)
        for (int i = 0; i < 3; ++i) rates[static_cast<std::size_t>(a)][i] = y[3 * (1 + a) + i];
      return of_body_strains<S, D>(rho, std::get<0>(states).interpolation.jet().d, rotation.jet().value, rates);
    } else if constexpr (F == 2 && D == 2 && OfDirectorStrains<Density, T>) {
      const auto& director = std::get<1>(states).interpolation;
      static_assert(std::is_same_v<typename std::decay_t<decltype(director)>::Chart, ProjectionChart>);
      const auto y = director.local_coordinates();
      return of_director_strains<S, T>(rho, std::get<0>(states).interpolation.jet().d, director.jet(), director.frame(),
                                       {Vec<T, 2>{{y[2], y[3]}}, Vec<T, 2>{{y[4], y[5]}}});
    } else {
      return density_detail::value(rho, reference, jet_of<S, f>(states)...);
    }
  }
  Reference reference_at(int b, int q) const {
    if constexpr (placed)
      return batches_.template reference<D>(b, q);
    else
      return {};
  }
  template <class S, std::size_t f>
  static auto jet_of(const States& states) {
    const auto& interpolation = std::get<f>(states).interpolation;
    using I = std::tuple_element_t<f, std::tuple<Interpolation...>>;
    return seeded_jet<M<f>, D, typename I::Chart, S>(interpolation.jet().value, interpolation.frame(), interpolation.local_coordinates(), offset(f));
  }

  template <std::size_t... f>
  void evaluate_impl(const Configuration& u, int b, Want want, BatchResult& out, std::index_sequence<f...> all) const {
    const KindData& kind = batches_.kind(b);
    Workspace& work = workspace();
    States& states = work.states;
    MaskOf<T> defined = T(0.0) < T(1.0);
    ((defined = defined & gather<f>(u, b, states)), ...);

    const auto n = static_cast<std::size_t>(kind.unknowns);
    work.gradient.assign(want == Want::energy ? 0 : n, T(0.0));
    if (want == Want::hessian) {
      (work.template begin_blocks<f>(kind, all), ...);
      (std::get<f>(work.second).assign(static_cast<std::size_t>(kind.shapes[f].nodes * kind.shapes[f].nodes), {}), ...);
    }
    const std::array<std::size_t, F> begin = unknowns_begin(kind);

    T energy = T(0.0);
    for (int q = 0; q < kind.quadrature->size(); ++q) {
      ((defined = defined & move_to<f>(b, q, states)), ...);
      const T weight = batches_.point(b, q).weight;
      const auto rho = density(b, q);
      const Reference reference = reference_at(b, q);
      if (want == Want::energy) {
        energy += weight * density_detail::value(rho, reference, std::get<f>(states).interpolation.jet()...);
        continue;
      }
      (std::get<f>(states).linearize(), ...);
      Vec<T, L> covector;
      if (want == Want::gradient) {
        const auto w = density_at<Dual<T, L>>(rho, reference, states, all);
        energy += weight * w.v;
        for (int i = 0; i < L; ++i) covector[i] = weight * w.d[static_cast<std::size_t>(i)];
      } else {
        auto w = density_at<Jet<T, L>>(rho, reference, states, all);
        w.scale(weight);
        energy += w.v;
        for (int i = 0; i < L; ++i) covector[i] = w.gradient(i);
        (add_rows<f>(work, kind, w, all), ...);
        (std::get<f>(states).interpolation.add_second_variation(std::get<f>(states).nodes.data(), part<f>(covector), std::get<f>(work.second).data()),
         ...);
      }
      (add_gradient<f>(states, kind, begin, covector, work.gradient), ...);
    }

    report_lanes(energy, defined, out);
    store_lanes(work.gradient, out.gradient);
    if (want == Want::hessian) (store_rows<f>(work, kind, begin, out, all), ...);
  }

  void evaluate_of_gradient(const Configuration& u, int b, Want want, BatchResult& out) const {
    constexpr int k = M<0>::dim;
    const KindData& kind = batches_.kind(b);
    Workspace& work = workspace();
    thread_local PairSums<k, D, T> hessian;  // kept as the workspace is
    gather<0>(u, b, work.states);            // defined everywhere
    const auto& state = std::get<0>(work.states);
    const std::size_t count = state.nodes.size(), n = count * k;
    work.gradient.assign(want == Want::energy ? 0 : n, T(0.0));
    if (want == Want::hessian) hessian.begin(count);
    T energy = T(0.0);
    for (int q = 0; q < kind.quadrature->size(); ++q) {
      move_to<0>(b, q, work.states);
      const Mat<T, k, D> f = matrix_of_columns(state.interpolation.jet().d);
      const T weight = batches_.point(b, q).weight;
      const auto rho = density(b, q);
      if (want == Want::energy) {
        T w(0.0);
        rho.add_energy_of_gradient(w, f);
        energy += weight * w;
        continue;
      }
      Mat<T, k, D> force;
      if (want == Want::gradient) {
        const auto w = karcher::of_gradient<Dual<T, k * D>>(rho, f);
        energy += weight * w.v;
        force.e = w.d;
      } else {
        auto w = karcher::of_gradient<Jet<T, k * D>>(rho, f);
        energy += weight * w.v;
        force.e = w.g;
        for (T& h : w.h) h *= weight;
        hessian.add(state.dl.data(), w);
      }
      for (T& x : force.e) x *= weight;
      for (std::size_t i = 0; i < count; ++i) {
        const Vec<T, k> g = force * Vec<T, D>{state.dl[i]};
        for (std::size_t c = 0; c < k; ++c) work.gradient[i * k + c] += g[static_cast<int>(c)];
      }
    }
    report_lanes(energy, T(0.0) < T(1.0), out);
    store_lanes(work.gradient, out.gradient);
    if (want == Want::hessian)
      hessian.finish([&](std::size_t i, std::size_t j, const T* block) {
        for (std::size_t r = 0; r < k; ++r)
          for (std::size_t c = 0; c < k; ++c) store_lanes(block[r * k + c], (i * k + r) * n + j * k + c, out.hessian);
      });
  }

  /// Integrals over the cells of batch b of what numbers(density, reference, jets...) gives at a point, an array; lanes where everything is defined.
  template <class Numbers, std::size_t... f>
  MaskOf<T> add_up(const Configuration& u, int b, const Numbers& numbers, std::vector<std::array<double, native_width>>& sums,
                   std::index_sequence<f...>) const {
    States states;
    MaskOf<T> defined = T(0.0) < T(1.0);
    ((defined = defined & gather<f>(u, b, states)), ...);
    for (int q = 0; q < batches_.kind(b).quadrature->size(); ++q) {
      ((defined = defined & move_to<f>(b, q, states)), ...);
      const auto all = numbers(density(b, q), reference_at(b, q), std::get<f>(states).interpolation.jet()...);
      const T weight = batches_.point(b, q).weight;
      for (std::size_t p = 0; p < std::min(all.size(), sums.size()); ++p)
        for (int lane = 0; lane < W; ++lane) sums[p][static_cast<std::size_t>(lane)] += karcher::lane(weight * all[p], lane);
    }
    return defined;
  }

 private:
  std::array<std::size_t, F> unknowns_begin(const KindData& kind) const {
    std::array<std::size_t, F> begin{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < F; ++i) {
      begin[i] = next;
      next += static_cast<std::size_t>(kind.shapes[i].nodes * kind.blocks[static_cast<std::size_t>(kind.first_block[i])].dim);
    }
    return begin;
  }
  template <std::size_t f>
  static Vec<T, local[f]> part(const Vec<T, L>& y) {
    Vec<T, local[f]> mine;
    for (int i = 0; i < local[f]; ++i) mine[i] = y[offset(f) + i];
    return mine;
  }

  template <std::size_t f>
  static void add_gradient(const States& states, const KindData& kind, const std::array<std::size_t, F>& begin, const Vec<T, L>& covector,
                           std::vector<T>& gradient) {
    constexpr auto k = static_cast<std::size_t>(M<f>::dim);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kind.shapes[f].nodes); ++i) {
      const auto g = std::get<f>(states).gradient(i, part<f>(covector));
      for (std::size_t c = 0; c < k; ++c) gradient[begin[f] + i * k + c] += g[static_cast<int>(c)];
    }
  }

  /// A_i^T C A_j for the rows of field f and the columns of the fields from f on.
  template <std::size_t f, std::size_t... g>
  static void add_rows(Workspace& work, const KindData& kind, const Jet<T, L>& w, std::index_sequence<g...>) {
    (add_pair<f, g>(work, kind, w), ...);
  }
  template <std::size_t f, std::size_t g>
  static void add_pair(Workspace& work, const KindData& kind, const Jet<T, L>& w) {
    if constexpr (g >= f) {
      const auto rows = static_cast<std::size_t>(kind.shapes[f].nodes), columns = static_cast<std::size_t>(kind.shapes[g].nodes);
      constexpr int above = first_row<f> * M<f>::dim, left = first_row<g> * M<g>::dim;
      Mat<T, local[f] - above, local[g] - left> c;
      for (int i = 0; i < c.rows(); ++i)
        for (int j = 0; j < c.cols(); ++j) c(i, j) = w.hessian(offset(f) + above + i, offset(g) + left + j);
      T* to = work.blocks[f][g].data();
      for (std::size_t j = 0; j < columns; ++j) {
        const auto ca = std::get<g>(work.states).template times_map<first_row<g>>(c, j);
        for (std::size_t i = 0; i < (f == g ? j + 1 : rows); ++i) {
          const auto block = std::get<f>(work.states).template transposed_map_times<first_row<f>>(i, ca);
          for (const T& x : block.e) *to++ += x;
        }
      }
    }
  }
  template <std::size_t f, std::size_t... g>
  static void store_rows(const Workspace& work, const KindData& kind, const std::array<std::size_t, F>& begin, BatchResult& out,
                         std::index_sequence<g...>) {
    (store_pair<f, g>(work, kind, begin, out), ...);
  }
  template <std::size_t f, std::size_t g>
  static void store_pair(const Workspace& work, const KindData& kind, const std::array<std::size_t, F>& begin, BatchResult& out) {
    if constexpr (g >= f) {
      constexpr auto kf = static_cast<std::size_t>(M<f>::dim), kg = static_cast<std::size_t>(M<g>::dim);
      const auto n = static_cast<std::size_t>(kind.unknowns);
      const auto rows = static_cast<std::size_t>(kind.shapes[f].nodes), columns = static_cast<std::size_t>(kind.shapes[g].nodes);
      const T* from = work.blocks[f][g].data();
      for (std::size_t j = 0; j < columns; ++j)
        for (std::size_t i = 0; i < (f == g ? j + 1 : rows); ++i) {
          const std::size_t corner = (begin[f] + i * kf) * n + begin[g] + j * kg;
          for (std::size_t r = 0; r < kf; ++r)
            for (std::size_t s = 0; s < kg; ++s, ++from) {
              if constexpr (f == g && !is_linear<M<f>>)
                store_lanes(*from + std::get<f>(work.second)[i * rows + j](static_cast<int>(r), static_cast<int>(s)), corner + r * n + s,
                            out.hessian);
              else
                store_lanes(*from, corner + r * n + s, out.hessian);
            }
        }
    }
  }

  TermInfo info_;
  Model model_;
  std::vector<int> fields_;
  CellBatches batches_;
  PointParameters parameters_;
};

}  // namespace karcher
