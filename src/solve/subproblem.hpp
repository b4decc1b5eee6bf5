#pragma once
/// \file
/// Subproblem: min g.s + 1/2 s.H s over |s|_M <= radius, M the diagonal mass of solve/norm.hpp, for one matrix after the other and for any number of radii and
/// gradients with each. What the trust region asks of it; how it is solved is the business of the implementations (solve/subproblems.hpp names them).

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "karcher/assembly/block_matrix.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/report.hpp"
#include "solve/inertia.hpp"

namespace karcher {

struct SolverTuning;

struct Step {
  std::vector<double> s;            ///< local dofs, ghosts filled
  double multiplier = 0;            ///< lambda >= 0 of (H + lambda M) s = -g; 0: a Newton step, which ends inside the radius
  double decrease = 0;              ///< of g.s + 1/2 s.H s, >= 0
  double norm = 0;                  ///< |s|_M
  std::vector<double> coordinates;  ///< of s in what the subproblem knows: its own business
};

/// How much a step may cost.
struct Effort {
  double accuracy = 0;           ///< relative gain of the decrease under which no more directions are sought
  int expansions = 0;            ///< new directions with one factorisation (or one preconditioner)
  int refactorisations = 0;      ///< new factorisations
  const Step* across = nullptr;  ///< an earlier step for the same matrix: the new one is M-orthogonal to it
};

/// Functions are collective; vectors have local dofs.
class Subproblem {
 public:
  virtual ~Subproblem() = default;

  /// A new matrix. h is kept by reference and must not change while it is used; g by value (fixed entries 0). shift: see next_shift(); 0 if nothing is known.
  virtual void set(const BlockMatrix& h, std::span<const double> g, double shift) = 0;
  /// The same matrix, and all that is known of it, with another gradient.
  virtual void set_gradient(std::span<const double> g) = 0;
  /// Forgets what steps and searches have taught about the matrix, so that nothing that comes depends on them; keeps what setting it has cost.
  virtual void forget_directions() = 0;

  virtual Step step(double radius, const Effort& effort) = 0;
  /// The best step in the directions that are known already.
  virtual Step known_step(double radius, const Step* across = nullptr) const = 0;

  /// Of H + shift M; nothing from those who cannot tell. May cost a factorisation, which stays in use.
  virtual std::optional<Inertia> inertia(double shift) = 0;
  /// Whether H has no eigenvalue in [-s, s] (H x = e M x), as far as a few solves tell: true is sure but for a chance of one in a thousand, false says nothing.
  virtual bool no_eigenvalue_within(double s) = 0;
  /// The part of |g|_*^2 that works along eigenvectors of eigenvalues much smaller than the shift of the last inertia(shift), which must be positive. Costs a solve.
  virtual double soft_part(std::span<const double> g) = 0;
  /// Seeks the directions of negative curvature that inertia() counts, as far as a bounded effort finds them.
  virtual void find_negative_directions() = 0;
  /// Values of s.H s / |s|_M^2 that are known to be stationary in the known directions, ascending, and the direction of the lowest (all zero if none is known).
  virtual std::vector<double> ritz_values() const = 0;
  virtual std::vector<double> lowest_direction() const = 0;

  /// Where the matrix of the next point had best be shifted, after a step that reached `ratio` of its decrease: H + shift M is likely to be the matrix of the
  /// next step. Those who do not shift return 0.
  virtual double next_shift(const Step& accepted, double ratio) const = 0;
};

/// What a subproblem is made from; all references must outlive it.
struct SubproblemInput {
  const Exchange& exchange;
  const BlockMatrix& pattern;                 ///< of all matrices to come; values do not matter
  const std::vector<char>& fixed;             ///< [local dof] != 0: left out
  const std::vector<double>& mass;            ///< [local dof] diagonal of M
  const std::vector<std::uint64_t>& numbers;  ///< [local dof], see solve/seed.hpp
  const SolverTuning& tuning;
  WorkCounts& work;      ///< counted up
  PhaseSeconds& phases;  ///< counted up
};

}  // namespace karcher
