#pragma once
/// \file
/// Product<M1, M2, ...>: the Riemannian product. Points, tangent vectors and coordinates one after the other; everything acts factor by factor, the metric is the
/// sum. The projection rule is available where every factor has it.

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "karcher/manifold/traits.hpp"

namespace karcher {

namespace product_detail {

/// "R3xSO3"
template <class... M>
struct Name {
  static constexpr std::size_t size = (M::name.size() + ...) + sizeof...(M) - 1;
  static constexpr std::array<char, size> text = [] {
    std::array<char, size> t{};
    std::size_t i = 0;
    const auto append = [&](std::string_view s) {
      if (i > 0) t[i++] = 'x';
      for (char c : s) t[i++] = c;
    };
    (append(M::name), ...);
    return t;
  }();
};

template <int N, class T, int K>
constexpr Vec<T, N> part(const Vec<T, K>& x, int offset) {
  Vec<T, N> r;
  for (int i = 0; i < N; ++i) r[i] = x[offset + i];
  return r;
}
template <class T, int N, int K>
constexpr void set_part(Vec<T, K>& x, int offset, const Vec<T, N>& r) {
  for (int i = 0; i < N; ++i) x[offset + i] = r[i];
}

/// Where each of some consecutive pieces begins.
template <std::size_t K>
constexpr std::array<int, K> offsets(std::array<int, K> sizes) {
  int sum = 0;
  for (int& s : sizes) {
    const int size = s;
    s = sum;
    sum += size;
  }
  return sizes;
}

}  // namespace product_detail

template <Manifold... M>
struct Product {
  static_assert(sizeof...(M) > 0, "Product of at least one manifold");
  static constexpr std::string_view name{product_detail::Name<M...>::text.data(), product_detail::Name<M...>::size};
  static constexpr int ambient = (M::ambient + ...);
  static constexpr int dim = (M::dim + ...);
  static constexpr double injectivity_radius = std::min({static_cast<double>(M::injectivity_radius)...});
  static constexpr int factors = static_cast<int>(sizeof...(M));
  template <std::size_t I>
  using Factor = std::tuple_element_t<I, std::tuple<M...>>;

  /// First ambient coordinate and first tangent coordinate of every factor.
  static constexpr std::array<int, sizeof...(M)> ambient_offset = product_detail::offsets<sizeof...(M)>({M::ambient...});
  static constexpr std::array<int, sizeof...(M)> dim_offset = product_detail::offsets<sizeof...(M)>({M::dim...});
  static constexpr std::array<bool, static_cast<std::size_t>(dim)> lengths = [] {
    std::array<bool, static_cast<std::size_t>(dim)> all{};
    auto to = all.begin();
    ((to = std::ranges::copy(lengths_of<M>(), to).out), ...);
    return all;
  }();

  /// The I-th factor of a point or of an ambient tangent vector.
  template <std::size_t I, class T>
  static Vec<T, Factor<I>::ambient> factor(const Vec<T, ambient>& x) {
    return product_detail::part<Factor<I>::ambient>(x, ambient_offset[I]);
  }

  static Vec<double, ambient> origin() requires(requires { M::origin(); } && ...) {
    return by_factor<double>([]<class F, std::size_t I>() { return F::origin(); });
  }
  template <class T>
  static Vec<T, ambient> exp(const Vec<T, ambient>& p, const Vec<T, ambient>& a) {
    return by_factor<T>([&]<class F, std::size_t I>() { return F::exp(factor<I>(p), factor<I>(a)); });
  }
  template <class T>
  static Vec<T, ambient> log(const Vec<T, ambient>& p, const Vec<T, ambient>& q) {
    return by_factor<T>([&]<class F, std::size_t I>() { return F::log(factor<I>(p), factor<I>(q)); });
  }
  /// A geodesic is the only shortest one where those of all factors are.
  static double cut_ratio(const Vec<double, ambient>& p, const Vec<double, ambient>& q) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) { return std::max({karcher::cut_ratio<M>(factor<I>(p), factor<I>(q))...}); }
    (std::index_sequence_for<M...>{});
  }
  template <class T>
  static T inner(const Vec<T, ambient>& p, const Vec<T, ambient>& a, const Vec<T, ambient>& b) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) { return (M::inner(factor<I>(p), factor<I>(a), factor<I>(b)) + ...); }
    (std::index_sequence_for<M...>{});
  }
  template <class T>
  static Mat<T, ambient, dim> frame(const Vec<T, ambient>& p) {
    Mat<T, ambient, dim> e;
    const auto set = [&]<class F, std::size_t I>() {
      const auto f = F::frame(factor<I>(p));
      for (int i = 0; i < F::ambient; ++i)
        for (int j = 0; j < F::dim; ++j) e(ambient_offset[I] + i, dim_offset[I] + j) = f(i, j);
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) { (set.template operator()<M, I>(), ...); }
    (std::index_sequence_for<M...>{});
    return e;
  }
  template <class T>
  static Vec<T, ambient> project(const Vec<T, ambient>& x) requires(HasProjection<M>&&...) {
    return by_factor<T>([&]<class F, std::size_t I>() { return F::project(factor<I>(x)); });
  }
  template <class T>
  static Vec<T, ambient> chord(const Vec<T, ambient>& q, const Vec<T, ambient>& p) requires(HasProjection<M>&&...) {
    return by_factor<T>([&]<class F, std::size_t I>() { return F::chord(factor<I>(q), factor<I>(p)); });
  }
  static double defect(const Vec<double, ambient>& x) requires(requires(Vec<double, M::ambient> y) { M::defect(y); } && ...) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) { return std::max({M::defect(factor<I>(x))...}); }
    (std::index_sequence_for<M...>{});
  }

 private:
  template <class T, class F>
  static Vec<T, ambient> by_factor(F f) {
    Vec<T, ambient> r;
    [&]<std::size_t... I>(std::index_sequence<I...>) { (product_detail::set_part(r, ambient_offset[I], f.template operator()<M, I>()), ...); }
    (std::index_sequence_for<M...>{});
    return r;
  }
};

}  // namespace karcher
