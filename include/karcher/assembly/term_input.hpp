#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "karcher/assembly/density_formula.hpp"
#include "karcher/energy/parameter.hpp"
#include "karcher/field/field.hpp"

namespace karcher {

/// Whether a term is the whole of its energy, or one of the terms of selective integration (selective_integration.hpp).
enum class SelectivePart { whole, all_points, membrane, shear, membrane_and_shear };

/// Everything a term is made of. The region holds only the entities that this rank evaluates.
struct TermInput {
  std::shared_ptr<const Mesh> mesh;
  Region region;
  std::vector<Field> all_fields;  ///< of the problem
  std::vector<int> fields;        ///< index into all_fields for each FieldSlot of the energy, in its order
  ParameterValues parameters;     ///< defaults filled in; mu and lambda always, never young and poisson
  std::map<std::string, std::string> choices;
  std::shared_ptr<const DensityFormula> formula;  ///< of energies whose density is one
  std::map<CellKind, int> quadrature_degree;      ///< empty entry: the energy's documented default
  SelectivePart part = SelectivePart::whole;
  /// Stress-free configuration, if it is not the mesh: position as function of the mesh point, and Lagrange order of its interpolant.
  std::function<Vec3<double>(const Vec3<double>&)> reference_position;
  int reference_order = 2;
  double t = 0;
  /// Nodal values at the start, for energies that are free of stress there; none, or none of a field: its manifold's standard point.
  std::shared_ptr<const Configuration> initial;
  /// By field of `fields`, of those of directions: the mirror planes through its nodes, as nodal_normals takes them; or none.
  std::vector<std::vector<unsigned char>> mirrors;
  /// Of energies with EnergyInfo::one_axis, by node of the first field: the tangent coordinate that alone is free; -1 where all are held, and off the region.
  std::vector<signed char> free_axes;

  const Field& field(std::size_t slot) const { return all_fields[static_cast<std::size_t>(fields[slot])]; }
  /// The parameters with these keys, in their order.
  std::vector<ParameterValue> of(const std::vector<std::string>& keys) const {
    std::vector<ParameterValue> list;
    for (const std::string& key : keys) list.push_back(parameters.at(key));
    return list;
  }
  /// `initial` with values of all fields.
  Configuration start() const {
    Configuration u = initial ? *initial : Configuration{};
    u.values.resize(all_fields.size());
    for (std::size_t f = 0; f < all_fields.size(); ++f) {
      if (!u.values[f].empty()) continue;
      const std::vector<double>& standard = all_fields[f].manifold->standard_point;
      for (int node = 0; node < all_fields[f].space->node_count(); ++node) u.values[f].insert(u.values[f].end(), standard.begin(), standard.end());
    }
    return u;
  }
};

}  // namespace karcher
