#include "karcher/mesh/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "karcher/error.hpp"
#include "mesh/elevate.hpp"
#include "mesh/lattice.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool inside(CellKind kind, const Vec3<double>& xi, double slack) {
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  double sum = 0;
  for (int i = 0; i < dimension(kind); ++i) {
    if (xi[i] < -slack || (!simplex && xi[i] > 1 + slack)) return false;
    sum += xi[i];
  }
  return !simplex || sum <= 1 + slack;
}

/// Moves a point that rounding left just outside back to the reference cell.
Vec3<double> clamped(CellKind kind, Vec3<double> xi) {
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  double sum = 0;
  for (int i = 0; i < dimension(kind); ++i) {
    xi[i] = std::clamp(xi[i], 0.0, 1.0);
    sum += xi[i];
  }
  if (simplex && sum > 1)
    for (int i = 0; i < dimension(kind); ++i) xi[i] /= sum;
  return xi;
}

/// Solves a symmetric positive definite system of size n <= 3 (Cholesky); false if it is not one.
bool solve(Mat3<double> a, Vec3<double>& b, int n) {
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) a(j, j) -= a(j, k) * a(j, k);
    if (!(a(j, j) > 0)) return false;
    a(j, j) = std::sqrt(a(j, j));
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) a(i, j) -= a(i, k) * a(j, k);
      a(i, j) /= a(j, j);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a(i, k) * b[k];
    b[i] /= a(i, i);
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) b[i] -= a(k, i) * b[k];
    b[i] /= a(i, i);
  }
  return true;
}

/// A face of a cell as an affine subset of its reference cell: corners in the cell's reference coordinates.
struct Part {
  CellKind kind;
  std::vector<Vec3<double>> corners;
};

/// The nearest point of a cell: stationary points of the squared distance inside the cell and inside each of its faces, edges and vertices.
class NearestInCell {
 public:
  NearestInCell(const Mesh& mesh, const Cell& cell, const Vec3<double>& point) : mesh_(mesh), cell_(cell), point_(point) {
    std::vector<Vec3<double>> all;
    for (const LatticePoint& c : corners(cell.kind))
      all.push_back({{static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])}});
    search({cell.kind, all});
  }
  /// A corner where every squared distance overflows.
  const Vec3<double>& xi() const { return xi_; }

 private:
  void offer(const Vec3<double>& xi) {
    const double d = norm2(geometry(mesh_, cell_, xi).x - point_);
    if (d < best_) {
      best_ = d;
      xi_ = xi;
    }
  }

  /// Newton (Gauss-Newton where the Hessian is indefinite) from the middle of the part, damped so that the distance falls; if that ends outside of
  /// the part, its own facets are searched.
  void search(const Part& part) {
    if (part.kind == CellKind::vertex) return offer(part.corners[0]);
    const int dim = dimension(part.kind);
    Vec3<double> s;
    for (int i = 0; i < dim; ++i) s[i] = reference_measure(part.kind) < 1 ? 1.0 / (dim + 1) : 0.5;
    const auto in_cell = [&](const Vec3<double>& local) { return combine(vertex_functions(part.kind, local), part.corners); };
    bool stationary = false;
    for (int iteration = 0; iteration < 50 && !stationary; ++iteration) {
      const GeometryJet g = geometry(mesh_, cell_, in_cell(s));
      const Vec3<double> residual = g.x - point_;
      std::array<Vec3<double>, 3> direction, tangent;
      Vec3<double> descent;
      for (int a = 0; a < dim; ++a) {
        direction[at(a)] = direction_of(part, a);
        for (int i = 0; i < 3; ++i) tangent[at(a)] += direction[at(a)][i] * g.d[at(i)];
        descent[a] = -dot(tangent[at(a)], residual);
      }
      Mat3<double> gauss, bend;  // residual . second derivatives, in the cell's coordinates
      constexpr std::array<std::array<int, 3>, 3> pair = {{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) bend(i, j) = dot(residual, g.dd[at(pair[at(i)][at(j)])]);
      Mat3<double> hessian;
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b) {
          gauss(a, b) = dot(tangent[at(a)], tangent[at(b)]);
          hessian(a, b) = gauss(a, b) + dot(direction[at(a)], bend * direction[at(b)]);
        }
      Vec3<double> step = descent;
      if (!solve(hessian, step, dim)) {
        step = descent;
        if (!solve(gauss, step, dim)) break;
      }
      stationary = norm2(step) < 1e-26;
      double length = 1;
      while (length > 1e-3 && norm2(geometry(mesh_, cell_, in_cell(s + length * step)).x - point_) > norm2(residual) * (1 + 1e-12)) length /= 2;
      s += length * step;
      if (norm2(s) > 100) break;
    }
    if (stationary && inside(part.kind, s, 1e-9)) return offer(in_cell(clamped(part.kind, s)));
    for (const ReferenceFace& facet : facets(part.kind)) {
      Part sub{facet.kind, {}};
      for (int v : facet.vertices) sub.corners.push_back(part.corners[at(v)]);
      search(sub);
    }
  }

  /// Derivative of the place in the cell by the part's coordinate a; parts are affine images of their reference cells.
  static Vec3<double> direction_of(const Part& part, int a) {
    const bool cube = part.kind == CellKind::quadrilateral || part.kind == CellKind::hexahedron;
    const int end = a == 0 ? 1 : a == 1 ? (cube ? 3 : 2) : (cube ? 4 : 3);
    return part.corners[at(end)] - part.corners[0];
  }

  const Mesh& mesh_;
  const Cell& cell_;
  Vec3<double> point_, xi_;
  double best_ = std::numeric_limits<double>::infinity();
};

