#pragma once
/// \file
/// ManifoldOps: a manifold chosen at run time, as plain functions on arrays of doubles. Used where values are stored, moved and written; kernels use the types.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "karcher/manifold/manifold.hpp"

namespace karcher {

struct ManifoldOps {
  std::string name;
  int ambient = 0;
  int dim = 0;
  double injectivity_radius = 0;
  bool has_projection = false;
  void (*retract)(const double* p, const double* v, double* q) = nullptr;  ///< q = retract(p, v), v: dim coordinates; q may be p
  void (*frame)(const double* p, double* e) = nullptr;                     ///< ambient x dim, row-major
  void (*exp)(const double* p, const double* a, double* q) = nullptr;      ///< ambient tangent vector a
  void (*log)(const double* p, const double* q, double* a) = nullptr;
  double (*dist)(const double* p, const double* q) = nullptr;
  double (*inner)(const double* p, const double* a, const double* b) = nullptr;
  /// Closest point for manifolds that have one; else a check-and-clean (symmetrise, normalise) of data that is a point up to rounding.
  /// Returns false where x is not (near) a point or the projection is not defined. p may be x.
  bool (*make_point)(const double* x, double* p) = nullptr;
};

namespace manifold_detail {

template <int N>
Vec<double, N> read(const double* x) {
  Vec<double, N> v;
  for (int i = 0; i < N; ++i) v[i] = x[i];
  return v;
}
template <std::size_t N>
void write(const std::array<double, N>& e, double* x) {
  for (std::size_t i = 0; i < N; ++i) x[i] = e[i];
}
template <std::size_t N>
bool finite(const std::array<double, N>& e) {
  for (double x : e)
    if (!std::isfinite(x)) return false;
  return true;
}

template <class M>
bool make_point(const Point<M>& x, Point<M>& p) {
  if (!finite(x.e)) return false;
  bool good = true;
  if constexpr (requires { M::make_point(x, p); }) {
    good = M::make_point(x, p);
  } else if constexpr (HasProjection<M>) {
    p = M::project(x);
  } else {
    p = M::exp(x, Point<M>{});
  }
  return good && finite(p.e);
}

}  // namespace manifold_detail

/// The operations of M behind plain function pointers.
template <class M>
const ManifoldOps& manifold_ops() {
  static_assert(CheckManifold<M>::passed);
  constexpr int n = M::ambient;
  namespace d = manifold_detail;
  static const ManifoldOps ops{
      .name = std::string(M::name),
      .ambient = n,
      .dim = M::dim,
      .injectivity_radius = M::injectivity_radius,
      .has_projection = HasProjection<M>,
      .retract = [](const double* p, const double* v, double* q) { d::write(karcher::retract<M>(d::read<n>(p), d::read<M::dim>(v)).e, q); },
      .frame = [](const double* p, double* e) { d::write(M::frame(d::read<n>(p)).e, e); },
      .exp = [](const double* p, const double* a, double* q) { d::write(M::exp(d::read<n>(p), d::read<n>(a)).e, q); },
      .log = [](const double* p, const double* q, double* a) { d::write(M::log(d::read<n>(p), d::read<n>(q)).e, a); },
      .dist = [](const double* p, const double* q) { return distance<M>(d::read<n>(p), d::read<n>(q)); },
      .inner = [](const double* p, const double* a, const double* b) -> double { return M::inner(d::read<n>(p), d::read<n>(a), d::read<n>(b)); },
      .make_point =
          [](const double* x, double* p) {
            Point<M> y{};
            const bool good = d::make_point<M>(d::read<n>(x), y);
            if (good) d::write(y.e, p);
            return good;
          },
  };
  return ops;
}

/// By the name used in problem files (R1 R2 R3 S1 S2 S3 SO3 SU2 SPD2 SPD3 H2 H3). \throws InputError with the known names and the nearest.
const ManifoldOps& manifold_by_name(const std::string& name);
std::vector<std::string> manifold_names();
/// One line for lists: what the manifold is and how its points are written.
const std::string& manifold_description(const std::string& name);

}  // namespace karcher
