#pragma once
/// \file
/// Drawing: how the page shows the values of a field. It is data, since a page is made of stored ambient coordinates, long after the types are gone.

#include <string>
#include <vector>

namespace karcher {

/// What stands at the nodes.
enum class Glyph {
  none,
  arrow,
  rod,       ///< an arrow without a head: a vector and its opposite are the same
  frame,     ///< three arrows: the axes of a rotated body
  ellipsoid  ///< of a symmetric positive definite matrix
};

struct Drawing {
  Glyph glyph = Glyph::none;
  /// The ambient coordinates that make the glyph. arrow, rod: x, y or x, y, z; frame: x, y, z, w of a unit quaternion (w the real part);
  /// ellipsoid: xx, yy, xy (it is then flat) or xx, yy, zz, xy, xz, yz.
  std::vector<int> coordinates{};
  /// Whether every ambient coordinate is a colour to choose; not where a point has more than one set of them.
  bool components = true;
  /// The ambient coordinates, at most three, are those of a place: a map from an interval is seen best as the curve it is.
  bool place = false;
  /// Such a curve lies on the unit sphere, which is drawn below it.
  bool sphere = false;
  /// The axes of a frame stand in files as director1, director2, director3 (M::arrays(), traits.hpp), of which colours are made.
  bool directors = false;

  /// A sentence if the coordinates do not make the glyph from `ambient` coordinates, else empty.
  std::string complaint(int ambient) const;
};

}  // namespace karcher
