#include "karcher/mesh/seams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "karcher/mesh/incidence.hpp"
#include "karcher/mesh/place_text.hpp"
#include "karcher/mesh/union_find.hpp"

namespace karcher {
namespace {

constexpr std::size_t most_parts_named = 3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Part {
  int cells = 0;
  Vec3<double> centre;  ///< sum over the cells
};

}  // namespace

std::vector<std::string> seams(const Mesh& mesh) {
  std::vector<std::string> sentences;
  UnionFind sets(mesh.nodes.size());
  for (const Cell& c : mesh.cells)
    for (const int n : vertices(c)) sets.join(c.nodes[0], n);
  for (std::size_t n = 0; n < mesh.first_copies.size(); ++n) sets.join(static_cast<int>(n), mesh.first_copies[n]);
  Vec3<double> lower = mesh.nodes.front(), upper = lower;
  for (const Vec3<double>& x : mesh.nodes)
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], x[i]);
      upper[i] = std::max(upper[i], x[i]);
    }
  const double size = std::sqrt(norm2(upper - lower));

  std::map<int, Part> parts;  // by their smallest vertex
  for (const Cell& c : mesh.cells) {
    Part& part = parts[sets.root(c.nodes[0])];
    ++part.cells;
    for (const int n : vertices(c)) part.centre += (1.0 / vertex_count(c.kind)) * mesh.nodes[at(n)];
  }
  if (parts.size() > 1) {
    std::string list;
    std::size_t named = 0;
    for (const auto& entry : parts)
      if (named++ < most_parts_named)
        list += fmt::format("{}{} around {}", list.empty() ? "" : ", ", cells_text(entry.second.cells),
                            place_text((1.0 / entry.second.cells) * entry.second.centre, size));
    sentences.push_back(
        fmt::format("the mesh is of {} parts that are not connected: {}{}.", parts.size(), list, named > most_parts_named ? ", ..." : ""));
  }

  // Boxes of the size that counts as one place; the shift keeps round coordinates away from their walls.
  const double box = 1e-9 * size;
  std::vector<std::pair<std::array<double, 3>, int>> boxes;
  boxes.reserve(mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    std::array<double, 3> key{};
    for (std::size_t i = 0; i < 3; ++i) key[i] = std::floor((mesh.nodes[n][static_cast<int>(i)] - lower[static_cast<int>(i)]) / box + 0.37);
    boxes.emplace_back(key, static_cast<int>(n));
  }
  std::sort(boxes.begin(), boxes.end());
  int pairs = 0, first = -1;
  for (std::size_t k = 1; k < boxes.size(); ++k)
    if (boxes[k].first == boxes[k - 1].first &&
        (mesh.first_copies.empty() || mesh.first_copies[at(boxes[k].second)] != mesh.first_copies[at(boxes[k - 1].second)])) {
      ++pairs;
      first = first < 0 ? boxes[k].second : std::min(first, boxes[k].second);
    }
  if (pairs > 0)
    sentences.push_back(fmt::format(
        "{} pair{} of nodes of the mesh lie{} at the same place, the first at {}: fields are not joined there (Gmsh: Coherence Mesh joins them).",
        pairs, pairs == 1 ? "" : "s", pairs == 1 ? "s" : "", place_text(mesh.nodes[at(first)], size)));
  return sentences;
}

}  // namespace karcher
