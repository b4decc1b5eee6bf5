#include "mesh/lattice.hpp"

#include <map>
#include <mutex>

namespace karcher {
namespace {

struct Lattice {
  std::vector<LatticePoint> points;
  std::vector<LatticePlace> places;
};

/// Points strictly inside the reference cell, x fastest.
std::vector<LatticePoint> interior(CellKind kind, int q) {
  std::vector<LatticePoint> points;
  const int dim = dimension(kind);
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  for (int z = dim > 2 ? 1 : 0; z < (dim > 2 ? q : 1); ++z)
    for (int y = dim > 1 ? 1 : 0; y < (dim > 1 ? q : 1); ++y)
      for (int x = 1; x < q; ++x)
        if (!simplex || x + y + z < q) points.push_back({x, y, z});
  return points;
}

/// Appends the interior points of an entity whose reference axes start at vertices[0] and end at axis_ends.
void append(Lattice& lattice, CellKind cell, CellKind entity, const std::vector<int>& vertices, int q) {
  const auto& corner = corners(cell);
  const auto at = [&](int local) { return corner[static_cast<std::size_t>(vertices[static_cast<std::size_t>(local)])]; };
  const std::array<int, 3> axis_end = entity == CellKind::quadrilateral ? std::array{1, 3, 0}
                                      : entity == CellKind::hexahedron  ? std::array{1, 3, 4}
                                                                        : std::array{1, 2, 3};
  for (const LatticePoint& point : interior(entity, q)) {
    LatticePoint in_cell;
    for (std::size_t i = 0; i < 3; ++i) {
      in_cell[i] = q * at(0)[i];
      for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(entity)); ++a) in_cell[i] += point[a] * (at(axis_end[a])[i] - at(0)[i]);
    }
    lattice.points.push_back(in_cell);
    LatticePlace place;
    place.entity = entity;
    for (std::size_t v = 0; v < vertices.size(); ++v) place.vertices[v] = vertices[v];
    place.point = point;
    lattice.places.push_back(place);
  }
}

Lattice make_lattice(CellKind kind, int q) {
  Lattice lattice;
  for (int v = 0; v < vertex_count(kind); ++v) {
    const LatticePoint& c = corners(kind)[static_cast<std::size_t>(v)];
    lattice.points.push_back({q * c[0], q * c[1], q * c[2]});
    LatticePlace place;
    place.vertices[0] = v;
    lattice.places.push_back(place);
  }
  if (dimension(kind) == 0) return lattice;
  for (const auto& e : edges(kind)) append(lattice, kind, CellKind::line, {e[0], e[1]}, q);
  for (const auto& f : faces(kind)) append(lattice, kind, f.kind, f.vertices, q);
  if (dimension(kind) == 1) return lattice;
  std::vector<int> all;
  for (int v = 0; v < vertex_count(kind); ++v) all.push_back(v);
  append(lattice, kind, kind, all, q);
  return lattice;
}

const Lattice& cached(CellKind kind, int q) {
  static std::mutex mutex;
  static std::map<std::pair<CellKind, int>, Lattice> known;
  const std::lock_guard lock(mutex);
  const auto key = std::pair(kind, q);
  const auto it = known.find(key);
  return it != known.end() ? it->second : known.emplace(key, make_lattice(kind, q)).first->second;
}

}  // namespace

const std::vector<LatticePoint>& lattice(CellKind kind, int q) { return cached(kind, q).points; }
const std::vector<LatticePlace>& lattice_places(CellKind kind, int q) { return cached(kind, q).places; }

const std::vector<LatticePoint>& corners(CellKind kind) {
  static const std::array<std::vector<LatticePoint>, 6> table = {{
      {{0, 0, 0}},
      {{0, 0, 0}, {1, 0, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
  }};
  return table[static_cast<std::size_t>(kind)];
}

std::vector<double> vertex_functions(CellKind kind, const Vec3<double>& xi) {
  const double x = xi[0], y = xi[1], z = xi[2];
  switch (kind) {
    case CellKind::vertex:
      return {1.0};
    case CellKind::line:
      return {1 - x, x};
    case CellKind::triangle:
      return {1 - x - y, x, y};
    case CellKind::quadrilateral:
      return {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
    case CellKind::tetrahedron:
      return {1 - x - y - z, x, y, z};
    case CellKind::hexahedron:
      break;
  }
  std::vector<double> value;
  for (const LatticePoint& c : corners(kind)) value.push_back((c[0] ? x : 1 - x) * (c[1] ? y : 1 - y) * (c[2] ? z : 1 - z));
  return value;
}

std::vector<double> vertex_functions(CellKind kind, const LatticePoint& point, int q) {
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  std::vector<double> value;
  for (const LatticePoint& c : corners(kind)) {
    int numerator = 1, denominator = 1;
    if (simplex) {
      const int inside = point[0] * c[0] + point[1] * c[1] + point[2] * c[2];
      numerator = c == LatticePoint{0, 0, 0} ? q - point[0] - point[1] - point[2] : inside;
      denominator = q;
    } else {
      for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(kind)); ++a) {
        numerator *= c[a] ? point[a] : q - point[a];
        denominator *= q;
      }
    }
    value.push_back(static_cast<double>(numerator) / denominator);
  }
  return value;
}

}  // namespace karcher
