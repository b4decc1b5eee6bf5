#include "karcher/problem/mirror_planes.hpp"

#include "karcher/problem/carried_parts.hpp"

namespace karcher {

std::vector<unsigned char> mirror_planes(const Problem& problem, int field, const Space& space) {
  std::vector<unsigned char> planes(static_cast<std::size_t>(space.node_count()), 0);
  for (const DirichletSpec& spec : problem.dirichlet) {
    if (spec.field != field || spec.normal < 0 || !space.mesh().regions.contains(spec.on)) continue;
    for (const Cell& entity : carried_parts(space, space.mesh().region(spec.on)))
      for (const int node : space.entity_nodes(entity)) planes[static_cast<std::size_t>(node)] |= static_cast<unsigned char>(1U << spec.normal);
  }
  return planes;
}

}  // namespace karcher
