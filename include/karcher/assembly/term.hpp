#pragma once
/// \file
/// Term: an integral over the cells of a region of a density of some fields, evaluated in batches of W = native_width cells of one kind.
///
/// Local unknowns of a cell: field after field, node after node, component after component. Everything a batch returns is entry-major, lane-minor:
/// gradient[r * W + lane], hessian[(r * n + c) * W + lane]; of the Hessian only the entries r <= c and the whole diagonal blocks are defined.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "karcher/energy/energy_info.hpp"
#include "karcher/field/field.hpp"
#include "karcher/math/aligned.hpp"
#include "karcher/math/pack.hpp"

namespace karcher {

enum class Want { energy, gradient, hessian };

/// What went wrong in a kernel, by value (no exceptions in loops).
enum class Trouble : char { none, undefined_interpolation, infinite_energy, not_finite };

/// A block of local unknowns: the tangent coordinates of one node of one field.
struct LocalBlock {
  int field = 0;
  int dim = 0;
};

struct Batch {
  int cells_used = 0;                               ///< lanes that count; the others repeat a cell and are ignored
  std::array<int, native_width> cells{};            ///< index into the term's region
  const std::vector<LocalBlock>* blocks = nullptr;  ///< shared by all batches of a cell kind
  /// nodes[b * native_width + lane]: node (of its field) of local block b
  std::vector<int> nodes;
};

struct BatchResult {
  std::array<double, native_width> energy{};
  std::array<Trouble, native_width> trouble{};
  AlignedVector<double> gradient, hessian;  ///< resized by the caller to n * W and n * n * W
};

class Term {
 public:
  virtual ~Term() = default;
  virtual const TermInfo& info() const = 0;
  const std::string& name() const { return info().name; }
  /// Parts that the density can tell apart (empty: none); same order as batch_part_energies().
  const std::vector<std::string>& part_names() const { return info().parts; }
  virtual int batch_count() const = 0;
  virtual const Batch& batch(int b) const = 0;
  /// Energy of each cell of batch b, and gradient and Hessian when wanted. Thread of control returns normally in every case; trouble is reported by lane.
  virtual void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const = 0;
  /// Energy of every part on every cell of batch b; empty if there are no parts.
  virtual std::vector<std::array<double, native_width>> batch_part_energies(const Configuration& /*u*/, int /*b*/) const { return {}; }
  /// Energy of every part, summed over the term's own cells.
  std::vector<double> part_energies(const Configuration& u) const {
    std::vector<double> sums(part_names().size(), 0.0);
    for (int b = 0; b < batch_count() && !sums.empty(); ++b) {
      const auto parts = batch_part_energies(u, b);
      for (std::size_t p = 0; p < parts.size(); ++p)
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch(b).cells_used); ++lane) sums[p] += parts[p][lane];
    }
    return sums;
  }
  /// Means over every cell of batch b (by reference measure) of info().quantities, component after component of one after the other; not a number where the
  /// interpolation is not defined. Empty if there are none.
  virtual std::vector<std::array<double, native_width>> batch_quantities(const Configuration& /*u*/, int /*b*/) const { return {}; }
  /// Called when the load parameter changes, before evaluations at the new value: data that depends on t is recomputed.
  virtual void set_load_parameter(double /*t*/) {}
  /// Nodal values of a field of the problem where the term is free of stress (EnergyInfo::stress_free); empty: its manifold's standard point everywhere.
  virtual std::vector<double> stress_free(int /*field*/) const { return {}; }
  /// Sentences for the user about data that the term can work with but that is suspicious (empty: none).
  virtual std::vector<std::string> warnings() const { return {}; }
  /// The entity of the mesh behind index `cell` (for messages and output).
  virtual const Cell& cell(int cell) const = 0;
};

}  // namespace karcher
