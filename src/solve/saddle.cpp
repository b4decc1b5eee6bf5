#include "solve/saddle.hpp"

#include <cmath>

namespace karcher {

std::optional<Iterate> escape_saddle(System& system, const Iterate& saddle) {
  const SolverTuning& tuning = system.tuning;
  system.subproblem().find_negative_directions();
  std::vector<double> direction = system.subproblem().lowest_direction();
  system.exchange.update_ghosts(direction);
  const double slope = system.exchange.dot(direction, saddle.g);
  std::optional<Iterate> best;
  double least = saddle.energy - tuning.significant * (saddle.noise + system.rounding().energy);
  for (double length = slope > 0 ? -tuning.escape_from : tuning.escape_from; std::abs(length) < tuning.escape_up_to; length *= 2) {
    std::vector<double> s = direction;
    for (double& x : s) x *= length;
    Iterate x = system.moved(saddle.u, s);
    if (x.ok() && x.energy < least) {
      least = x.energy;
      best = std::move(x);
    } else if (best) {
      break;
    }
  }
  return best;
}

}  // namespace karcher
