#pragma once
/// \file
/// Output: a configuration seen at the Lagrange nodes of one order, region by region, in the ambient coordinates of its manifolds. Files and pictures are made of it.
///
/// Part 0 is the region of the main field (the deformation, else the field on the entities of highest dimension); every further region that carries a field is a
/// part of its own. A part has every field that lives on all of its entities. The order is the highest of the part's fields and geometry.
///
/// Point data of a field u: the ambient coordinates under the field's name, and before them ManifoldOps::arrays under their names ("<field>.<name>" if several fields
/// have one): of SO(3) the columns d_1, d_2, d_3 of the rotation as "director1..3", and on surfaces "normal" = Q n_0, where Q carries the normal n_0 of the
/// stress-free configuration (the mean over the cells at a node; its side is that of Orientation, where there is one).
/// With a deformation m (R^n, n <= 3): points are m itself, "reference" is the place in the stress-free configuration, "displacement" = m - reference.
/// Cell data: "energy_density.<term>" = energy of the term on the cell / reference measure of the cell (length, area, volume), for every term on the part,
/// and "energy_density.<term>.<part>" for the parts that a term tells apart. The quantities of a term are means over the cells: "charge" of the term T is "charge.T",
/// "stress.N" is "stress.T.N".

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/field/field.hpp"

namespace karcher {

struct OutputArray {
  std::string name;
  int components = 1;
  std::vector<double> values;                  ///< [node or cell][component]
  std::vector<std::string> component_names{};  ///< "x", "y", "z"; may be empty
  bool drawn = true;                           ///< whether pages have it
};

struct OutputCell {
  CellKind kind = CellKind::vertex;
  std::vector<int> nodes;  ///< into OutputPart::points, in the order of reference_cell.hpp for OutputPart::order
};

struct OutputPart {
  std::string region;
  int dim = 0;
  int order = 1;
  std::vector<Vec3<double>> points;
  std::vector<OutputCell> cells;
  std::vector<OutputArray> point_data, cell_data;
};

struct OutputModel {
  std::vector<Field> fields{};
  int deformation = -1;                                 ///< index of the field that moves the points; -1: points stay in the mesh
  std::vector<std::string> terms{};                     ///< names of the terms of the functional, all different: see set_terms
  std::vector<std::vector<std::string>> term_parts{};   ///< names of the parts of every term whose energies are shown, too; may be empty
  std::vector<std::vector<QuantityInfo>> quantities{};  ///< of every term, to be shown as cell data; may be empty
  std::vector<std::string> loads{};                     ///< those of the terms that are potentials of loads
  std::vector<int> headless{};                          ///< fields of which u and -u mean the same
  /// Stress-free configuration, if it is not the mesh, and the order of its interpolant (mesh/reference_geometry.hpp).
  std::function<Vec3<double>(const Vec3<double>&)> reference_position{};
  int reference_order = 2;
};

/// Name of a quantity of a term in files.
std::string quantity_name(const std::string& quantity, const std::string& term);

/// Fills what the functional's terms tell of themselves; their names are made distinct (distinct_names of summary.hpp).
void set_terms(OutputModel& model, const Functional& functional);

class OutputSampler {
 public:
  explicit OutputSampler(OutputModel model);
  OutputSampler(OutputSampler&&) noexcept;
  ~OutputSampler();

  /// Energy and quantities of every term on every cell of every part that this rank evaluates, zero elsewhere, in a flat array of the same length on every rank.
  /// Summed over the ranks, entry by entry (sum_over_ranks), it is what sample() takes.
  std::vector<double> cell_energies(const Functional& functional, const Configuration& u) const;

  /// \param u complete on this rank (values of all nodes, see complete() in solve/exchange.hpp); a node where an interpolation is not defined gets NaN
  /// \param energies from cell_energies, summed over the ranks; empty: no cell data
  std::vector<OutputPart> sample(const Configuration& u, std::span<const double> energies = {}) const;

 private:
  struct Part;
  OutputModel model_;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace karcher
