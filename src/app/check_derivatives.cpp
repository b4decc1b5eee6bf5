#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/check_terms.hpp"
#include "app/term_at_random.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Largest relative errors of first and second derivative against central differences of the fourth order, with the best of some steps.
struct Errors {
  double gradient = std::numeric_limits<double>::infinity(), hessian = std::numeric_limits<double>::infinity();
  bool right = false, measured = false;
};

Errors errors(const DiscreteProblem& model, const Term& term, const Configuration& u, const Step& step) {
  const Along at = evaluate(term, u, &step);
  Errors e;
  if (!at.defined) return e;
  const auto over = [&](double size) { return size > 0 ? size : at.size > 0 ? at.size : 1.0; };
  double noise = 0;
  for (double h = 0.5; h > 1e-4; h /= 2) {
    std::array<double, 4> f{};
    bool defined = true;
    for (std::size_t k = 0; k < 4 && defined; ++k) {
      constexpr std::array<double, 4> times{-2, -1, 1, 2};
      const Along there = evaluate(term, moved(model, u, step, times[k] * h));
      f[k] = there.energy;
      noise = std::max({noise, epsilon * there.size, epsilon * at.size});
      defined = there.defined;
    }
    if (!defined) continue;
    e.measured = true;
    const double first = (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * h);
    const double second = (16 * (f[2] + f[1]) - (f[3] + f[0]) - 30 * at.energy) / (12 * h * h);
    e.gradient = std::min(e.gradient, std::abs(first - at.first) / over(at.first_size));
    e.hessian = std::min(e.hessian, std::abs(second - at.second) / over(at.second_size));
  }
  e.right = e.measured && e.gradient < 1e-7 + 1e3 * noise / over(at.first_size) && e.hessian < 1e-5 + 1e4 * noise / over(at.second_size);
  return e;
}

}  // namespace

bool check_derivatives(const DiscreteProblem& model) {
  std::mt19937 random(20240611);
  const Configuration u = near_the_start(model, random);
  const Step step = random_step(model, 0.05, random);
  fmt::print("\nderivatives: relative errors against differences of the energy, at random values near the initial ones\n");
  fmt::print("  {:<24} {:>12} {:>12}\n", "", "gradient", "Hessian");
  std::vector<std::string> wrong, unknown;
  for (std::size_t k = 0; k < model.term_names.size(); ++k) {
    const Errors e = errors(model, *model.functional->terms()[k], u, step);
    if (!e.measured)
      fmt::print("  {:<24} {:>12} {:>12}\n", model.term_names[k], "not defined", "");
    else
      fmt::print("  {:<24} {:>12.2e} {:>12.2e}{}\n", model.term_names[k], e.gradient, e.hessian, e.right ? "" : "  wrong");
    if (!e.right) (e.measured ? wrong : unknown).push_back(model.term_names[k]);
  }
  if (!unknown.empty()) fmt::print("the derivatives of {} cannot be checked: there is no energy near the initial values\n", listed(unknown));
  if (!wrong.empty()) fmt::print("gradient or Hessian of {} is wrong\n", listed(wrong));
  if (unknown.empty() && wrong.empty()) fmt::print("gradient and Hessian are right\n");
  return unknown.empty() && wrong.empty();
}

}  // namespace karcher::app
