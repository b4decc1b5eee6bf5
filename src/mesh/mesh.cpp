#include "karcher/mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "karcher/error.hpp"
#include "karcher/mesh/incidence.hpp"
#include "karcher/mesh/node_key.hpp"
#include "karcher/text.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A sub-entity of a cell by local numbers.
struct Part {
  const Cell& cell;
  CellKind kind;
  std::span<const int> vertices, nodes;
};

/// The trace of the cell on the part.
Cell trace(const Part& part) {
  Cell entity;
  entity.kind = part.kind;
  entity.order = part.kind == CellKind::vertex ? 1 : part.cell.order;
  entity.nodes.reserve(part.nodes.size());
  for (int n : part.nodes) entity.nodes.push_back(part.cell.nodes[at(n)]);
  if (!part.cell.parameters.empty())
    for (int v : part.vertices) entity.parameters.push_back(part.cell.parameters[at(v)]);
  return entity;
}

NodeKey part_key(const Part& part) {
  std::array<int, 8> vertices{};
  for (std::size_t v = 0; v < part.vertices.size(); ++v) vertices[v] = part.cell.nodes[at(part.vertices[v])];
  return entity_key(std::span<const int>(vertices).first(part.vertices.size()));
}

/// The distinct ones among the parts that `visit` passes on, in the order of their first appearance, and how often each appeared.
struct Distinct {
  std::vector<Cell> entities;
  std::vector<int> times;
};
template <class Visit>
Distinct distinct(std::size_t expected, Visit visit) {
  Distinct result;
  NodeNumbering numbering(expected);
  visit([&](const Part& part) {
    const auto found = numbering.insert(part_key(part));
    if (found.inserted) {
      result.entities.push_back(trace(part));
      result.times.push_back(0);
    }
    ++result.times[at(found.number)];
  });
  return result;
}

Part facet_part(const Cell& c, int f) {
  const ReferenceFace& face = facets(c.kind)[at(f)];
  return {c, face.kind, face.vertices, facet_nodes(c.kind, c.order, f)};
}

Distinct distinct_facets(const std::vector<Cell>& cells) {
  return distinct(2 * cells.size(), [&](auto pass) {
    for (const Cell& c : cells)
      for (int f = 0; f < static_cast<int>(facets(c.kind).size()); ++f) pass(facet_part(c, f));
  });
}

std::vector<Cell> distinct_vertices(const std::vector<Cell>& cells) {
  return distinct(cells.size(),
                  [&](auto pass) {
                    for (const Cell& c : cells)
                      for (int v = 0; v < vertex_count(c.kind); ++v) {
                        const std::array<int, 1> local = {v};
                        pass(Part{c, CellKind::vertex, local, local});
                      }
                  })
      .entities;
}

/// Distinct sub-entities of lower dimension, through chains of facets.
std::vector<Cell> sub_entities(std::vector<Cell> cells, int dim, int target) {
  if (target == 0) return distinct_vertices(cells);
  for (; dim > target; --dim) cells = distinct_facets(cells).entities;
  return cells;
}

}  // namespace

int Mesh::order() const {
  int highest = 1;
  for (const Cell& c : cells) highest = std::max(highest, c.order);
  return highest;
}

const Region& Mesh::region(const std::string& region_name) const {
  const auto it = regions.find(region_name);
  if (it != regions.end()) return it->second;
  if (const auto reason = left_out.find(region_name); reason != left_out.end()) throw InputError(reason->second);
  std::vector<std::string> names;
  for (const auto& entry : regions) names.push_back(entry.first);
  throw InputError("There is no region \"" + region_name + "\" in the mesh. " + suggestion(region_name, names, "Regions"));
}

Vec3<double> middle(const Mesh& mesh, const Cell& cell) {
  Vec3<double> sum;
  for (const int v : vertices(cell)) sum += (1.0 / vertex_count(cell.kind)) * mesh.nodes[static_cast<std::size_t>(v)];
  return sum;
}

double diagonal(const Mesh& mesh) {
  Vec3<double> size;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::ranges::minmax(mesh.nodes, {}, [k](const Vec3<double>& x) { return x[k]; });
    size[k] = high[k] - low[k];
  }
  return std::sqrt(norm2(size));
}

Cell facet(const Cell& cell, int f) { return trace(facet_part(cell, f)); }

std::vector<Cell> boundary_facets(const Mesh& mesh) {
  Distinct all = distinct_facets(mesh.cells);
  std::vector<Cell> boundary;
  for (std::size_t i = 0; i < all.entities.size(); ++i)
    if (all.times[i] == 1) boundary.push_back(std::move(all.entities[i]));
  return boundary;
}

std::vector<Cell> entities(const Mesh& mesh, int dim, bool boundary_only) {
  if (dim < 0 || dim > mesh.dim) return {};
  if (boundary_only) return dim < mesh.dim ? sub_entities(boundary_facets(mesh), mesh.dim - 1, dim) : std::vector<Cell>{};
  return dim == mesh.dim ? mesh.cells : sub_entities(mesh.cells, mesh.dim, dim);
}

