#include "karcher/solve/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "karcher/solve/collectives.hpp"

namespace karcher {
namespace {

/// Largest cut ratio of two of the points. Those that are nearer to the first one than half of `known` cannot be farther from each other than that.
double largest_ratio(const ManifoldOps& m, const std::vector<const double*>& points, double known) {
  double from_first = 0;
  for (const double* p : points) from_first = std::max(from_first, m.cut_ratio(points.front(), p));
  if (2 * from_first <= known) return 0;
  double largest = from_first;
  for (std::size_t i = 1; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) largest = std::max(largest, m.cut_ratio(points[i], points[j]));
  return largest;
}

}  // namespace

Spread widest_spread(const Layout& layout, const Configuration& u) {
  Spread widest;
  std::vector<const double*> points;
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f) {
    const Field& field = layout.fields()[static_cast<std::size_t>(f)];
    const ManifoldOps& m = *field.manifold;
    if (m.linear) continue;
    const std::vector<Cell>& cells = field.space->region().cells;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (layout.ranks() > 1 && layout.cell_rank(cells[c]) != layout.rank()) continue;
      points.clear();
      for (const int node : field.space->cell_nodes(static_cast<int>(c))) points.push_back(u.at(f, node, m.ambient));
      const double ratio = largest_ratio(m, points, widest.ratio);
      if (!(ratio > widest.ratio)) continue;
      const Vec3<double> x = middle(field.space->mesh(), cells[c]);
      const double degrees = 180 / std::numbers::pi * m.injectivity_radius;
      widest = {
          ratio,
          fmt::format("the values of the field \"{}\" differ by {:.0f} of at most {:.0f} degrees within the cell around ({:.4g}, {:.4g}, {:.4g})",
                      field.name, ratio * degrees, degrees, x[0], x[1], x[2])};
    }
  }
  const double ratio = max_over_ranks(widest.ratio);
  return {ratio, first_text(widest.ratio == ratio ? widest.sentence : "")};
}

}  // namespace karcher
