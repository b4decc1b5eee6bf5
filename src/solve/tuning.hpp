#pragma once
/// \file
/// SolverTuning: every number by which the solver decides something and which is no option. Steps, radii and Ritz values are measured in the norm of
/// solve/norm.hpp, in which lengths are parts of the domain and angles are radians; noise is Iterate::noise, below which energies cannot be told apart.

#include <array>

#include "solve/subproblem.hpp"

namespace karcher {

struct SolverTuning {
  // What an energy can tell.
  /// noise = this * sum |e|, e the terms of the energy: some twenty roundings, since a sum over many cells loses more than one.
  double noise = 4e-15;
  /// A step s with decrease <= significant * (noise + R) + uncertain * (sum_d (r_d s_d)^2 + 4 E R / n)^1/2, r = Rounding::gradient, R = Rounding::energy,
  /// E = sum |e|, n unknowns, is tiny: the energy cannot judge it, so the gradient does. The root is what independent errors make: r of the model's g.s, and errors
  /// of strain whose own energy is R of the energy E of n strains.
  double significant = 10, uncertain = 2;

  // Acceptance of a trial point.
  /// Accepted if (fall of the energy) / decrease > this; small, since a rejected step costs as much as an accepted one and only divergence must be prevented.
  double least_ratio = 0.01;
  /// A tiny step is accepted if |g|_* <= this * |g|_* before. Corrections that reach it go on.
  double steadier = 0.5;

  // The radius (solve/radius.hpp).
  double first_radius = 1;   ///< where SolverOptions::initial_radius is 0: half the domain, or one radian
  double poor_ratio = 0.25;  ///< accepted with ratio < this: the model is wrong at that length,
  double poor_fall = 0.5;    ///< so radius = this * |s|
  double good_ratio = 0.9;   ///< accepted with ratio > this
  double long_step = 0.9;    ///< and |s| > this * radius: it was the radius that kept the step short,
  double growth = 2;         ///< so radius *= this
  /// |ratio - 1| <= exact before corrections, held back, and H positive definite: the energy is quadratic with a minimum, and the radius, which has no unit for
  /// fields that are no places, is only in the way, so radius *= exact_growth
  double exact = 1e-6, exact_growth = 1e4;
  double longest_radius = 8;  ///< radius <= this * |s| in any case: much longer than the last step it would say nothing about the next one
  /// Rejected: radius = t |s|, t the minimum of the parabola along s, kept in [least_fall, most_fall]; undefined_fall where there is no parabola (the energy is not
  /// defined at the trial point).
  double least_fall = 0.2, most_fall = 0.5, undefined_fall = 0.25;
  /// A tiny step within a radius < this may be tiny because of the radius alone: a step of this length is asked for before the solver takes it for the end.
  double shortest_radius = 1e-6;

  /// A body that moves by more than this many of its diameters in a load step flies away: nothing holds it, or a unit is wrong.
  double farthest = 100;

  // Where the next matrix is factorised (Subproblem::next_shift).
  double trusted_ratio = 0.75;  ///< ratio > this: the multiplier is falling towards the minimum,
  double shift_fall = 0.5;      ///< so shift = this * multiplier; else shift = multiplier

  // Trial points of one basis: parts of the length that are tried, since soft directions may spoil what the stiff ones gain.
  std::array<double, 3> parts{1, 0.25, 0.0625};

  // Corrections (solve/corrections.hpp).
  /// A correction that gains less than this part of all that was gained, and does not reach `steadier`, is the last.
  double correction_share = 0.1;
  double correction_growth = 4;  ///< the next correction is no longer than this times the last one, and than the step

  // The predictor of moving boundaries (solve/predictor.hpp).
  double boundary_moves = 1e-13;  ///< a boundary that moves by <= this does not move: rounding is no move
  /// |g|_* < this * |g|_* with the boundary moved: it is the boundary that disturbs an equilibrium, and the solution is about as far as the boundary goes.
  double at_equilibrium = 0.1;

  // Saddles (solve/saddle.hpp).
  int most_escapes = 20;  ///< in a load step; each one lowers the energy, so this is a guard against wasting time only
  /// Lengths tried along the lowest eigenvector: doubled from escape_from on while the energy falls, and shorter than escape_up_to.
  double escape_from = 1e-3, escape_up_to = 3;

  // The certificate (solve/stability.hpp).
  /// An eigenvalue with |e| <= this * (largest H_dd / M_dd) is zero: its sign is rounding.
  double neutral = 1e-11;
  int certificate_solves = 4;   ///< by which a Hessian without such eigenvalues is told, so that most need no further factorisation
  int certificate_seed = 1000;  ///< far from those of the searches
  double rare_part = 1e-3;  ///< a vector without symmetry has a smaller part along a given direction than this / sqrt(n) in one of a thousand cases
  double soft_part = 0.1;   ///< a gradient of which more than this works along neutral directions is a load that nothing holds

  // What a step may cost.
  Effort trial{.accuracy = 0.05, .expansions = 10, .refactorisations = 2};   ///< 5 % of the decrease are not worth a solve
  Effort newton{.accuracy = 1e-8, .expansions = 10, .refactorisations = 2};  ///< for quadratic convergence
  Effort correction{.accuracy = 0.1, .expansions = 2, .refactorisations = 0};

  // The basis of the direct subproblem.
  int longest_basis = 60;
  int orthogonalisations = 2;  ///< twice is enough (Kahan, Parlett)
  /// Of a residual, parts <= this * |g|_*, and of a vector after orthogonalisation, parts < smallest_rest of it, are on their way to rounding. Taken as new
  /// directions they would let rounding decide which way a structure buckles, which then differs from one number of ranks to another.
  double smallest_residual = 1e-8, smallest_rest = 1e-5;
  int patience = 2;            ///< expansions in a row that gain less than Effort::accuracy, after which the basis is stuck
  double good_residual = 0.1;  ///< a stuck basis is good enough with a residual <= this * |g|_*
  int few_directions = 3;      ///< so many missing directions of negative curvature are sought by inverse iteration; more by another factorisation
  /// The next shift, where directions of negative curvature are missing: max(known * shift, multiplier, -known * lowest Ritz value) if the basis has one; else
  /// blind * shift, or max(|g|_* / radius, blind * |lowest Ritz value|) from shift 0: nothing tells how low the spectrum reaches.
  double known_shift_growth = 1.5, blind_shift_growth = 30;
  int probes = 6, probes_per_direction = 2, most_probes = 16;  ///< solves of a search: min(probes + probes_per_direction * negative, most_probes)
  double settled = 1.1;                                        ///< a lowest Ritz value > this * the last one (both negative) has settled

  double jump = 10;  ///< see PathWatch

  // Load steps (run_continuation with adaptive steps).
  int few_iterations = 5;        ///< a load step of <= this many iterations is followed by
  double step_growth = 2;        ///< one this times as long (at most the length asked for)
  double step_fall = 0.5;        ///< a failed one by one this times as long
  double step_remainder = 1e-3;  ///< a rest of the range < this * the step is taken along with it
  double same_load = 1e-9;       ///< the loads of two sequences of fixed steps are the same up to this part of a step: they differ by rounding
};

inline constexpr SolverTuning default_tuning;

}  // namespace karcher
