#include "solve/model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "karcher/solve/collectives.hpp"
#include "solve/seed.hpp"
#include "solve/stopwatch.hpp"

namespace karcher {
namespace {

template <std::size_t size>
void multiply_rows(const BlockMatrix& h, const double* x, double* y) {
  const std::size_t bs = size ? size : static_cast<std::size_t>(h.block_size);
  for (std::size_t i = 0; i + 1 < h.row_begin.size(); ++i) {
    const double* xi = x + i * bs;
    double* yi = y + i * bs;
    for (int k = h.row_begin[i]; k < h.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(h.column[static_cast<std::size_t>(k)]);
      const double* block = h.values.data() + static_cast<std::size_t>(k) * bs * bs;
      const double* xj = x + j * bs;
      double* yj = y + j * bs;
      for (std::size_t c = 0; c < bs; ++c) {
        for (std::size_t r = 0; r < bs; ++r) yi[r] += block[c * bs + r] * xj[c];
      }
      if (i == j) continue;
      for (std::size_t c = 0; c < bs; ++c) {
        double sum = 0;
        for (std::size_t r = 0; r < bs; ++r) sum += block[c * bs + r] * xi[r];
        yj[c] += sum;
      }
    }
  }
}

constexpr int longest_basis = 60;
constexpr int few = 3;  // missing directions that are worth a search
/// Of a residual, and of a vector after orthogonalisation, smaller parts than these are on their way to rounding. Taken as new directions they would let rounding
/// decide which way a structure buckles, which then differs from one number of ranks to another.
constexpr double smallest_residual = 1e-8, smallest_rest = 1e-5;

}  // namespace

void multiply(const Exchange& exchange, const BlockMatrix& h, std::span<const char> fixed, std::span<const double> x, std::span<double> y) {
  std::vector<double> masked(x.begin(), x.end());
  for (std::size_t d = 0; d < fixed.size(); ++d)
    if (fixed[d]) masked[d] = 0;
  std::fill(y.begin(), y.end(), 0.0);
  switch (h.block_size) {
    case 1:
      multiply_rows<1>(h, masked.data(), y.data());
      break;
    case 2:
      multiply_rows<2>(h, masked.data(), y.data());
      break;
    case 3:
      multiply_rows<3>(h, masked.data(), y.data());
      break;
    case 6:
      multiply_rows<6>(h, masked.data(), y.data());
      break;
    default:
      multiply_rows<0>(h, masked.data(), y.data());
  }
  exchange.sum(y);
  for (std::size_t d = 0; d < fixed.size(); ++d)
    if (fixed[d]) y[d] = 0;
}

TrustRegionModel::TrustRegionModel(const Exchange& exchange, Ldlt& ldlt, const std::vector<char>& fixed, const std::vector<double>& mass,
                                   const std::vector<std::uint64_t>& numbers, WorkCounts& work, PhaseSeconds& phases)
    : exchange_(exchange), ldlt_(ldlt), fixed_(fixed), mass_(mass), numbers_(numbers), work_(work), phases_(phases) {}

void TrustRegionModel::set(const BlockMatrix& h, std::span<const double> g, double shift) {
  h_ = &h;
  basis_.clear();
  h_basis_.clear();
  projected_h_.clear();
  eigen_ = {};
  counts_.clear();
  seed_ = 0;
  probe_ = -1;
  refactor(shift);
  set_gradient(g);
}

void TrustRegionModel::set_gradient(std::span<const double> g) {
  g_.assign(g.begin(), g.end());
  projected_g_ = against_basis(g_);
  has_steepest_ = false;
  double square = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(exchange_.owned_dofs()); ++d) square += g_[d] * g_[d] / mass_[d];
  dual_norm_ = std::sqrt(sum_over_ranks(square));
}

void TrustRegionModel::refactor(double shift) {
  Stopwatch watch(phases_.factorisation);
  ++work_.factorisations;
  shift_ = shift;
  inertia_ = ldlt_.factor(*h_, shift, mass_);
  counts_[shift] = inertia_.negative;
  searched_ = false;
}

void TrustRegionModel::solve(std::span<const double> b, std::span<double> x) {
  Stopwatch watch(phases_.solve);
  ++work_.solves;
  ldlt_.solve(b, x);
}

std::vector<double> TrustRegionModel::against_basis(std::span<const double> w) const {
  std::vector<double> products(basis_.size());
  const auto owned = static_cast<std::size_t>(exchange_.owned_dofs());
  for (std::size_t i = 0; i < basis_.size(); ++i) {
    double sum = 0;
    for (std::size_t d = 0; d < owned; ++d) sum += basis_[i][d] * w[d];
    products[i] = sum;
  }
  sum_over_ranks(products);
  return products;
}

