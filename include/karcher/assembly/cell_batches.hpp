#pragma once
/// \file
/// CellBatches: the cells of a region in batches of native_width of one kind, with what a kernel needs at every quadrature point and does not depend on
/// the unknowns: basis functions, measures, frames, places, parameters of the energy.

#include <array>
#include <map>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/energy/reference_point.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {

/// Basis functions of one field on one kind of cell at the quadrature points.
struct ShapeTable {
  int nodes = 0;
  std::vector<double> value;                    ///< [point * nodes + node]
  std::vector<std::array<double, 3>> gradient;  ///< the same, derivatives in the reference coordinates
};

struct KindData {
  CellKind kind;
  const Quadrature* quadrature = nullptr;
  std::vector<ShapeTable> shapes;  ///< one for each field of the term
  std::vector<LocalBlock> blocks;
  std::vector<int> first_block;  ///< of each field of the term
  int unknowns = 0;
};

/// Geometry of a batch at a quadrature point, lane by lane.
struct BatchPoint {
  NativeScalar weight{};                                  ///< quadrature weight times measure
  std::array<std::array<NativeScalar, 3>, 3> to_frame{};  ///< d_a = sum_b to_frame[a][b] d/dxi_b
  Vec3<NativeScalar> x;                                   ///< point of the mesh, also where the stress-free configuration is another
};

/// The stress-free configuration of a batch at a quadrature point, for the densities that ask for it (reference_point.hpp).
struct BatchReference {
  Vec3<NativeScalar> x, normal;
  std::array<Vec3<NativeScalar>, 3> tangent{};
  Mat<NativeScalar, 2, 2> b;
};

class CellBatches {
 public:
  /// \param default_degree  quadrature degree for a cell kind where the problem names none
  /// \param with_reference  whether reference() will be asked for
  CellBatches(const TermInput& input, const std::function<int(CellKind)>& default_degree, bool with_reference = false);

  int count() const { return static_cast<int>(batches_.size()); }
  const Batch& batch(int b) const { return batches_[static_cast<std::size_t>(b)]; }
  const KindData& kind(int b) const { return kinds_[static_cast<std::size_t>(kind_[static_cast<std::size_t>(b)])]; }
  const BatchPoint& point(int b, int q) const { return points_[first_point_[static_cast<std::size_t>(b)] + static_cast<std::size_t>(q)]; }
  const BatchReference& reference(int b, int q) const { return references_[point_index(b, q)]; }
  template <int D>
  ReferencePoint<D, NativeScalar> reference(int b, int q) const {
    const BatchReference& from = references_[point_index(b, q)];
    ReferencePoint<D, NativeScalar> s;
    s.x = from.x;
    for (std::size_t a = 0; a < D; ++a) s.tangent[a] = from.tangent[a];
    if constexpr (D == 1 || D == 2) {
      s.normal = from.normal;
      s.oriented = oriented_;
    }
    if constexpr (D == 2) s.b = from.b;
    return s;
  }
  std::size_t point_index(int b, int q) const { return first_point_[static_cast<std::size_t>(b)] + static_cast<std::size_t>(q); }
  std::size_t point_count() const { return points_.size(); }
  const Cell& cell(int c) const { return region_.cells[static_cast<std::size_t>(c)]; }

 private:
  Region region_;
  std::vector<KindData> kinds_;
  std::vector<Batch> batches_;
  std::vector<int> kind_;
  std::vector<std::size_t> first_point_;
  std::vector<BatchPoint> points_;
  std::vector<BatchReference> references_;  ///< as points_, or none
  bool oriented_ = true;
};

}  // namespace karcher
