#pragma once
/// \file
/// Catalogue: all energies and loads by name, and the terms made of them.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/energy/parameter.hpp"
#include "karcher/field/field.hpp"

namespace karcher {

/// Everything a term is made of. The region holds only the entities that this rank evaluates.
struct TermInput {
  std::shared_ptr<const Mesh> mesh;
  Region region;
  std::vector<Field> all_fields;  ///< of the problem
  std::vector<int> fields;        ///< index into all_fields for each FieldSlot of the energy, in its order
  ParameterValues parameters;     ///< defaults filled in; mu and lambda always, never young and poisson
  std::map<std::string, std::string> choices;
  std::map<CellKind, int> quadrature_degree;  ///< empty entry: the energy's documented default
  /// Stress-free configuration, if it is not the mesh: position as function of the mesh point, and Lagrange order of its interpolant.
  std::function<Vec3<double>(const Vec3<double>&)> reference_position;
  int reference_order = 2;
  double t = 0;
};

const std::vector<EnergyInfo>& energy_catalogue();
/// Loads have the same description; info.type is the `type` of the problem file ("volume"), the term's type has "-load" after it ("volume-load").
const std::vector<EnergyInfo>& load_catalogue();
/// \throws InputError with a full sentence if the combination makes no sense (manifold, dimension, thickness against curvature, non-finite data).
std::unique_ptr<Term> make_term(const std::string& type, TermInput input);

}  // namespace karcher