bool TrustRegionModel::expand(std::vector<double> w) {
  Stopwatch watch(phases_.solve);
  const std::size_t n = w.size(), owned = static_cast<std::size_t>(exchange_.owned_dofs());
  std::vector<double> mw(n);
  const auto weigh = [&] {
    double square = 0;
    for (std::size_t d = 0; d < n; ++d) mw[d] = mass_[d] * w[d];
    for (std::size_t d = 0; d < owned; ++d) square += mw[d] * w[d];
    return std::sqrt(sum_over_ranks(square));
  };
  const double before = weigh();
  if (!(before > 0) || !std::isfinite(before)) return false;
  for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan, Parlett)
    const std::vector<double> products = against_basis(mw);
    for (std::size_t i = 0; i < basis_.size(); ++i)
      for (std::size_t d = 0; d < n; ++d) w[d] -= products[i] * basis_[i][d];
    if (weigh() < smallest_rest * before) return false;
  }
  const double size = weigh();
  for (double& x : w) x /= size;
  std::vector<double> hw(n);
  multiply(exchange_, *h_, fixed_, w, hw);
  basis_.push_back(std::move(w));
  h_basis_.push_back(std::move(hw));
  const std::vector<double> column = against_basis(h_basis_.back());
  projected_h_.insert(projected_h_.end(), column.begin(), column.end());
  projected_g_.push_back(exchange_.dot(basis_.back(), g_));

  eigen_ = symmetric_eigen(static_cast<int>(basis_.size()), projected_matrix());
  return true;
}

/// The upper triangle of V^T H V, column-major.
std::vector<double> TrustRegionModel::projected_matrix() const {
  const std::size_t m = basis_.size();
  std::vector<double> matrix(m * m, 0.0);
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i <= j; ++i) matrix[j * m + i] = projected_h_[j * (j + 1) / 2 + i];
  return matrix;
}

DenseStep TrustRegionModel::solve_in_basis(double radius, std::span<const double> across) const {
  if (across.empty()) return minimise_in_ball(eigen_, projected_g_, radius);
  // P B P + kappa a a^T / |a|^2 with P = I - a a^T / |a|^2 and a stiffness kappa that keeps the minimiser off a; the same for the gradient.
  const std::size_t m = basis_.size();
  std::vector<double> a(across.begin(), across.end()), matrix = projected_matrix(), ba(m, 0.0), g = projected_g_;
  a.resize(m, 0.0);
  double square = 0, aba = 0, ag = 0, trace = 0;
  for (std::size_t i = 0; i < m; ++i) square += a[i] * a[i];
  for (double& x : a) x /= std::sqrt(square);
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i < m; ++i) ba[i] += matrix[std::max(i, j) * m + std::min(i, j)] * a[j];
  for (std::size_t i = 0; i < m; ++i) {
    aba += a[i] * ba[i];
    ag += a[i] * g[i];
    trace += std::abs(matrix[i * m + i]);
  }
  for (std::size_t j = 0; j < m; ++j) {
    g[j] -= ag * a[j];
    for (std::size_t i = 0; i <= j; ++i) matrix[j * m + i] += (aba + trace) * a[i] * a[j] - a[i] * ba[j] - ba[i] * a[j];
  }
  return minimise_in_ball(symmetric_eigen(static_cast<int>(m), std::move(matrix)), g, radius);
}

std::vector<double> TrustRegionModel::combine(const std::vector<std::vector<double>>& vectors, std::span<const double> y) const {
  std::vector<double> result(g_.size(), 0.0);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    for (std::size_t d = 0; d < result.size(); ++d) result[d] += y[i] * vectors[i][d];
  return result;
}

