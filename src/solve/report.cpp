#include "karcher/solve/report.hpp"

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

}  // namespace karcher
