#pragma once
// Energies of a cell for SmallProblem, and what records a solver's telling.

#include <cmath>
#include <vector>

#include "karcher/solve/report.hpp"
#include "solve/small_problem.hpp"

namespace karcher::testing {

/// Chained Rosenbrock function: sum over cells of 100 (b - a^2)^2 + (1 - a)^2.
inline CellValue rosenbrock(const std::vector<const double*>& u, const Vec3<double>&, double, double* g, double* h) {
  const double a = *u[0], b = *u[1], r = b - a * a;
  if (g) {
    g[0] = -400 * a * r - 2 * (1 - a);
    g[1] = 200 * r;
  }
  if (h) {
    h[0] = -400 * r + 800 * a * a + 2;
    h[1] = h[2] = -400 * a;
    h[3] = 200;
  }
  return {100 * r * r + (1 - a) * (1 - a)};
}

/// 1/2 u.A u on S^2 at both nodes of a cell, A = diag(1, 2, 4): critical points are the eigenvectors, the energy is half the eigenvalue. The Hessian of
/// the pullback through exp is E^T A E - (u.A u) I.
inline CellValue rayleigh(const std::vector<const double*>& u, const Vec3<double>&, double, double* g, double* h) {
  const double eigenvalues[] = {1, 2, 4};
  const ManifoldOps& sphere = manifold_by_name("S2");
  double energy = 0;
  for (std::size_t node = 0; node < 2; ++node) {
    double frame[6], twice = 0;
    sphere.frame(u[node], frame);
    for (int i = 0; i < 3; ++i) twice += eigenvalues[i] * u[node][i] * u[node][i];
    energy += 0.5 * twice;
    for (std::size_t k = 0; k < 2; ++k) {
      double slope = 0;
      for (std::size_t i = 0; i < 3; ++i) slope += frame[i * 2 + k] * eigenvalues[i] * u[node][i];
      if (g) g[node * 2 + k] = slope;
      for (std::size_t l = 0; h && l < 2; ++l) {
        double c = k == l ? -twice : 0.0;
        for (std::size_t i = 0; i < 3; ++i) c += frame[i * 2 + k] * eigenvalues[i] * frame[i * 2 + l];
        h[(node * 2 + k) * 4 + node * 2 + l] = c;
      }
    }
  }
  return {energy};
}

/// Sum over cells of 1/2 (b - a - t)^2, infinite where b - a > 1.8.
inline CellValue springs(const std::vector<const double*>& u, const Vec3<double>&, double t, double* g, double* h) {
  const double r = *u[1] - *u[0] - t;
  if (g) {
    g[0] = -r;
    g[1] = r;
  }
  if (h) {
    h[0] = h[3] = 1;
    h[1] = h[2] = -1;
  }
  if (*u[1] - *u[0] > 1.8) return {INFINITY, Trouble::infinite_energy};
  return {0.5 * r * r};
}

/// Flags that fix both ends of [0, cells], wherever the space has put their nodes.
inline std::vector<char> fixed_ends(int cells) {
  const auto mesh = line_mesh(cells);
  const Space space(mesh, mesh->regions.at("all"), 1);
  std::vector<char> fixed;
  for (int node = 0; node <= cells; ++node) fixed.push_back(space.position(node)[0] < 0.5 || space.position(node)[0] > cells - 0.5);
  return fixed;
}

struct Recorder : Observer {
  std::vector<IterationRecord> records;
  std::vector<StepReport> steps;
  std::vector<double> begun;
  void load_step_begins(int, double t) override { begun.push_back(t); }
  void iteration(const IterationRecord& r) override { records.push_back(r); }
  void load_step_finished(const StepReport& r, const Configuration&) override { steps.push_back(r); }
};

}  // namespace karcher::testing
