#include "solve/excursion.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "karcher/solve/collectives.hpp"

namespace karcher {

double diameters_moved(const Functional& functional, const Configuration& from, const Configuration& to) {
  std::set<int> moving;
  for (const auto& term : functional.terms()) moving.insert(term->info().moving.begin(), term->info().moving.end());
  double farthest = 0;
  for (const int f : moving) {
    const Field& field = functional.layout().fields()[static_cast<std::size_t>(f)];
    const int n = field.manifold->ambient;
    const double size = diagonal(field.space->mesh());
    for (const int node : functional.layout().local_nodes(f)) {
      double square = 0;
      for (int i = 0; i < n; ++i) square += std::pow((to.at(f, node, n)[i] - from.at(f, node, n)[i]) / size, 2);
      farthest = std::max(farthest, std::sqrt(square));
    }
  }
  return moving.empty() ? 0 : max_over_ranks(farthest);
}

}  // namespace karcher
