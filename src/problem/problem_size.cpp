#include "problem/problem_size.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "karcher/mesh/mesh_size.hpp"

namespace karcher {

void require_room(const Problem& problem, const Mesh& coarse) {
  const double children = std::pow(2.0, coarse.dim * problem.mesh.refine);
  std::map<std::pair<CellKind, int>, double> kinds;
  for (const Cell& c : coarse.cells) kinds[{c.kind, c.order}] += children;
  MeshSize whole;
  const auto add = [](MeshSize& sum, const MeshSize& s) {
    sum.cells += s.cells;
    sum.nodes += s.nodes;
    sum.bytes += s.bytes;
  };
  for (const auto& [kind, cells] : kinds) add(whole, mesh_size(kind.first, kind.second, cells));
  const std::string name = problem.mesh.refine > 0 ? fmt::format("The mesh, refined {} times,", problem.mesh.refine) : "The mesh";
  require_room(whole, name);

  double bytes = whole.bytes;
  for (const FieldSpec& field : problem.fields) {
    if (field.on != "all") continue;
    MeshSize space;
    double couplings = 0;
    for (const auto& [kind, cells] : kinds) {
      const int order = field.order > 0 ? field.order : kind.second;
      const MeshSize own = mesh_size(kind.first, order, cells);
      add(space, own);
      couplings += 0.5 * own.nodes * node_count(kind.first, order);
      bytes += cells * (40 + 4.0 * node_count(kind.first, order));  // the nodes of every cell
    }
    require_room(space, fmt::format("{} with the field \"{}\"", name, field.name));
    // A node: its key, place and values; the upper triangle of the Hessian, once.
    bytes += space.nodes * (150 + 16.0 * field.manifold->ambient) + 8.0 * couplings * field.manifold->dim * field.manifold->dim;
  }
  require_memory(bytes, fmt::format("{} of about {:.3g} cells with its fields", name, whole.cells));
}

}  // namespace karcher
