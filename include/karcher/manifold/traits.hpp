#pragma once
/// \file
/// What code asks of a manifold beside its geometry (manifold.hpp), and the answers for a type that says nothing. ManifoldOps (any_manifold.hpp) holds the
/// answers for code that chooses manifolds at run time. All these members are optional:
///
/// M::description          std::string_view, one line for lists: what the manifold is and how its points are written
/// M::linear               true: M is R^n with points, tangent vectors and coordinates as in Euclidean<n> (the law suite tests it). Fields are then
///                         interpolated linearly and may be fixed coordinate by coordinate
/// M::lengths              std::array<bool, dim>: whether a tangent coordinate is a length, as coordinates of R^n are (and all of a linear type), or free of units,
///                         as angles are. Steps in lengths are measured by the size of the mesh
/// M::body_axes            true: the tangent coordinates are the rotation vector of a body, about its three axes, and one axis may be left free
/// M::directions           true: points are directions of space, unit vectors of R^3 that turn with a body and may be normals of surfaces
/// M::cut_ratio(p, q)      at double: how near q is to where no shortest geodesic from p is the only one, 1 there; else dist(p, q) / injectivity_radius
/// M::make_point(x, p)     at double: p from ambient data x that are a point up to rounding; false where they are not. Else project(x), else exp_x(0)
/// M::standard_point()     at double: the value of a field that is given none; else M::origin(), else 0 for linear types
/// M::has_identity         true: problem files may call the standard point "identity"
/// M::error_coordinates(p) template over the scalar: a Vec of coordinates in a Euclidean space that induce the metric, in which errors are measured; else the
///                         ambient ones
/// M::Entries              how problem files write points beside their ambient coordinates:
///                           counts                the further numbers of entries, an array of int
///                           wanted                std::string_view that lists all ways, for sentences ("... must be an array: <wanted>, not ...")
///                           make_point(e, p)      at double: the point of such a number of entries (std::span), false where they are none
///                           error_coordinates(e)  template over the scalar: M::error_coordinates of the entries as they are, not projected
/// M::quantities()         std::vector<Quantity>: what probes may ask for beside the ambient coordinates
/// M::arrays()             std::vector<Quantity>: what stands in files beside the ambient coordinates
/// M::drawing()            Drawing: how the page shows values; else each ambient coordinate is a colour to choose

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "karcher/error.hpp"
#include "karcher/manifold/drawing.hpp"
#include "karcher/manifold/manifold.hpp"
#include "karcher/manifold/quantity.hpp"

namespace karcher {

template <class M>
inline constexpr bool is_linear = false;
template <class M>
requires requires { M::linear; }
inline constexpr bool is_linear<M> = M::linear;

template <class M>
constexpr std::string_view description_of() {
  if constexpr (requires { M::description; })
    return M::description;
  else
    return {};
}

template <class M>
constexpr std::array<bool, static_cast<std::size_t>(M::dim)> lengths_of() {
  if constexpr (requires { M::lengths; }) {
    return M::lengths;
  } else {
    std::array<bool, static_cast<std::size_t>(M::dim)> lengths{};
    lengths.fill(is_linear<M>);
    return lengths;
  }
}

template <class M>
constexpr bool has_body_axes() {
  if constexpr (requires { M::body_axes; }) {
    static_assert(!M::body_axes || M::dim == 3, "The axes of a body are three: a manifold with body_axes has dim = 3.");
    return M::body_axes;
  } else {
    return false;
  }
}

template <class M>
constexpr bool has_directions() {
  if constexpr (requires { M::directions; })
    return M::directions;
  else
    return false;
}

template <class M>
double cut_ratio(const Point<M>& p, const Point<M>& q) {
  if constexpr (requires { M::cut_ratio(p, q); })
    return M::cut_ratio(p, q);
  else if constexpr (M::injectivity_radius < std::numeric_limits<double>::infinity())
    return distance<M>(p, q) / M::injectivity_radius;
  else
    return 0;
}

template <class M>
bool make_point(const Point<M>& x, Point<M>& p) {
  const auto finite = [](const Point<M>& y) { return std::ranges::all_of(y.e, [](double c) { return std::isfinite(c); }); };
  if (!finite(x)) return false;
  bool good = true;
  if constexpr (requires { M::make_point(x, p); }) {
    good = M::make_point(x, p);
  } else if constexpr (HasProjection<M>) {
    p = M::project(x);
  } else {
    p = M::exp(x, Point<M>{});
  }
  return good && finite(p);
}

/// Empty where the type names no point.
template <class M>
std::vector<double> standard_point_of() {
  const auto coordinates = [](const Point<M>& p) { return std::vector<double>(p.e.begin(), p.e.end()); };
  if constexpr (requires { M::standard_point(); })
    return coordinates(M::standard_point());
  else if constexpr (requires { M::origin(); })
    return coordinates(M::origin());
  else if constexpr (is_linear<M>)
    return coordinates({});
  else
    return {};
}

template <class M>
constexpr bool has_identity() {
  if constexpr (requires { M::has_identity; })
    return M::has_identity;
  else
    return false;
}

template <class M, class T>
auto error_coordinates(const Point<M, T>& p) {
  if constexpr (requires { M::error_coordinates(p); })
    return M::error_coordinates(p);
  else
    return p;
}

/// Numbers of entries that a problem file may give for a point.
template <class M>
std::vector<int> entry_counts() {
  std::vector<int> counts{M::ambient};
  if constexpr (requires { typename M::Entries; }) counts.insert(counts.end(), M::Entries::counts.begin(), M::Entries::counts.end());
  return counts;
}

template <class M>
std::string entries_wanted() {
  if constexpr (requires { typename M::Entries; }) {
    return std::string(M::Entries::wanted);
  } else {
    const std::string s = M::ambient == 1 ? "" : "s";
    return std::to_string(M::ambient) + " number" + s + " or expression" + s;
  }
}

namespace manifold_detail {
template <class M, class T>
Point<M, T> ambient_entries(std::span<const T> e) {
  Point<M, T> p;
  std::copy_n(e.begin(), M::ambient, p.e.begin());
  return p;
}
}  // namespace manifold_detail

/// \param e as many as one of entry_counts
template <class M>
bool make_point_of_entries(std::span<const double> e, Point<M>& p) {
  if constexpr (requires { typename M::Entries; })
    if (e.size() != static_cast<std::size_t>(M::ambient)) return M::Entries::make_point(e, p);
  return make_point<M>(manifold_detail::ambient_entries<M>(e), p);
}

template <class M, class T>
auto error_coordinates_of_entries(std::span<const T> e) {
  if constexpr (requires { typename M::Entries; })
    if (e.size() != static_cast<std::size_t>(M::ambient)) return M::Entries::error_coordinates(e);
  return error_coordinates<M>(manifold_detail::ambient_entries<M>(e));
}

template <class M>
std::vector<Quantity> quantities_of() {
  if constexpr (requires { M::quantities(); })
    return M::quantities();
  else
    return {};
}

template <class M>
std::vector<Quantity> arrays_of() {
  if constexpr (requires { M::arrays(); })
    return M::arrays();
  else
    return {};
}

/// \throws InputError if the coordinates do not make the glyph.
template <class M>
Drawing drawing_of() {
  Drawing drawing;
  if constexpr (requires { M::drawing(); }) drawing = M::drawing();
  const std::string complaint = drawing.complaint(M::ambient);
  if (!complaint.empty()) throw InputError(std::string(M::name) + ": " + complaint);
  return drawing;
}

}  // namespace karcher
