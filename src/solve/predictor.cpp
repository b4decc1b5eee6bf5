#include "solve/predictor.hpp"

#include <cmath>

#include "solve/boundary.hpp"
#include "solve/corrections.hpp"
#include "solve/multiply.hpp"

namespace karcher {

std::optional<Prediction> predict(System& system, Configuration& u, const Configuration& boundary, double tolerance) {
  const SolverTuning& tuning = system.tuning;
  const std::vector<double> delta = boundary_increment(system.layout, u, boundary);
  const double reach = uniform_norm(system.layout, system.mass, delta);
  if (reach <= tuning.boundary_moves) {
    copy_fixed_nodes(system.layout, boundary, u);
    return {};
  }
  Prediction naive;  // the inside stays
  naive.x.u = u;
  retract_to_boundary(system.layout, u, delta, boundary, naive.x.u);
  system.evaluator.gradient(naive.x);
  if (!std::isfinite(reach)) return naive;

  Prediction linear;
  linear.x.energy = std::numeric_limits<double>::infinity();
  Iterate start;
  start.u = u;
  if (system.linearise(start, 0.0)) {
    std::vector<double> pull(delta.size());
    multiply(system.exchange, system.hessian(), {}, delta, pull);
    for (std::size_t d = 0; d < pull.size(); ++d) pull[d] = system.fixed[d] ? 0 : pull[d] + start.g[d];
    system.subproblem().set_gradient(pull);
    // Soft modes must not carry the inside further than the boundary goes.
    system.subproblem().step(reach, tuning.trial);
    Step step;
    for (double part : tuning.parts) {
      const Step candidate = system.subproblem().known_step(part * reach);
      std::vector<double> whole = delta;
      for (std::size_t d = 0; d < whole.size(); ++d) whole[d] += candidate.s[d];
      Iterate x;
      x.u = u;
      retract_to_boundary(system.layout, u, whole, boundary, x.u);
      system.evaluator.energy(x);
      if (!(x.energy < linear.x.energy)) continue;
      linear.x = std::move(x);
      step = candidate;
    }
    if (linear.x.energy < std::numeric_limits<double>::infinity()) {
      system.evaluator.gradient(linear.x);
      correct(system, linear.x, std::numeric_limits<double>::infinity(), step, tolerance);
    }
    // Where it is the boundary that disturbs an equilibrium, the solution is about as far as the boundary goes.
    if (start.gradient_norm < tuning.at_equilibrium * naive.x.gradient_norm) linear.radius = naive.radius = reach;
  }
  const bool better = linear.x.energy < std::numeric_limits<double>::infinity() && linear.x.energy <= naive.x.energy;
  return better ? std::move(linear) : std::move(naive);
}

}  // namespace karcher
