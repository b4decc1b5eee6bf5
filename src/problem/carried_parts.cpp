#include "karcher/problem/carried_parts.hpp"

namespace karcher {
namespace {

void add(const Space& space, const Cell& entity, std::vector<Cell>& parts) {
  if (!space.entity_nodes(entity).empty()) {
    parts.push_back(entity);
    return;
  }
  for (int f = 0; f < static_cast<int>(facets(entity.kind).size()); ++f) add(space, facet(entity, f), parts);
}

}  // namespace

std::vector<Cell> carried_parts(const Space& space, const Region& region) {
  std::vector<Cell> parts;
  for (const Cell& entity : region.cells) add(space, entity, parts);
  return parts;
}

}  // namespace karcher
