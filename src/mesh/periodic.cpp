#include "karcher/mesh/periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "karcher/error.hpp"
#include "karcher/mesh/incidence.hpp"
#include "karcher/mesh/node_key.hpp"
#include "karcher/mesh/place_text.hpp"
#include "karcher/mesh/union_find.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Entities that become one, by what they become.
using Copies = std::map<NodeKey, std::vector<const Cell*>>;

class Check {
 public:
  explicit Check(const Mesh& mesh) : mesh_(mesh) {
    for (const Vec3<double>& x : mesh.nodes) size_ = std::max(size_, std::sqrt(norm2(x - mesh.nodes.front())));
  }

  void all(const std::vector<PeriodicSide>& sides) const {
    for (const Cell& c : mesh_.cells) {
      const std::vector<int> first = first_copies(c);
      if (std::ranges::adjacent_find(first) != first.end())
        throw InputError(fmt::format("a cell at {} meets itself across the periodic sides{}", place(c.nodes[0]), three));
    }
    for (const auto& [key, cells] : copies(mesh_.cells))
      if (cells.size() > 1)
        throw InputError(fmt::format("the cells at {} and {} have the same vertices across the periodic sides{}", place(cells[0]->nodes[0]),
                                     place(cells[1]->nodes[0]), three));
    const std::vector<Cell> edges = mesh_.dim > 1 ? entities(mesh_, 1, false) : std::vector<Cell>();
    for (const auto& [key, same] : copies(edges))
      for (std::size_t i = 0; i < same.size(); ++i)
        for (std::size_t j = i + 1; j < same.size(); ++j)
          if (std::ranges::find_first_of(vertices(*same[i]), vertices(*same[j])) != vertices(*same[i]).end())
            throw InputError(fmt::format("two edges at {} become one across the periodic sides{}", place(same[i]->nodes[0]), three));
    const std::vector<Cell> boundary = boundary_facets(mesh_);
    std::set<NodeKey> known;
    for (const Cell& facet : boundary) known.insert(entity_key(vertices(facet)));
    for (const PeriodicSide& side : sides) {
      const std::map<int, int> originals(side.begin(), side.end());
      for (const Cell& facet : boundary) {
        std::vector<int> across;
        for (const int v : vertices(facet))
          if (const auto found = originals.find(v); found != originals.end()) across.push_back(found->second);
        if (across.size() < vertices(facet).size() || known.contains(entity_key(across))) continue;
        throw InputError(
            fmt::format("the periodic sides do not match: the vertices of a {} at {} are copies of others, but there is no {} between those.",
                        name(facet.kind), place(facet.nodes[0]), name(facet.kind)));
      }
    }
  }

 private:
  static constexpr const char* three = "; a periodic mesh needs at least three cells around.";

  std::string place(int node) const { return place_text(mesh_.nodes[at(node)], size_); }
  std::vector<int> first_copies(const Cell& c) const {
    std::vector<int> first;
    for (const int v : vertices(c)) first.push_back(mesh_.first_copies[at(v)]);
    std::ranges::sort(first);
    return first;
  }
  /// Of entities that touch a side.
  Copies copies(const std::vector<Cell>& list) const {
    std::vector<int> times(mesh_.nodes.size(), 0);
    for (const int first : mesh_.first_copies) ++times[at(first)];
    Copies found;
    for (const Cell& c : list) {
      const std::vector<int> first = first_copies(c);
      if (std::ranges::any_of(first, [&](int v) { return times[at(v)] > 1; })) found[entity_key(first)].push_back(&c);
    }
    return found;
  }

  const Mesh& mesh_;
  double size_ = 0;
};

}  // namespace

void join_nodes(Mesh& mesh, const std::vector<PeriodicSide>& sides) {
  std::vector<char> is_vertex(mesh.nodes.size(), 0);
  for (const Cell& c : mesh.cells)
    for (const int v : vertices(c)) is_vertex[at(v)] = 1;
  UnionFind sets(mesh.nodes.size());
  bool any = false;
  for (const PeriodicSide& side : sides)
    for (const auto& [a, b] : side)
      if (a != b && is_vertex[at(a)] && is_vertex[at(b)]) {
        sets.join(a, b);
        any = true;
      }
  if (!any) return;
  mesh.first_copies.resize(mesh.nodes.size());
  std::vector<int> first(mesh.nodes.size(), -1);  // of every set
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    int& f = first[at(sets.root(n))];
    if (f < 0) f = n;
    mesh.first_copies[at(n)] = f;
  }
  Check(mesh).all(sides);
}

}  // namespace karcher