/// A ball around the cell's nodes, enlarged for curved cells, whose geometry may leave the hull of its nodes.
struct Ball {
  Vec3<double> centre;
  double radius = 0;
};
Ball ball(const Mesh& mesh, const Cell& cell) {
  Ball b;
  for (int n : cell.nodes) b.centre += (1.0 / static_cast<double>(cell.nodes.size())) * mesh.nodes[at(n)];
  for (int n : cell.nodes) b.radius = std::max(b.radius, std::sqrt(norm2(mesh.nodes[at(n)] - b.centre)));
  if (cell.order > 1) b.radius *= 1.5;
  return b;
}

/// Of a vector whose squares may overflow.
double length(const Vec3<double>& x) { return std::hypot(x[0], x[1], x[2]); }

double diameter(const Mesh& mesh, const Cell& cell) {
  double d = 0;
  for (int i = 0; i < vertex_count(cell.kind); ++i)
    for (int j = 0; j < i; ++j) d = std::max(d, std::sqrt(norm2(mesh.nodes[at(cell.nodes[at(i)])] - mesh.nodes[at(cell.nodes[at(j)])])));
  return d;
}

}  // namespace

Locator::Locator(const Mesh& mesh, const Region& region) : mesh_(mesh), region_(region), order_(region.cells.size()) {
  for (const Cell& c : region.cells) {
    const Ball b = ball(mesh, c);
    centres_.push_back(b.centre);
    radii_.push_back(b.radius);
  }
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) split(0, static_cast<int>(order_.size()));
}

int Locator::split(int begin, int end) {
  constexpr int leaf = 8;
  Box box;
  box.begin = begin, box.end = end;
  constexpr double inf = std::numeric_limits<double>::infinity();
  box.low = {{inf, inf, inf}}, box.high = {{-inf, -inf, -inf}};
  for (int k = begin; k < end; ++k)
    for (int i = 0; i < 3; ++i) {
      const double x = centres_[at(order_[at(k)])][i], r = radii_[at(order_[at(k)])];
      box.low[i] = std::min(box.low[i], x - r);
      box.high[i] = std::max(box.high[i], x + r);
    }
  const int number = static_cast<int>(boxes_.size());
  boxes_.push_back(box);
  if (end - begin <= leaf) return number;
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return std::pair(centres_[at(a)][axis], a) < std::pair(centres_[at(b)][axis], b); });
  const int first = split(begin, middle), second = split(middle, end);
  boxes_[at(number)].first = first, boxes_[at(number)].second = second;
  return number;
}

