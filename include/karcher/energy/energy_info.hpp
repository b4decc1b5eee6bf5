#pragma once
/// \file
/// EnergyInfo: what an energy or a load takes and tells, one table that the problem-file reader, `karcher doc`, output and library users share.

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "karcher/energy/parameter.hpp"
#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/list.hpp"

namespace karcher {

/// A field that an energy uses, under the key of the problem file ("deformation", "rotation", "field", ...).
struct FieldSlot {
  std::string key;
  std::vector<const ManifoldOps*> manifolds;  ///< accepted ones
  std::string description;
  bool moves =
      false;  ///< its values are places of the points: without initial values they are the reference positions, and pictures show the points there
  bool headless = false;  ///< u and -u mean the same, so pictures show rods, not arrows
  bool normal = false;    ///< without initial values it is the unit normal of the stress-free surface

  bool accepts(const ManifoldOps& m) const { return std::find(manifolds.begin(), manifolds.end(), &m) != manifolds.end(); }
  std::vector<std::string> manifold_names() const {
    std::vector<std::string> names;
    for (const ManifoldOps* m : manifolds) names.push_back(m->name);
    return names;
  }
};

/// The accepted manifolds of a slot: accepted(EveryManifold{}), accepted(ManifoldList<Sphere<2>>{}).
template <class... M>
std::vector<const ManifoldOps*> accepted(ManifoldList<M...>) {
  return {&manifold_ops<M>()...};
}

/// A choice between words ("coupling", "material", "volumetric"); between "false" and "true" (in this order), problem files write it without quotes.
struct Choice {
  std::string name;
  std::vector<std::string> values;  ///< first: the default
  std::string description;
  std::optional<Condition> only{};  ///< on an earlier choice: there is none where this does not hold
  bool is_flag() const { return values.front() == "false"; }
};

/// Something that an energy can tell of a configuration at a point, besides its density: a stress, a charge.
struct QuantityInfo {
  std::string name;
  std::string unit;  ///< in consistent units
  int components = 1;
  std::string description;  ///< a few words, for legends
  /// A strain: where it is larger than this, the energy is used outside of what it is made for; infinite for all else.
  double small_up_to = std::numeric_limits<double>::infinity();
};

/// What a term of a functional tells of itself.
struct TermInfo {
  std::string name;                ///< key under "energies" in summary.json: "cosserat-shell", "volume-load"
  std::vector<std::string> parts;  ///< of its energy, where the density can tell them apart
  std::vector<QuantityInfo> quantities;
  bool load = false;          ///< a potential of loads, not an energy stored in the body
  std::vector<int> headless;  ///< numbers of the fields with FieldSlot::headless, in the functional
  std::vector<int> moving{};  ///< of those with FieldSlot::moves
};

struct EnergyInfo {
  std::string type;             ///< "cosserat-shell"
  std::string description;      ///< formula and source, a few lines
  std::vector<int> dimensions;  ///< of the region: 1, 2, 3
  std::vector<FieldSlot> fields;
  std::vector<Parameter> parameters;
  std::vector<Choice> choices;
  std::vector<std::string> parts;  ///< of the energy, where the density can tell them apart
  bool lame = false;               ///< mu and lambda may be given as young and poisson instead (the reader converts)
  bool formula = false;            ///< the density is a formula of any fields, of which `fields` says nothing
  bool load = false;               ///< belongs under [[loads]]; the name of its terms is its type with "-load" behind
  /// Vanishes in the stress-free configuration: where a field that moves is the reference position and the others are what Term::stress_free says.
  bool stress_free = false;
  /// Has the parameters prestretch[i]; with others than 1 it has an energy there after all.
  bool prestretch = false;
  /// A potential of the volume that a region encloses: a problem adds the parameters share[i] and origin[i] that make it one (problem/enclosure.hpp).
  bool enclosure = false;
  /// A potential only where the first field, of rotations, turns about one axis: a problem tells which (TermInput::free_axes).
  bool one_axis = false;
  std::optional<Condition> constant{};  ///< where it holds, not the energy but its derivative vanishes there

  std::string term_name() const { return load ? type + "-load" : type; }
};

}  // namespace karcher
