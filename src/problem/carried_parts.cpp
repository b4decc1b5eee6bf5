#include "karcher/problem/carried_parts.hpp"

namespace karcher {
namespace {

void add(const Space& space, const Cell& entity, std::vector<Cell>& parts) {
  if (!space.entity_nodes(entity).empty()) {
    parts.push_back(entity);
    return;
  }
  for (std::size_t f = 0; f < facets(entity.kind).size(); ++f) {
    Cell facet{facets(entity.kind)[f].kind, entity.order, {}, {}};
    for (const int n : facet_nodes(entity.kind, entity.order, static_cast<int>(f))) facet.nodes.push_back(entity.nodes[static_cast<std::size_t>(n)]);
    add(space, facet, parts);
  }
}

}  // namespace

std::vector<Cell> carried_parts(const Space& space, const Region& region) {
  std::vector<Cell> parts;
  for (const Cell& entity : region.cells) add(space, entity, parts);
  return parts;
}

}  // namespace karcher
