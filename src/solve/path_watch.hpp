#pragma once
/// \file
/// PathWatch: whether the states of load steps lie on one path. A structure that snaps through jumps to another one, and its state is then far from where the
/// states before point.

#include <span>
#include <string>
#include <vector>

#include "karcher/field/layout.hpp"
#include "solve/tuning.hpp"

namespace karcher {

class PathWatch {
 public:
  /// \param mass  step_mass(layout)
  PathWatch(const Layout& layout, std::vector<double> mass, const SolverTuning& tuning) : layout_(layout), mass_(std::move(mass)), tuning_(tuning) {}

  /// The next state; u.t differs from that of the last one. \returns a sentence if it is more than SolverTuning::jump times as far from its linear extrapolation
  /// as any state before (by the square of the increment of t), and farther than all of them have moved for such an increment; else nothing. Silent as long as no state has moved
  /// (a load that sets in later). Collective.
  std::string next(const Configuration& u);

 private:
  double length(const Configuration& difference) const;

  const Layout& layout_;
  const std::vector<double> mass_;
  const SolverTuning& tuning_;
  Configuration last_, rate_;  ///< no values: not known
  double fastest_ = 0;         ///< largest |rate|
  double most_bent_ = 0;       ///< largest |state - extrapolation| / increment^2
  int bends_ = 0;              ///< how many are in it
};

}  // namespace karcher
