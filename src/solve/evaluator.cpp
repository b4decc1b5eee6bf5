#include "solve/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "karcher/solve/collectives.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/stopwatch.hpp"

namespace karcher {

Evaluator::Evaluator(Functional& functional, const Exchange& exchange, const std::vector<char>& fixed, const std::vector<double>& mass, double noise,
                     WorkCounts& work, PhaseSeconds& phases)
    : functional_(functional), exchange_(exchange), fixed_(fixed), mass_(mass), noise_(noise), work_(work), phases_(phases) {}

void Evaluator::set_proximal(const Configuration& centre, double tau) {
  tau_ = tau;
  if (tau == 0) return;
  centre_ = centre;
  if (nodal_mass_.empty())
    for (const Field& field : functional_.layout().fields()) nodal_mass_.push_back(lumped_mass(*field.space));
}

double Evaluator::proximal(const Configuration& u, std::span<double> g, BlockMatrix* h) const {
  const Layout& layout = functional_.layout();
  const auto bs = static_cast<std::size_t>(layout.block_size());
  double energy = 0;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const ManifoldOps& manifold = *layout.fields()[static_cast<std::size_t>(f)].manifold;
    const auto ambient = static_cast<std::size_t>(manifold.ambient), dim = static_cast<std::size_t>(manifold.dim);
    std::vector<double> frame(ambient * dim), column(ambient), a(ambient);
    for (int node : layout.local_nodes(f)) {
      if (!layout.owns(f, node)) continue;
      const double weight = nodal_mass_[static_cast<std::size_t>(f)][static_cast<std::size_t>(node)] / tau_;
      const double *p = u.at(f, node, manifold.ambient), *c = centre_.at(f, node, manifold.ambient);
      const double distance = manifold.dist(p, c);
      energy += 0.5 * weight * distance * distance;
      manifold.log(p, c, a.data());
      manifold.frame(p, frame.data());
      const auto first = static_cast<std::size_t>(layout.first_dof(f, node));
      for (std::size_t k = 0; k < dim; ++k) {
        for (std::size_t i = 0; i < ambient; ++i) column[i] = frame[i * dim + k];
        if (!g.empty()) g[first + k] -= weight * manifold.inner(p, column.data(), a.data());
        if (!h) continue;
        // The Hessian of 1/2 dist^2 is the identity up to curvature times dist^2. The diagonal block is the first of its row.
        const std::size_t row = (first + k) / bs, inside = (first + k) % bs;
        h->values[static_cast<std::size_t>(h->row_begin[row]) * bs * bs + inside * bs + inside] += weight;
      }
    }
  }
  return energy;
}

void Evaluator::finish_energy(Iterate& x, const Evaluation& local, double proximal_energy) {
  x.failure = first_text(local.failure ? local.failure->sentence() : "");
  std::vector<double> sums = local.terms;
  sums.push_back(proximal_energy);
  sum_over_ranks(sums);
  x.energy = 0;
  x.noise = 0;
  for (double e : sums) {
    x.energy += e;
    x.noise += noise_ * std::abs(e);
  }
  sums.pop_back();
  x.terms = std::move(sums);
  if (x.ok() && !std::isfinite(x.energy)) x.failure = "The sum of the energies is no finite number.";
  if (!x.ok()) x.energy = x.gradient_norm = std::numeric_limits<double>::infinity();
}

void Evaluator::finish(Iterate& x, const Evaluation& local, double proximal_energy) {
  finish_energy(x, local, proximal_energy);
  if (!x.ok()) return;
  exchange_.sum(x.g);
  double square = 0;
  for (std::size_t d = 0; d < x.g.size(); ++d) {
    if (fixed_[d]) x.g[d] = 0;
    if (d < static_cast<std::size_t>(exchange_.owned_dofs())) square += x.g[d] * x.g[d] / mass_[d];
  }
  x.gradient_norm = std::sqrt(sum_over_ranks(square));
  if (std::isfinite(x.gradient_norm)) return;
  x.failure = fmt::format("The derivative of the energy is too large to be squared; the largest one is {}.", largest_entry(x.g));
  x.energy = x.gradient_norm = std::numeric_limits<double>::infinity();
}

std::string Evaluator::largest_entry(std::span<const double> v) const {
  const Layout& layout = functional_.layout();
  const auto size = [](double x) { return std::isnan(x) ? std::numeric_limits<double>::infinity() : std::abs(x); };
  double largest = -1;
  for (double x : v.first(static_cast<std::size_t>(exchange_.owned_dofs()))) largest = std::max(largest, size(x));
  largest = max_over_ranks(largest);
  std::string place;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const Field& field = layout.fields()[static_cast<std::size_t>(f)];
    for (int node : layout.local_nodes(f))
      for (int k = 0; k < field.manifold->dim && layout.owns(f, node) && place.empty(); ++k) {
        const double x = v[static_cast<std::size_t>(layout.first_dof(f, node) + k)];
        const Vec3<double>& at = field.space->position(node);
        if (size(x) == largest)
          place = fmt::format("{:.3g} at the node ({:.6g}, {:.6g}, {:.6g}) of the field \"{}\"", x, at[0], at[1], at[2], field.name);
      }
  }
  return first_text(place);
}

void Evaluator::energy(Iterate& x) {
  Stopwatch watch(phases_.assembly);
  ++work_.energies;
  const Evaluation local = functional_.energy(x.u);
  finish_energy(x, local, tau_ > 0 ? proximal(x.u, {}, nullptr) : 0.0);
}

void Evaluator::gradient(Iterate& x) {
  Stopwatch watch(phases_.assembly);
  ++work_.gradients;
  x.g.resize(static_cast<std::size_t>(exchange_.local_dofs()));
  const Evaluation local = functional_.gradient(x.u, x.g);
  finish(x, local, tau_ > 0 ? proximal(x.u, x.g, nullptr) : 0.0);
}

void Evaluator::hessian(Iterate& x, BlockMatrix& h) {
  Stopwatch watch(phases_.assembly);
  ++work_.hessians;
  x.g.resize(static_cast<std::size_t>(exchange_.local_dofs()));
  const Evaluation local = functional_.hessian(x.u, x.g, h);
  finish(x, local, tau_ > 0 ? proximal(x.u, x.g, &h) : 0.0);
}

}  // namespace karcher
