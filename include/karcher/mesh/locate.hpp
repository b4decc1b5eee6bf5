#pragma once
/// \file
/// The entity of a region nearest to a point, for probes and for values of one mesh on another.

#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

struct Location {
  int cell = -1;             ///< of the region
  Vec3<double> xi;           ///< reference coordinates there, inside the reference cell
  double distance = 0;       ///< from the point to the place found
  double cell_diameter = 0;  ///< largest distance of two vertices of the cell
};

/// Finds nearest places of a region's (curved) geometry, in a tree of boxes: for many points of a large mesh.
class Locator {
 public:
  /// Keeps both.
  Locator(const Mesh& mesh, const Region& region);
  /// Of several equally near places, one in the cell of lowest number.
  Location nearest(const Vec3<double>& point) const;
  /// The nearest places of all cells that are equally near to 1e-9 of their diameters: those that share the place, and those of other sheets that cross there.
  std::vector<Location> all_nearest(const Vec3<double>& point) const;

 private:
  struct Box {
    Vec3<double> low, high;
    int begin = 0, end = 0;       ///< into order_
    int first = -1, second = -1;  ///< halves; none: a leaf
  };
  int split(int begin, int end);
  Location in_cell(int cell, const Vec3<double>& point) const;
  /// Calls visit(cell) for cells that may be nearer than reach(), nearer boxes first.
  template <class Reach, class Visit>
  void search(int box, const Vec3<double>& point, const Reach& reach, const Visit& visit) const;

  const Mesh& mesh_;
  const Region& region_;
  std::vector<Vec3<double>> centres_;  ///< of balls around the cells
  std::vector<double> radii_;
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

/// The nearest place for one point.
Location nearest(const Mesh& mesh, const Region& region, const Vec3<double>& point);

/// The nearest place, which must be near: a probe is a point of the exact surface, from which a mesh of straight cells differs.
/// \param tolerance  largest distance in diameters of the nearest cell \throws InputError with the distance and the nearest place if it is farther or the
/// point is not finite
Location locate(const Mesh& mesh, const Region& region, const Vec3<double>& point, double tolerance = 0.1);

}  // namespace karcher