Location Locator::in_cell(int cell, const Vec3<double>& point) const {
  const Cell& c = region_.cells[at(cell)];
  const NearestInCell found(mesh_, c, point);
  return {cell, found.xi(), length(geometry(mesh_, c, found.xi()).x - point), diameter(mesh_, c)};
}

template <class Reach, class Visit>
void Locator::search(int box, const Vec3<double>& point, const Reach& reach, const Visit& visit) const {
  const auto distance = [&](int b) {
    Vec3<double> gap;
    for (int i = 0; i < 3; ++i) gap[i] = std::max({boxes_[at(b)].low[i] - point[i], point[i] - boxes_[at(b)].high[i], 0.0});
    return length(gap);
  };
  const Box& b = boxes_[at(box)];
  if (b.first < 0) {
    for (int k = b.begin; k < b.end; ++k) {
      const int cell = order_[at(k)];
      if (length(centres_[at(cell)] - point) - radii_[at(cell)] <= reach()) visit(cell);
    }
    return;
  }
  std::array<std::pair<double, int>, 2> halves{std::pair(distance(b.first), b.first), {distance(b.second), b.second}};
  if (halves[1] < halves[0]) std::swap(halves[0], halves[1]);
  for (const auto& [gap, half] : halves)
    if (gap <= reach()) search(half, point, reach, visit);
}

Location Locator::nearest(const Vec3<double>& point) const {
  Location best;
  best.distance = std::numeric_limits<double>::infinity();
  if (boxes_.empty()) return best;
  search(
      0, point, [&] { return best.distance + 1e-12 * best.cell_diameter; },
      [&](int cell) {
        const Location found = in_cell(cell, point);
        const double tie = 1e-12 * found.cell_diameter;
        if (best.cell < 0 || found.distance < best.distance - tie || (found.distance < best.distance + tie && cell < best.cell)) best = found;
      });
  return best;
}

std::vector<Location> Locator::all_nearest(const Vec3<double>& point) const {
  const Location best = nearest(point);
  std::vector<Location> all;
  if (best.cell < 0) return all;
  const double reach = best.distance + 1e-9 * best.cell_diameter;
  search(
      0, point, [&] { return reach; },
      [&](int cell) {
        const Location found = cell == best.cell ? best : in_cell(cell, point);
        if (found.distance <= best.distance + 1e-9 * std::max(best.cell_diameter, found.cell_diameter)) all.push_back(found);
      });
  std::ranges::sort(all, {}, &Location::cell);
  return all;
}

Location nearest(const Mesh& mesh, const Region& region, const Vec3<double>& point) { return Locator(mesh, region).nearest(point); }

Location locate(const Mesh& mesh, const Region& region, const Vec3<double>& point, double tolerance) {
  if (region.cells.empty()) throw InputError("The region \"" + region.name + "\" is empty, no point lies in it.");
  const auto text = [](const Vec3<double>& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]); };
  if (!std::isfinite(point[0]) || !std::isfinite(point[1]) || !std::isfinite(point[2]))
    throw InputError("The point " + text(point) + " is not finite.");
  const Location found = nearest(mesh, region, point);
  const double scale = found.cell_diameter > 0 ? found.cell_diameter : 1e-6;
  if (found.distance <= tolerance * scale) return found;
  const Vec3<double> x = geometry(mesh, region.cells[at(found.cell)], found.xi).x;
  throw InputError(fmt::format("The point {} lies outside the region \"{}\": the nearest place is {}, at a distance of {:.3g}.", text(point),
                               region.name, text(x), found.distance));
}

}  // namespace karcher
