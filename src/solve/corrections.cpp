#include "solve/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karcher {
namespace {

struct Correction {
  Iterate x;
  double length = 0;
};

/// Tangent coordinates at x are taken for those where the matrix was made: for body frames the natural transport, and in any case the energy decides. Soft
/// directions, for which the old matrix is wrong, must not spoil what the stiff ones gain; so of the corrections that one basis has to offer, shorter or longer,
/// across the step or not, the best is taken.
Correction best_correction(System& system, const Iterate& x, const Step& step, const Step& whole, double reach, bool tiny) {
  Correction best;
  best.x.energy = std::numeric_limits<double>::infinity();
  for (double part : system.tuning.parts)
    for (bool across : {false, true}) {
      if (tiny && (across || part < 1)) continue;
      const Step candidate = part == 1 && !across ? whole : system.subproblem().known_step(part * reach, across ? &step : nullptr);
      if (part < 1 && !across && whole.norm <= part * reach) continue;
      Iterate y;
      y.u = x.u;
      system.layout.retract(x.u, candidate.s, y.u);
      system.evaluator.energy(y);
      if (y.energy < best.x.energy) best = {std::move(y), candidate.norm};
    }
  return best;
}

}  // namespace

void correct(System& system, Iterate& x, double base_energy, const Step& step, double tolerance) {
  const SolverTuning& tuning = system.tuning;
  double total = std::max(0.0, std::isfinite(base_energy) ? base_energy - x.energy : 0.0);
  double reach = step.norm;
  for (int k = 0; k < system.options.max_corrections && x.gradient_norm > tolerance; ++k) {
    system.subproblem().set_gradient(x.g);
    const Step whole = system.subproblem().step(reach, tuning.correction);
    const double significant = system.significant(x, whole.s);
    const bool tiny = whole.decrease <= significant;
    Correction next = best_correction(system, x, step, whole, reach, tiny);
    const double gain = x.energy - next.x.energy;
    if (!next.x.ok() || !(gain > (tiny ? -significant : 0.0))) break;
    system.evaluator.gradient(next.x);
    const bool steadier = next.x.gradient_norm <= tuning.steadier * x.gradient_norm;
    if (!next.x.ok() || (tiny && !steadier)) break;
    x = std::move(next.x);
    total += gain;
    if (gain < tuning.correction_share * total && !steadier) break;
    reach = std::min(step.norm, tuning.correction_growth * next.length);
  }
}

}  // namespace karcher
