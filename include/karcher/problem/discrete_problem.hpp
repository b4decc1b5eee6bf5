#pragma once
/// \file
/// A problem on its mesh: regions, fields with initial values, boundary data, and the functional.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/io/output.hpp"
#include "karcher/problem/constraints.hpp"
#include "karcher/problem/problem.hpp"
#include "karcher/solve/continuation.hpp"
#include "karcher/solve/exchange.hpp"

namespace karcher {

/// Every field must be moved by something, or the Hessian is singular. \throws InputError
void check_solvable(const Problem& problem);

/// Mesh with all its regions, refined as the file says. \throws InputError
std::shared_ptr<const Mesh> build_mesh(const Problem& problem);

/// Fields on a mesh, their initial values and their boundary data.
struct Discretisation {
  std::shared_ptr<const Mesh> mesh;
  std::vector<Field> fields;
  std::vector<std::vector<unsigned char>> mirrors;  ///< by field, of those of directions: mirror_planes.hpp
  Configuration initial;                            ///< the initial values that the problem states
  Configuration start;                              ///< where the solver starts: there, but for fields that go on from earlier results
  Constraints constraints;
};
Discretisation discretise(const Problem& problem, std::shared_ptr<const Mesh> mesh);

/// Everything that a rank needs to solve.
struct DiscreteProblem {
  Discretisation discretisation;
  std::shared_ptr<Layout> layout;
  std::unique_ptr<Functional> functional;
  std::unique_ptr<Exchange> exchange;
  std::vector<std::string> term_names;  ///< distinct
  std::vector<std::string> warnings;
  std::vector<std::optional<double>> reference_energies;  ///< by term; reference_energy.hpp

  const std::vector<Field>& fields() const { return discretisation.fields; }
};
/// Collective: an error of one rank is thrown on all.
DiscreteProblem build(const Problem& problem, std::shared_ptr<const Mesh> mesh);

/// What cannot be evaluated at the start cannot be minimised. Collective. \throws InputError with the term and the cell
void require_energy(const Problem& problem, const DiscreteProblem& model);

/// All that would stop a run before its first step: probes outside, data that are wrong at the last load, an energy that is not defined at the start.
/// Collective. \throws InputError
void rehearse(const Problem& problem, const DiscreteProblem& model);

/// The boundary data, as load steps want them; empty if they do not change.
BoundaryValues boundary_values(const DiscreteProblem& model);

/// Boundary data that hold in some load steps only, as load steps want them.
ChangingSupports changing_supports(const DiscreteProblem& model);

/// What writers of results need to know.
OutputModel output_model(const Problem& problem, const DiscreteProblem& model);

/// The stress-free configuration in which the deformation can be exactly, so that strains vanish there to rounding: the deformation's own interpolant of the mesh
/// where the mesh is of higher order, else what the problem states. A position without order, or one of a mesh of higher order, comes with its order.
ReferenceSpec reference(const Problem& problem, const Mesh& mesh);

/// Place of the nodes of a space in the stress-free configuration.
std::vector<Vec3<double>> reference_positions(const Problem& problem, const Space& space);

}  // namespace karcher