Region select(const Mesh& mesh, const std::string& region_name, int dim, bool boundary_only,
              const std::function<bool(const Vec3<double>&)>& predicate) {
  if (dim < 0 || dim > mesh.dim)
    throw InputError("Region \"" + region_name + "\" asks for entities of dimension " + std::to_string(dim) + ", but the mesh has dimension " +
                     std::to_string(mesh.dim) + ".");
  if (boundary_only && dim == mesh.dim)
    throw InputError("Region \"" + region_name + "\" asks for cells on the boundary; entities of the boundary have dimension " +
                     std::to_string(mesh.dim - 1) + " or less in this mesh.");
  std::vector<signed char> known(mesh.nodes.size(), -1);  // each node is asked once
  const auto inside = [&](int node) {
    signed char& k = known[at(node)];
    if (k < 0) k = predicate(mesh.nodes[at(node)]) ? 1 : 0;
    return k > 0;
  };
  Region region{region_name, dim, {}};
  for (Cell& e : entities(mesh, dim, boundary_only))
    if (std::all_of(e.nodes.begin(), e.nodes.end(), inside)) region.cells.push_back(std::move(e));
  if (region.cells.empty()) {
    static constexpr std::array<const char*, 4> what = {"vertex", "edge", "face", "cell"};
    throw InputError("Region \"" + region_name + "\" is empty: no " + what[at(dim)] + (boundary_only ? " of the boundary" : " of the mesh") +
                     " has all its nodes where the condition holds.");
  }
  return region;
}

Region nearest_node(const Mesh& mesh, const std::string& region_name, bool boundary_only, const Vec3<double>& point) {
  const auto text = [](const Vec3<double>& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]); };
  const std::vector<Cell> all = entities(mesh, 0, boundary_only);
  const auto place = [&](const Cell& vertex) -> const Vec3<double>& { return mesh.nodes[at(vertex.nodes[0])]; };
  const auto distance = [&](const Cell& vertex) { return std::sqrt(norm2(place(vertex) - point)); };
  const Cell& nearest = *std::ranges::min_element(all, {}, distance);
  const double nearest_distance = distance(nearest);

  const auto number = [&](int node) { return mesh.first_copies.empty() ? node : mesh.first_copies[at(node)]; };
  for (const Cell& other : all)
    if (distance(other) <= nearest_distance + 1e-9 * diagonal(mesh) && number(other.nodes[0]) != number(nearest.nodes[0]))
      throw InputError("Region \"" + region_name + "\": the nodes at " + text(place(nearest)) + " and " + text(place(other)) +
                       " are equally near to " + text(point) + "; name a point that is nearer to the one that is meant.");
  double size = 0;
  for (const Cell& cell : mesh.cells)
    if (std::ranges::count(vertices(cell), nearest.nodes[0]) > 0)
      for (const int v : vertices(cell)) size = std::max(size, std::sqrt(norm2(mesh.nodes[at(v)] - place(nearest))));
  if (!(nearest_distance <= size))
    throw InputError(
        fmt::format("Region \"{}\": the node nearest to {} is at {}, {:.3g} away, which is more than the size {:.3g} of the cells there.",
                    region_name, text(point), text(place(nearest)), nearest_distance, size));
  return {region_name, 0, {nearest}};
}

void check_identity(const Mesh& mesh) {
  const auto place = [&](int node) {
    const Vec3<double>& x = mesh.nodes[at(node)];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  };
  NodeNumbering cells(mesh.cells.size()), edge_numbers(mesh.cells.size());
  std::vector<std::vector<int>> interiors;  // of the edges, ascending
  for (const Cell& c : mesh.cells) {
    const std::span<const int> vertices(c.nodes.data(), at(vertex_count(c.kind)));
    const NodeKey key = entity_key(vertices);
    const auto end = key.vertices.begin() + vertex_count(c.kind);
    const auto twice = std::adjacent_find(key.vertices.begin(), end);
    if (twice != end)
      throw InputError("A " + std::string(name(c.kind)) + " of the mesh has the vertex at " + place(*twice) +
                       " twice; a periodic mesh needs at least three cells around.");
    if (!cells.insert(key).inserted)
      throw InputError("Two cells of the mesh have the same vertices, one of them at " + place(vertices.front()) +
                       "; a cell may occur only once, and a periodic mesh needs at least three cells around.");
    if (c.order == 1) continue;
    const auto interior = at(c.order - 1);
    std::size_t node = vertices.size();
    for (const auto& e : edges(c.kind)) {
      const std::array<int, 2> ends = {c.nodes[at(e[0])], c.nodes[at(e[1])]};
      NodeKey edge = entity_key(ends);
      edge.place[0] = c.order;
      std::vector<int> own(c.nodes.begin() + static_cast<std::ptrdiff_t>(node), c.nodes.begin() + static_cast<std::ptrdiff_t>(node + interior));
      std::sort(own.begin(), own.end());
      node += interior;
      const auto found = edge_numbers.insert(edge);
      if (found.inserted)
        interiors.push_back(std::move(own));
      else if (interiors[at(found.number)] != own)
        throw InputError("Two different edges of the mesh join the vertices at " + place(edge.vertices[0]) + " and " + place(edge.vertices[1]) +
                         "; a periodic mesh needs at least three cells around, and cells that touch must share their nodes.");
    }
  }
}

GeometryJet geometry(const Mesh& mesh, const Cell& cell, const Vec3<double>& xi) {
  const Shape shape = lagrange(cell.kind, cell.order, xi);
  GeometryJet jet;
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    const Vec3<double>& x = mesh.nodes[at(cell.nodes[i])];
    jet.x += shape.value[i] * x;
    for (std::size_t a = 0; a < 3; ++a) jet.d[a] += shape.gradient[i][a] * x;
    for (std::size_t a = 0; a < 6; ++a) jet.dd[a] += shape.hessian[i][a] * x;
  }
  return jet;
}

}  // namespace karcher
