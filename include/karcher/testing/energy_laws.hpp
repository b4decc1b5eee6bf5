#pragma once
/// \file
/// The laws of an energy, for every Functional, yours included, on one rank: its gradient and its Hessian are its derivatives along the solver's own retraction.
///
///     for (const std::string& s : energy_laws(integral(space, Density{}).functional(u), u.values())) std::cerr << s << "\n";

#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/testing/derivative_checks.hpp"
#include "karcher/testing/random.hpp"

namespace karcher {

/// v . H v for the matrix of a layout of one rank.
inline double curvature(const BlockMatrix& h, const std::vector<double>& v) {
  const auto n = static_cast<std::size_t>(h.block_size);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < h.row_begin.size(); ++i)
    for (int k = h.row_begin[i]; k < h.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(h.column[static_cast<std::size_t>(k)]);
      const double* block = h.values.data() + static_cast<std::size_t>(k) * n * n;
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = 0; c < n; ++c) sum += (i == j ? 1 : 2) * v[i * n + r] * block[c * n + r] * v[j * n + c];
    }
  return sum;
}

/// E(retract(u, t v)) for a random v that does not move what is fixed: the slopes of Taylor's remainders in t.
/// \param largest  first t; nodes then move by up to this angle or length
inline TaylorSlopes taylor_slopes(const Functional& functional, const Configuration& u, std::uint64_t seed = 1, double largest = 0.1) {
  const Layout& layout = functional.layout();
  std::vector<double> v(static_cast<std::size_t>(layout.local_dofs())), g(v.size());
  Random random(seed);
  for (std::size_t d = 0; d < v.size(); ++d) v[d] = layout.fixed(static_cast<int>(d)) ? 0 : random.uniform(-1, 1);
  BlockMatrix h = functional.make_matrix();
  const double energy = functional.hessian(u, g, h).energy;
  double first = 0;
  for (std::size_t d = 0; d < v.size(); ++d) first += g[d] * v[d];
  const auto along = [&](double t) {
    std::vector<double> step = v;
    for (double& x : step) x *= t;
    Configuration moved = u;
    layout.retract(u, step, moved);
    return functional.energy(moved).energy;
  };
  return taylor_slopes(along, energy, first, curvature(h, v), largest);
}

/// A sentence for every law that does not hold at u or near it.
inline std::vector<std::string> energy_laws(const Functional& functional, const Configuration& u) {
  std::vector<std::string> broken;
  std::vector<double> g(static_cast<std::size_t>(functional.layout().local_dofs()));
  const Evaluation plain = functional.energy(u), with_gradient = functional.gradient(u, g);
  if (plain.failure) return {"The energy has no value: " + plain.failure->sentence()};
  if (!(std::abs(plain.energy - with_gradient.energy) <= 1e-12 * std::abs(plain.energy)))
    broken.push_back("The energy is another one when its gradient is asked for.");
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    if (const TaylorSlopes slopes = taylor_slopes(functional, u, seed); !slopes.hessian_holds()) broken.push_back(slopes.sentence() + ".");
  return broken;
}

}  // namespace karcher
