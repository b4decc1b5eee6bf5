#include "karcher/mesh/folds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace karcher {
namespace {

constexpr double forgiven = 0.02;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The basis on the lattice of points, and the points of every line of the lattice, one behind the other.
struct Samples {
  std::vector<Vec3<double>> points;
  std::vector<Shape> shapes;
  std::vector<std::vector<std::size_t>> lines;
};

Samples make_samples(CellKind kind, int order) {
  const int dim = dimension(kind), q = order == 1 ? 1 : (dim == 3 ? 2 : 4) * order;
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  Samples s;
  std::map<std::array<int, 3>, std::vector<std::size_t>> lines;  // by the point where they enter the cell, -1 along themselves
  for (int k = 0; k <= (dim > 2 ? q : 0); ++k)
    for (int j = 0; j <= (dim > 1 ? q : 0); ++j)
      for (int i = 0; i <= q; ++i) {
        if (simplex && i + j + k > q) continue;
        for (const std::array<int, 3> line : {std::array{-1, j, k}, {i, -1, k}, {i, j, -1}}) lines[line].push_back(s.points.size());
        s.points.push_back((1.0 / q) * Vec3<double>{{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}});
        s.shapes.push_back(lagrange(kind, order, s.points.back()));
      }
  for (auto& entry : lines) s.lines.push_back(std::move(entry.second));
  return s;
}

/// Whether a simplex is the affine image of its reference cell, so that its map turns over nowhere.
bool straight(const Mesh& mesh, const Cell& cell) {
  if (cell.kind == CellKind::quadrilateral || cell.kind == CellKind::hexahedron) return false;
  const auto vertex = [&](int v) { return mesh.nodes[at(cell.nodes[at(v)])]; };
  const std::vector<Vec3<double>>& places = lagrange_nodes(cell.kind, cell.order);
  const int dim = dimension(cell.kind);
  double size = 0, bend = 0;
  for (std::size_t n = at(dim) + 1; n < cell.nodes.size(); ++n) {
    Vec3<double> x = vertex(0);
    for (int i = 0; i < dim; ++i) x += places[n][i] * (vertex(i + 1) - vertex(0));
    bend = std::max(bend, norm2(mesh.nodes[at(cell.nodes[n])] - x));
  }
  for (int i = 0; i < dim; ++i) size = std::max(size, norm2(vertex(i + 1) - vertex(0)));
  return bend <= 1e-12 * size;
}

/// Tangent, normal, or determinant (in the first entry), as large as the measure.
Vec3<double> measure_vector(const std::array<Vec3<double>, 3>& d, int dim) {
  if (dim == 1) return d[0];
  const Vec3<double> normal = cross(d[0], d[1]);
  return dim == 2 ? normal : Vec3<double>{{dot(normal, d[2]), 0, 0}};
}

}  // namespace

std::optional<Fold> first_fold(const Mesh& mesh) {
  std::map<std::pair<CellKind, int>, Samples> all;
  std::vector<Vec3<double>> measures;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Cell& cell = mesh.cells[c];
    if (straight(mesh, cell)) continue;
    Samples& samples = all[{cell.kind, cell.order}];
    if (samples.points.empty()) samples = make_samples(cell.kind, cell.order);
    measures.clear();
    Vec3<double> mean;
    double largest = 0;
    for (const Shape& shape : samples.shapes) {
      std::array<Vec3<double>, 3> d{};
      for (std::size_t n = 0; n < cell.nodes.size(); ++n)
        for (std::size_t a = 0; a < 3; ++a) d[a] += shape.gradient[n][a] * mesh.nodes[at(cell.nodes[n])];
      measures.push_back(measure_vector(d, dimension(cell.kind)));
      mean += measures.back();
      largest = std::max(largest, norm2(measures.back()));
    }
    const auto turns_over = [&](const std::vector<std::size_t>& line) {
      const Vec3<double>* last = nullptr;
      for (const std::size_t i : line) {
        if (norm2(measures[i]) <= forgiven * forgiven * largest) continue;
        if (last && dot(*last, measures[i]) < 0) return true;
        last = &measures[i];
      }
      return false;
    };
    if (std::none_of(samples.lines.begin(), samples.lines.end(), turns_over)) continue;
    if (norm2(mean) > 0) mean = (1 / std::sqrt(norm2(mean))) * mean;
    const auto [least, most] =
        std::minmax_element(measures.begin(), measures.end(), [&](const auto& a, const auto& b) { return dot(a, mean) < dot(b, mean); });
    const Vec3<double> xi = samples.points[at(static_cast<int>(least - measures.begin()))];
    return Fold{static_cast<int>(c), geometry(mesh, cell, xi).x, dot(*least, mean), dot(*most, mean)};
  }
  return std::nullopt;
}

}  // namespace karcher