TrustRegionModel::Step TrustRegionModel::step(double radius, const Effort& effort) {
  std::vector<double> w(g_.size()), r(g_.size());
  if (basis_.empty()) {
    if (dual_norm_ > 0) {
      solve(g_, w);
      expand(w);
    }
    // A symmetric gradient leads to symmetric directions alone.
    if (negative_in_basis() < inertia_.negative) probe();
  }
  DenseStep best;
  int expansions = 0, refactored = 0, small_gains = 0;
  bool dry = false;  // the last expansion added nothing
  for (double last = 0;; last = best.decrease) {
    best = solve_in_basis(radius, effort.across);
    if (basis_.empty() || static_cast<int>(basis_.size()) >= longest_basis) break;
    if (best.multiplier > 0 && !has_steepest_) {  // at least Cauchy's decrease
      has_steepest_ = true;
      for (std::size_t d = 0; d < w.size(); ++d) w[d] = g_[d] / mass_[d];
      if (expand(w)) continue;
    }
    const std::vector<double> s = combine(basis_, best.y), hs = combine(h_basis_, best.y);
    double square = 0;
    for (std::size_t d = 0; d < r.size(); ++d) r[d] = fixed_[d] ? 0 : g_[d] + hs[d] + best.multiplier * mass_[d] * s[d];
    for (std::size_t d = 0; d < static_cast<std::size_t>(exchange_.owned_dofs()); ++d) square += r[d] * r[d] / mass_[d];
    const double residual = std::sqrt(sum_over_ranks(square));
    small_gains = expansions > 0 && best.decrease - last <= effort.accuracy * best.decrease ? small_gains + 1 : 0;

    const int missing = missing_directions(best.multiplier);
    const bool solved = residual <= smallest_residual * dual_norm_;
    if (solved && missing <= 0) break;
    const bool stuck = small_gains >= 2 || solved || dry;
    if (stuck && missing <= 0 && residual <= 0.1 * dual_norm_) break;
    if (stuck && missing > 0 && !searched_ && (missing <= few || inertia_.negative == 0)) {
      find_negative_directions();
      small_gains = 0;
      dry = false;
      continue;
    }
    if (stuck || expansions == effort.expansions) {
      // A positive definite F tells no more when it has been searched, and larger shifts even less.
      if (refactored == effort.refactorisations || (missing > 0 && inertia_.negative == 0)) break;
      // At lambda the expansion converges fast, and directions of negative curvature that are missing are the first to appear. Where none is known, the
      // shift grows until their number falls.
      if (missing <= 0)
        refactor(best.multiplier);
      else if (negative_in_basis() > 0)
        refactor(std::max({1.5 * shift_, best.multiplier, -1.5 * eigen_.values.front()}));
      else
        refactor(shift_ > 0 ? 30 * shift_ : std::max(dual_norm_ / radius, 30 * std::abs(eigen_.values.front())));
      ++refactored;
      expansions = small_gains = 0;
    }
    if (solved) {
      dry = !probe();
    } else {
      solve(r, w);
      dry = !expand(w);
    }
    ++expansions;
  }
  return step_of(best);
}

TrustRegionModel::Step TrustRegionModel::step_in_basis(double radius, std::span<const double> across) const {
  return step_of(solve_in_basis(radius, across));
}

TrustRegionModel::Step TrustRegionModel::step_of(DenseStep dense) const {
  Step result;
  result.s = combine(basis_, dense.y);
  exchange_.update_ghosts(result.s);
  result.multiplier = dense.multiplier;
  result.decrease = dense.decrease;
  double square = 0;
  for (double y : dense.y) square += y * y;
  result.norm = std::sqrt(square);
  result.y = std::move(dense.y);
  return result;
}

int TrustRegionModel::negative_in_basis(double shift) const {
  return static_cast<int>(std::count_if(eigen_.values.begin(), eigen_.values.end(), [&](double e) { return e + shift < 0; }));
}

int TrustRegionModel::missing_directions(double lambda) const {
  const auto above = counts_.upper_bound(lambda);
  if (above == counts_.begin()) return 0;
  const auto [shift, count] = *std::prev(above);
  return count - negative_in_basis(shift);
}

void TrustRegionModel::find_negative_directions() {
  searched_ = true;
  const int limit = std::min(6 + 2 * inertia_.negative, 16);
  double lowest = eigen_.values.empty() ? 0 : std::min(0.0, eigen_.values.front());
  for (int k = 0; k < limit && static_cast<int>(basis_.size()) < longest_basis; ++k) {
    probe();
    if (basis_.empty()) return;
    const bool settled = eigen_.values.front() > 1.1 * lowest;
    if (negative_in_basis() >= inertia_.negative && settled) return;
    lowest = std::min(lowest, eigen_.values.front());
  }
}

bool TrustRegionModel::probe() {
  std::vector<double> w(g_.size());
  for (std::size_t d = 0; d < w.size(); ++d) {
    const double from = probe_ >= 0 ? basis_[static_cast<std::size_t>(probe_)][d] : seed_entry(seed_, numbers_[d]);
    w[d] = fixed_[d] ? 0 : mass_[d] * from;
  }
  solve(w, w);
  const bool expanded = expand(std::move(w));
  if (!expanded) ++seed_;
  probe_ = expanded ? static_cast<int>(basis_.size()) - 1 : -1;
  return expanded;
}

std::vector<double> TrustRegionModel::lowest_direction() const {
  if (basis_.empty()) return std::vector<double>(g_.size(), 0.0);
  return combine(basis_, std::span(eigen_.vectors).first(basis_.size()));
}

}  // namespace karcher
