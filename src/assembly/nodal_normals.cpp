#include "karcher/assembly/nodal_normals.hpp"

#include <fmt/format.h>

#include <cmath>

#include "karcher/error.hpp"
#include "karcher/mesh/orientation.hpp"

namespace karcher {

std::vector<Vec3<double>> nodal_normals(const Space& space, const Region& region, const ReferenceGeometry& reference,
                                        const std::vector<unsigned char>& mirrors) {
  constexpr double least = 1e-3;  // length of the mean of unit normals
  const Orientation orientation(space.mesh(), region);
  if (!orientation.exists())
    throw InputError(fmt::format("The surface \"{}\" has one side only, or three cells that meet in an edge: no field of directors is normal to it.",
                                 region.name));
  const auto count = static_cast<std::size_t>(space.node_count());
  std::vector<Vec3<double>> sum(count);
  std::vector<double> areas(count);
  for (const Cell& cell : region.cells) {
    const std::vector<int> nodes = space.entity_nodes(cell);
    const std::vector<GeometryJet> jets = reference.at(cell, lagrange_nodes(cell.kind, space.order()));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3<double> area = cross(jets[i].d[0], jets[i].d[1]);
      sum[static_cast<std::size_t>(nodes[i])] += orientation.sign(cell) * area;
      areas[static_cast<std::size_t>(nodes[i])] += std::sqrt(norm2(area));
    }
  }
  for (std::size_t n = 0; n < mirrors.size(); ++n)
    for (int i = 0; i < 3; ++i)
      if (mirrors[n] >> i & 1) sum[n][i] = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double length = std::sqrt(norm2(sum[n]));
    if (areas[n] == 0) continue;
    if (!(length > least * areas[n])) {
      const Vec3<double>& x = space.position(static_cast<int>(n));
      throw InputError(
          fmt::format("The normals of the cells around ({:.6g}, {:.6g}, {:.6g}) cancel: there is no normal director.", x[0], x[1], x[2]));
    }
    sum[n] = (1 / length) * sum[n];
  }
  return sum;
}

}  // namespace karcher
