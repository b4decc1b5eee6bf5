#include "solve/subspace.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "karcher/solve/collectives.hpp"
#include "solve/multiply.hpp"
#include "solve/tuning.hpp"

namespace karcher {

Subspace::Subspace(const SubproblemInput& input) : exchange_(input.exchange), fixed_(input.fixed), mass_(input.mass), tuning_(input.tuning) {}

void Subspace::set_matrix(const BlockMatrix& h) {
  h_ = &h;
  basis_.clear();
  h_basis_.clear();
  projected_h_.clear();
  projected_g_.clear();
  spectrum_ = {};
}

void Subspace::set_gradient(std::span<const double> g) {
  g_.assign(g.begin(), g.end());
  projected_g_ = against_basis(g_);
}

std::vector<double> Subspace::against_basis(std::span<const double> w) const {
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

bool Subspace::expand(std::vector<double> w) {
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
  for (int pass = 0; pass < tuning_.orthogonalisations; ++pass) {
    const std::vector<double> products = against_basis(mw);
    for (std::size_t i = 0; i < basis_.size(); ++i)
      for (std::size_t d = 0; d < n; ++d) w[d] -= products[i] * basis_[i][d];
    if (weigh() < tuning_.smallest_rest * before) return false;
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

  spectrum_ = same_on_all_ranks(this->size(), projected_matrix());
  return true;
}

Spectrum Subspace::same_on_all_ranks(int n, std::vector<double> matrix) {
  Spectrum spectrum = symmetric_eigen(n, std::move(matrix));
  take_from_first_rank(spectrum.values);
  take_from_first_rank(spectrum.vectors);
  return spectrum;
}

std::vector<double> Subspace::projected_matrix() const {
  const std::size_t m = basis_.size();
  std::vector<double> matrix(m * m, 0.0);
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i <= j; ++i) matrix[j * m + i] = projected_h_[j * (j + 1) / 2 + i];
  return matrix;
}

DenseStep Subspace::minimise(double radius, std::span<const double> across) const {
  if (across.empty()) return minimise_in_ball(spectrum_, projected_g_, radius);
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
  return minimise_in_ball(same_on_all_ranks(static_cast<int>(m), std::move(matrix)), g, radius);
}

std::vector<double> Subspace::combine(const std::vector<std::vector<double>>& vectors, std::span<const double> y) const {
  std::vector<double> result(g_.size(), 0.0);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    for (std::size_t d = 0; d < result.size(); ++d) result[d] += y[i] * vectors[i][d];
  return result;
}

Step Subspace::step_of(DenseStep dense) const {
  Step result;
  result.s = combine(dense.y);
  exchange_.update_ghosts(result.s);
  result.multiplier = dense.multiplier;
  result.decrease = dense.decrease;
  double square = 0;
  for (double y : dense.y) square += y * y;
  result.norm = std::sqrt(square);
  result.coordinates = std::move(dense.y);
  return result;
}

}  // namespace karcher
