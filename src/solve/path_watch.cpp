#include "solve/path_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/solve/collectives.hpp"

namespace karcher {
namespace {

/// a + factor b in ambient coordinates.
Configuration sum(const Configuration& a, double factor, const Configuration& b) {
  Configuration result = a;
  for (std::size_t f = 0; f < a.values.size(); ++f)
    for (std::size_t i = 0; i < a.values[f].size(); ++i) result.values[f][i] += factor * b.values[f][i];
  return result;
}

}  // namespace

/// In the norm of steps, with the ambient coordinates of a node in place of its tangent coordinates.
double PathWatch::length(const Configuration& difference) const {
  double square = 0;
  for (int f = 0; f < static_cast<int>(layout_.fields().size()); ++f) {
    const int ambient = layout_.fields()[static_cast<std::size_t>(f)].manifold->ambient;
    for (const int node : layout_.local_nodes(f)) {
      if (!layout_.owns(f, node)) continue;
      const double* x = difference.at(f, node, ambient);
      for (int i = 0; i < ambient; ++i) square += mass_[static_cast<std::size_t>(layout_.first_dof(f, node))] * x[i] * x[i];
    }
  }
  return std::sqrt(sum_over_ranks(square));
}

std::string PathWatch::next(const Configuration& u) {
  std::string sentence;
  if (last_.values.empty()) {
    last_ = u;
    return sentence;
  }
  const double increment = u.t - last_.t;
  Configuration rate = sum(u, -1.0, last_);
  if (!rate_.values.empty()) {
    const double off = length(sum(rate, -increment, rate_)), expected = most_bent_ * increment * increment, reach = fastest_ * std::abs(increment);
    if (bends_ > 0 && fastest_ > 0 && off > tuning_.jump * expected && off > reach)
      sentence = fmt::format(
          "the path may have jumped between t = {:.6g} and t = {:.6g}: the state is {}. Smaller load steps tell a jump (snap-through, buckling) from "
          "a bend",
          last_.t, u.t,
          expected > 0 ? fmt::format("{:.3g} times as far from where the load steps before point as any of theirs was", off / expected)
                       : std::string("not where the load steps before, on a straight path, point"));
    else
      most_bent_ = std::max(most_bent_, off / (increment * increment));
    ++bends_;
  }
  last_ = u;
  if (!sentence.empty()) {
    rate_.values.clear();
    return sentence;
  }
  for (std::vector<double>& values : rate.values)
    for (double& x : values) x /= increment;
  fastest_ = std::max(fastest_, length(rate));
  rate_ = std::move(rate);
  return sentence;
}

}  // namespace karcher
