#pragma once
/// \file
/// ManifoldOps: a manifold chosen at run time, as plain functions on arrays of doubles. Used where values are stored, moved and written; kernels use the types.
/// Code asks it, never its name: a user's own type answers by the members that manifold.hpp and traits.hpp list.

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "karcher/manifold/traits.hpp"
#include "karcher/math/dual.hpp"

namespace karcher {

/// How points are read from entries of a problem file. e: `count` numbers, one of the accepted counts.
struct EntryOps {
  std::vector<int> counts;
  std::string wanted;  ///< "3 numbers or expressions", for sentences
  /// Returns false where the entries are no point and cannot be projected to one.
  bool (*make_point)(const double* e, int count, double* p) = nullptr;
  /// In the coordinates of ManifoldOps::error_coordinates; the entries are taken as they are, not projected.
  void (*error_coordinates)(const Dual<double, 3>* e, int count, Dual<double, 3>* x) = nullptr;
};

struct ManifoldOps {
  std::string name, description;
  int ambient = 0;
  int dim = 0;

  // Geometry.
  double injectivity_radius = 0;
  bool has_projection = false;
  bool linear = false;
  void (*retract)(const double* p, const double* v, double* q) = nullptr;  ///< q = retract(p, v), v: dim coordinates; q may be p
  void (*frame)(const double* p, double* e) = nullptr;                     ///< ambient x dim, row-major
  void (*exp)(const double* p, const double* a, double* q) = nullptr;      ///< ambient tangent vector a
  void (*log)(const double* p, const double* q, double* a) = nullptr;
  double (*dist)(const double* p, const double* q) = nullptr;
  double (*cut_ratio)(const double* p,
                      const double* q) = nullptr;  ///< of dist and the distance at which there is another shortest geodesic; 0: there is none
  double (*inner)(const double* p, const double* a, const double* b) = nullptr;

  // Tangent coordinates.
  std::vector<bool> lengths;  ///< of each, whether it is a length; else it is free of units
  bool body_axes = false;     ///< they are the rotation vector of a body, about its three axes
  bool directions = false;    ///< points are directions of space

  // Points.
  /// Closest point for manifolds that have one; else a check-and-clean (symmetrise, normalise) of data that is a point up to rounding.
  /// Returns false where x is not (near) a point or the projection is not defined. p may be x.
  bool (*make_point)(const double* x, double* p) = nullptr;
  std::vector<double> standard_point;  ///< of a field without values; empty where the type names none
  bool has_identity = false;           ///< the standard point is the identity
  EntryOps entries{};

  // Coordinates in a Euclidean space that induce the metric: errors are measured there.
  int error_size = 0;
  void (*error_coordinates)(const double* p, double* x) = nullptr;
  void (*error_derivative)(const double* p, const double* dp, double* dx) = nullptr;  ///< dp, dx: one derivative of p and of x

  // Results.
  std::vector<Quantity> quantities;  ///< for probes, beside the ambient coordinates
  std::vector<Quantity> arrays;      ///< in files, beside the ambient coordinates
  Drawing drawing;
};

namespace manifold_detail {

template <int N>
Vec<double, N> read(const double* x) {
  Vec<double, N> v;
  std::copy_n(x, N, v.e.begin());
  return v;
}
template <std::size_t N>
void write(const std::array<double, N>& e, double* x) {
  std::ranges::copy(e, x);
}

/// dx of x = error coordinates of p + dp.
template <class M>
void error_derivative(const double* p, const double* dp, double* dx) {
  Point<M, Dual<double, 1>> q;
  for (int i = 0; i < M::ambient; ++i) {
    q[i] = Dual<double, 1>(p[i]);
    q[i].d[0] = dp[i];
  }
  for (const Dual<double, 1>& x : error_coordinates<M>(q).e) *dx++ = x.d[0];
}

template <class M>
EntryOps entry_ops() {
  return {.counts = entry_counts<M>(),
          .wanted = entries_wanted<M>(),
          .make_point =
              [](const double* e, int count, double* p) {
                Point<M> y{};
                const bool good = make_point_of_entries<M>({e, static_cast<std::size_t>(count)}, y);
                if (good) write(y.e, p);
                return good;
              },
          .error_coordinates =
              [](const Dual<double, 3>* e, int count, Dual<double, 3>* x) {
                std::ranges::copy(error_coordinates_of_entries<M>(std::span(e, static_cast<std::size_t>(count))).e, x);
              }};
}

}  // namespace manifold_detail

/// The operations of M behind plain function pointers.
template <class M>
const ManifoldOps& manifold_ops() {
  static_assert(CheckManifold<M>::passed);
  constexpr int n = M::ambient;
  constexpr auto lengths = lengths_of<M>();
  namespace d = manifold_detail;
  static const ManifoldOps ops{
      .name = std::string(M::name),
      .description = std::string(description_of<M>()),
      .ambient = n,
      .dim = M::dim,
      .injectivity_radius = M::injectivity_radius,
      .has_projection = HasProjection<M>,
      .linear = is_linear<M>,
      .retract = [](const double* p, const double* v, double* q) { d::write(karcher::retract<M>(d::read<n>(p), d::read<M::dim>(v)).e, q); },
      .frame = [](const double* p, double* e) { d::write(M::frame(d::read<n>(p)).e, e); },
      .exp = [](const double* p, const double* a, double* q) { d::write(M::exp(d::read<n>(p), d::read<n>(a)).e, q); },
      .log = [](const double* p, const double* q, double* a) { d::write(M::log(d::read<n>(p), d::read<n>(q)).e, a); },
      .dist = [](const double* p, const double* q) { return distance<M>(d::read<n>(p), d::read<n>(q)); },
      .cut_ratio = [](const double* p, const double* q) { return karcher::cut_ratio<M>(d::read<n>(p), d::read<n>(q)); },
      .inner = [](const double* p, const double* a, const double* b) -> double { return M::inner(d::read<n>(p), d::read<n>(a), d::read<n>(b)); },
      .lengths = std::vector<bool>(lengths.begin(), lengths.end()),
      .body_axes = has_body_axes<M>(),
      .directions = has_directions<M>(),
      .make_point =
          [](const double* x, double* p) {
            Point<M> y{};
            const bool good = karcher::make_point<M>(d::read<n>(x), y);
            if (good) d::write(y.e, p);
            return good;
          },
      .standard_point = standard_point_of<M>(),
      .has_identity = has_identity<M>(),
      .entries = d::entry_ops<M>(),
      .error_size = static_cast<int>(decltype(error_coordinates<M>(Point<M>{}))::size()),
      .error_coordinates = [](const double* p, double* x) { d::write(karcher::error_coordinates<M>(d::read<n>(p)).e, x); },
      .error_derivative = &d::error_derivative<M>,
      .quantities = quantities_of<M>(),
      .arrays = arrays_of<M>(),
      .drawing = drawing_of<M>(),
  };
  return ops;
}

/// One of those that problem files know (every_manifold.hpp). \throws InputError with the known names and the nearest.
const ManifoldOps& manifold_by_name(const std::string& name);
std::vector<std::string> manifold_names();

}  // namespace karcher
