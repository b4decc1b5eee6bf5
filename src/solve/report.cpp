#include "karcher/solve/report.hpp"

#include <fmt/format.h>

#include <ostream>

namespace karcher {

std::string_view name(Status s) {
  switch (s) {
    case Status::converged:
      return "converged";
    case Status::not_converged:
      return "not-converged";
    case Status::interrupted:
      return "interrupted";
    case Status::failed:
      break;
  }
  return "failed";
}

WorkCounts& WorkCounts::operator+=(const WorkCounts& other) {
  factorisations += other.factorisations;
  hessians += other.hessians;
  gradients += other.gradients;
  energies += other.energies;
  solves += other.solves;
  return *this;
}

PhaseSeconds& PhaseSeconds::operator+=(const PhaseSeconds& other) {
  assembly += other.assembly;
  factorisation += other.factorisation;
  solve += other.solve;
  return *this;
}

std::ostream& operator<<(std::ostream& out, const StepReport& r) {
  return out << fmt::format("energy {:.13g}, {} after {} iteration{}: {}", r.energy, name(r.status), r.iterations, r.iterations == 1 ? "" : "s",
                            r.reason);
}

}  // namespace karcher
