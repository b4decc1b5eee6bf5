#pragma once
/// \file
/// The shape that a page shows: what the parts of a Store show to the outside (faces, boundary faces of solids, curves), cut into triangles and polylines as finely as
/// their curvature asks for.
///
/// Facets keep the Lagrange geometry of their cells. An edge is cut into n = 1, 2, 4, 8 or 16 pieces, by its own curvature over all states, so that neighbours
/// agree; the inside of a facet is cut as finely as the finest of its edges and its own curvature ask for, and its outer points move to the nearest point
/// of the coarser edge. Triangles that this makes flat are dropped.
///
/// Where they are few enough, the faces inside solids are there, too, so that a solid that is cut open shows its cells and not an empty shell.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/page_store.hpp"

namespace karcher {

/// A facet: a face or a curve with Lagrange nodes of its part.
struct PageFacet {
  int part = 0;
  int cell = 0;  ///< cell of the part it belongs to
  CellKind kind = CellKind::triangle;
  std::vector<int> nodes;
  /// Where a part on a boundary covers a facet of an earlier part: that one's part and cell (-1: none).
  int below_part = -1, below_cell = -1;
};

/// A point of the shape: a place in a facet, by the weights of the facet's nodes (those of a table that lives as long as the program).
struct PageVertex {
  int facet = 0;
  const std::vector<double>* weights = nullptr;
};

struct PageGeometry {
  std::vector<PageFacet> facets;
  std::vector<PageVertex> vertices;
  std::vector<std::uint32_t> triangles, triangle_facets;           ///< three vertices each
  std::vector<std::uint32_t> curves, curve_lengths, curve_facets;  ///< polylines of curves
  std::vector<std::uint32_t> edges, edge_lengths;                  ///< element edges, borders and creases first
  int strong_edges = 0;
  /// Faces between two cells of a solid: three vertices each, and the facet of the cell on one side; the next facet is the same face as seen from the other.
  std::vector<std::uint32_t> inner_triangles, inner_facets;
  /// For every facet a number of the cell of a solid that it bounds (or that lies below it), else a number of its own; empty without inner faces.
  std::vector<std::uint32_t> solid_cells;
  std::string note;  ///< what was left out, if anything

  /// Value at a vertex of numbers at the points of its part ([point][component]).
  void interpolate(std::size_t vertex, const std::vector<float>& values, int components, double* out) const;
};

/// \param states indices of the stored states that will be shown
PageGeometry page_geometry(const Store& store, const std::vector<int>& states, int most_triangles);

}  // namespace karcher
