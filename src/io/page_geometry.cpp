#include "io/page_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace karcher {
namespace {

constexpr int finest = 16;
/// Bounds for the faces inside solids: triangles times states, and triangles that are always allowed.
constexpr std::size_t most_inner_values = 400000, least_inner_triangles = 8000;

using Pair = std::array<int, 2>;  ///< (part, node) of a point, or the two ends of an edge

/// Largest deviation of what is drawn from what is meant, relative to the size of the shape: half a pixel of a picture of 1000.
constexpr double tolerance = 5e-4;
/// Largest turn between neighbouring pieces of an edge, in radians: shading hides less.
constexpr double largest_turn = 0.2;
/// Edges of solids where faces meet at a larger angle are drawn like borders.
const double crease_cosine = std::cos(0.6);

/// Lagrange weights at places in sixteenths, made when first asked for.
const std::vector<double>& weights(CellKind kind, int order, std::array<int, 2> place) {
  static std::map<std::array<int, 4>, std::vector<double>> known;
  std::vector<double>& w = known[{static_cast<int>(kind), order, place[0], place[1]}];
  if (w.empty()) {
    w = lagrange(kind, order, {{place[0] / double(finest), place[1] / double(finest), 0}}).value;
    for (double& x : w)
      if (std::abs(x) < 1e-13) x = 0;  // at a node its value counts, whatever the others are
  }
  return w;
}

/// Positions of the points of all parts at some states; state -1 is the reference.
class Positions {
 public:
  Positions(const Store& store, const std::vector<int>& states) : store_(&store), states_(states) {}
  std::size_t count() const { return states_.size() + 1; }
  Vec3<double> at(std::size_t k, int part, int node) const {
    const StoredPart& p = store_->parts[static_cast<std::size_t>(part)];
    const auto n = 3 * static_cast<std::size_t>(node);
    Vec3<double> x{{p.reference[n], p.reference[n + 1], p.reference[n + 2]}};
    if (k == 0 || !p.moves) return x;
    const std::vector<float>& u = store_->states[static_cast<std::size_t>(states_[k - 1])].parts[static_cast<std::size_t>(part)].displacement;
    for (int i = 0; i < 3; ++i) x[i] += u[n + static_cast<std::size_t>(i)];
    return x;
  }

 private:
  const Store* store_;
  std::vector<int> states_;
};

double length(const Vec3<double>& a) { return std::sqrt(dot(a, a)); }

/// The faces and curves that are seen from outside, part by part. A face of a later part that lies on one of an earlier part takes its place.
/// `inner` gets the faces between two cells of a solid, twice each: as the first and as the second cell has them, with the nodes of the first.
std::vector<PageFacet> visible_facets(const Store& store, std::vector<PageFacet>& inner) {
  std::vector<PageFacet> facets;
  for (std::size_t p = 0; p < store.parts.size(); ++p) {
    const StoredPart& part = store.parts[p];
    if (part.dim == 3) {
      struct Seen {
        std::size_t facet;
        int count;
        int second;  ///< cell
      };
      std::map<std::vector<int>, Seen> seen;
      std::vector<PageFacet> all;
      for (std::size_t c = 0; c < part.cells.size(); ++c) {
        const OutputCell& cell = part.cells[c];
        for (std::size_t f = 0; f < faces(cell.kind).size(); ++f) {
          const ReferenceFace& face = faces(cell.kind)[f];
          std::vector<int> key;
          for (const int v : face.vertices) key.push_back(cell.nodes[static_cast<std::size_t>(v)]);
          std::sort(key.begin(), key.end());
          auto [at, first] = seen.try_emplace(std::move(key), Seen{all.size(), 0, -1});
          ++at->second.count;
          if (!first) {
            at->second.second = static_cast<int>(c);
            continue;
          }
          PageFacet facet{static_cast<int>(p), static_cast<int>(c), face.kind, {}, -1, -1};
          for (const int k : facet_nodes(cell.kind, part.order, static_cast<int>(f))) facet.nodes.push_back(cell.nodes[static_cast<std::size_t>(k)]);
          all.push_back(std::move(facet));
        }
      }
      std::vector<int> other(all.size(), -1);
      for (const auto& [key, s] : seen) other[s.facet] = s.second;
      for (std::size_t k = 0; k < all.size(); ++k)
        if (other[k] < 0) {
          facets.push_back(std::move(all[k]));
        } else {
          inner.push_back(all[k]);
          inner.push_back(std::move(all[k]));
          inner.back().cell = other[k];
        }
    } else if (part.dim > 0) {
      for (std::size_t c = 0; c < part.cells.size(); ++c)
        facets.push_back({static_cast<int>(p), static_cast<int>(c), part.cells[c].kind, part.cells[c].nodes, -1, -1});
    }
  }
  if (store.parts.size() < 2) return facets;

  // Facets of different parts are the same where their vertices have the same reference places (stored in single precision, so rounded alike).
  std::map<std::vector<std::array<float, 3>>, std::size_t> by_place;
  std::vector<char> covered(facets.size(), 0);
  for (std::size_t k = 0; k < facets.size(); ++k) {
    PageFacet& facet = facets[k];
    const std::vector<float>& x = store.parts[static_cast<std::size_t>(facet.part)].reference;
    std::vector<std::array<float, 3>> key;
    for (int v = 0; v < vertex_count(facet.kind); ++v) {
      const auto n = 3 * static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(v)]);
      key.push_back({x[n], x[n + 1], x[n + 2]});
    }
    std::sort(key.begin(), key.end());
    auto [at, first] = by_place.try_emplace(std::move(key), k);
    if (first) continue;
    covered[at->second] = 1;
    facet.below_part = facets[at->second].part;
    facet.below_cell = facets[at->second].cell;
    at->second = k;
  }
  std::vector<PageFacet> out;
  for (std::size_t k = 0; k < facets.size(); ++k)
    if (!covered[k]) out.push_back(std::move(facets[k]));
  return out;
}

/// An edge of facets: its Lagrange nodes, from the smaller to the larger of its end nodes.
struct Edge {
  int part = 0;
  std::vector<int> nodes;   ///< first end, second end, interior
  std::vector<int> facets;  ///< that have it
  int pieces = 1;
  std::vector<int> vertices;  ///< of the shape, pieces + 1, from the first end
};

/// Interior nodes of edge e of a face, from its first to its second vertex.
std::vector<int> edge_interior(const PageFacet& facet, int order, std::size_t e) {
  std::vector<int> out;
  if (facet.kind == CellKind::line) return {facet.nodes.begin() + 2, facet.nodes.end()};
  const std::size_t begin = static_cast<std::size_t>(vertex_count(facet.kind)) + e * static_cast<std::size_t>(order - 1);
  for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(order); ++k) out.push_back(facet.nodes[begin + k]);
  return out;
}

/// Pieces that a curve of length about l and second derivative c across it needs for a deviation d: c / (8 n^2) <= d, and a turn c / (n l) that shading hides.
int pieces_for(double c, double l, double d) {
  int n = 1;
  while (n < finest && (c / (8.0 * n * n) > d || c > largest_turn * n * std::max(l, d))) n *= 2;
  return n;
}

/// Length of the part of v that is perpendicular to a. The part along it moves points on the curve, not the curve.
double across(const Vec3<double>& v, const Vec3<double>& a) {
  const double l = length(a);
  return l > 0 ? length(cross(v, a)) / l : length(v);
}

int pieces_of(const Edge& edge, int order, const Positions& positions, double d) {
  int n = 1;
  for (std::size_t k = 0; order > 1 && k < positions.count() && n < finest; ++k) {
    const Vec3<double> a = positions.at(k, edge.part, edge.nodes[0]), b = positions.at(k, edge.part, edge.nodes[1]);
    double c = 0;
    if (order == 2) c = across(4.0 * (a + b - 2.0 * positions.at(k, edge.part, edge.nodes[2])), b - a);
    if (order == 3) {  // the second derivative of a cubic is linear: its ends bound it
      const Vec3<double> p = positions.at(k, edge.part, edge.nodes[2]), q = positions.at(k, edge.part, edge.nodes[3]);
      c = 9 * std::max(across(2.0 * a - 5.0 * p + 4.0 * q - b, b - a), across(2.0 * b - 5.0 * q + 4.0 * p - a, b - a));
    }
    if (std::isfinite(c)) n = std::max(n, pieces_for(c, length(b - a), d));
  }
  return n;
}

/// First and second derivatives of the basis at the centre of a face.
const Shape& at_centre(CellKind kind, int order) {
  static std::map<std::array<int, 2>, Shape> known;
  const auto [at, first] = known.try_emplace({static_cast<int>(kind), order});
  const double centre = kind == CellKind::triangle ? 1.0 / 3 : 0.5;
  if (first) at->second = lagrange(kind, order, {{centre, centre, 0}});
  return at->second;
}

/// Pieces for the inside of a face: its second fundamental form at the centre.
int pieces_inside(const PageFacet& facet, int order, const Positions& positions, double d) {
  if (facet.kind == CellKind::triangle && order == 1) return 1;
  const Shape& shape = at_centre(facet.kind, order);
  int n = 1;
  for (std::size_t k = 0; k < positions.count() && n < finest; ++k) {
    Vec3<double> xx{}, xy{}, yy{}, x{}, y{};
    for (std::size_t i = 0; i < facet.nodes.size(); ++i) {
      const Vec3<double> p = positions.at(k, facet.part, facet.nodes[i]);
      xx += shape.hessian[i][0] * p;
      xy += shape.hessian[i][1] * p;
      yy += shape.hessian[i][3] * p;
      x += shape.gradient[i][0] * p;
      y += shape.gradient[i][1] * p;
    }
    Vec3<double> normal = cross(x, y);
    const double area = length(normal), lx = length(x), ly = length(y);
    if (!(area > 0) || !std::isfinite(area)) continue;
    normal = (1 / area) * normal;
    n = std::max({n, pieces_for(std::abs(dot(normal, xx)), lx, d), pieces_for(std::abs(dot(normal, yy)), ly, d),
                  pieces_for(2 * std::abs(dot(normal, xy)), std::max(lx, ly), d)});
  }
  return n;
}

/// Cuts everything. `limit` bounds the pieces of edges and insides (16: no bound).
class Cutter {
 public:
  Cutter(const Store& store, const std::vector<int>& states, std::vector<PageFacet> facets) : store_(&store), positions_(store, states) {
    shape_.facets = std::move(facets);
    find_edges();
    measure();
  }

  std::size_t triangle_count(int limit) const {
    std::size_t count = 0;
    for (std::size_t f = 0; f < shape_.facets.size(); ++f) {
      const auto n = static_cast<std::size_t>(std::min(limit, inside_[f]));
      if (shape_.facets[f].kind == CellKind::triangle) count += n * n;
      if (shape_.facets[f].kind == CellKind::quadrilateral) count += 2 * n * n;
    }
    return count;
  }

  PageGeometry cut(int limit) {
    point_.clear();
    for (Edge& e : edges_) cut_edge(e, limit);
    for (std::size_t f = 0; f < shape_.facets.size(); ++f) {
      const PageFacet& facet = shape_.facets[f];
      if (facet.kind == CellKind::line)
        add_curve(f);
      else
        add_face(f, std::min(limit, inside_[f]));
    }
    add_edges();
    return std::move(shape_);
  }

 private:
  int order(const PageFacet& f) const { return store_->parts[static_cast<std::size_t>(f.part)].order; }

  void find_edges() {
    std::map<std::array<int, 3>, int> index;
    facet_edges_.resize(shape_.facets.size());
    for (std::size_t f = 0; f < shape_.facets.size(); ++f) {
      const PageFacet& facet = shape_.facets[f];
      const auto& local = karcher::edges(facet.kind);
      for (std::size_t e = 0; e < local.size(); ++e) {
        int a = facet.nodes[static_cast<std::size_t>(local[e][0])], b = facet.nodes[static_cast<std::size_t>(local[e][1])];
        std::vector<int> inside = edge_interior(facet, order(facet), e);
        const bool turned = a > b;
        if (turned) {
          std::swap(a, b);
          std::reverse(inside.begin(), inside.end());
        }
        const auto [at, first] = index.try_emplace({facet.part, a, b}, static_cast<int>(edges_.size()));
        if (first) {
          Edge edge;
          edge.part = facet.part;
          edge.nodes = {a, b};
          edge.nodes.insert(edge.nodes.end(), inside.begin(), inside.end());
          edges_.push_back(std::move(edge));
        }
        edges_[static_cast<std::size_t>(at->second)].facets.push_back(static_cast<int>(f));
        facet_edges_[f].push_back({at->second, turned ? 1 : 0});
      }
    }
  }

  void measure() {
    Vec3<double> low{{HUGE_VAL, HUGE_VAL, HUGE_VAL}}, high = -1.0 * low;
    for (const StoredPart& p : store_->parts)
      for (std::size_t i = 0; i < p.reference.size(); ++i) {
        low[static_cast<int>(i % 3)] = std::min(low[static_cast<int>(i % 3)], static_cast<double>(p.reference[i]));
        high[static_cast<int>(i % 3)] = std::max(high[static_cast<int>(i % 3)], static_cast<double>(p.reference[i]));
      }
    const double d = tolerance * length(high - low);
    // Fields of order p are seen between the vertices only where the cells are cut.
    const auto least = [&](const PageFacet& f) {
      return store_->parts[static_cast<std::size_t>(f.part)].point_data.empty() ? 1 : order(f) == 1 ? 1 : order(f) == 2 ? 2 : 4;
    };
    for (Edge& e : edges_) {
      const PageFacet& f = shape_.facets[static_cast<std::size_t>(e.facets[0])];
      e.pieces = std::max(least(f), pieces_of(e, order(f), positions_, d));
    }
    for (std::size_t f = 0; f < shape_.facets.size(); ++f) {
      int n = std::max(least(shape_.facets[f]),
                       shape_.facets[f].kind == CellKind::line ? 1 : pieces_inside(shape_.facets[f], order(shape_.facets[f]), positions_, d));
      for (const Pair& e : facet_edges_[f]) n = std::max(n, edges_[static_cast<std::size_t>(e[0])].pieces);
      inside_.push_back(n);
    }
  }

  int add_vertex(std::size_t facet, std::array<int, 2> place) {
    const PageFacet& f = shape_.facets[facet];
    shape_.vertices.push_back({static_cast<int>(facet), &weights(f.kind, order(f), place)});
    return static_cast<int>(shape_.vertices.size()) - 1;
  }

  /// Place in the facet of point k of `pieces` on its local edge e, counted from the edge's first vertex in the facet.
  static std::array<int, 2> on_edge(CellKind kind, std::size_t e, int k, int pieces) {
    static constexpr std::array<std::array<int, 2>, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, corner{{{0, 0}, {1, 0}, {0, 1}, {0, 0}}};
    const auto& v = kind == CellKind::quadrilateral ? square : corner;
    const auto& [a, b] = karcher::edges(kind)[e];
    const int step = finest / pieces;
    std::array<int, 2> place{};
    for (std::size_t i = 0; i < 2; ++i)
      place[i] = v[static_cast<std::size_t>(a)][i] * (finest - step * k) + v[static_cast<std::size_t>(b)][i] * step * k;
    return place;
  }

  void cut_edge(Edge& edge, int limit) {
    edge.pieces = std::min(edge.pieces, limit);
    const auto f = static_cast<std::size_t>(edge.facets[0]);
    const PageFacet& facet = shape_.facets[f];
    const auto index = static_cast<int>(&edge - edges_.data());
    std::size_t local = 0;
    while (facet_edges_[f][local][0] != index) ++local;
    const bool turned = facet_edges_[f][local][1] != 0;
    edge.vertices.assign(static_cast<std::size_t>(edge.pieces) + 1, -1);
    for (int k = 0; k <= edge.pieces; ++k) {
      const std::array<int, 2> place = on_edge(facet.kind, local, turned ? edge.pieces - k : k, edge.pieces);
      int& vertex = edge.vertices[static_cast<std::size_t>(k)];
      if (k == 0 || k == edge.pieces) {
        const auto [at, first] = point_.try_emplace({edge.part, edge.nodes[k == 0 ? 0 : 1]}, -1);
        if (first) at->second = add_vertex(f, place);
        vertex = at->second;
      } else {
        vertex = add_vertex(f, place);
      }
    }
  }

  void add_curve(std::size_t f) {
    const auto& [e, turned] = facet_edges_[f][0];
    std::vector<int> v = edges_[static_cast<std::size_t>(e)].vertices;
    if (turned) std::reverse(v.begin(), v.end());
    for (const int vertex : v) shape_.curves.push_back(static_cast<std::uint32_t>(vertex));
    shape_.curve_lengths.push_back(static_cast<std::uint32_t>(v.size()));
    shape_.curve_facets.push_back(static_cast<std::uint32_t>(f));
  }

  /// Vertex of the shape on local edge e of facet f, nearest to point k of n.
  int edge_vertex(std::size_t f, std::size_t e, int k, int n) const {
    const auto& [index, turned] = facet_edges_[f][e];
    const Edge& edge = edges_[static_cast<std::size_t>(index)];
    const int at = (2 * k * edge.pieces + n) / (2 * n);
    return edge.vertices[static_cast<std::size_t>(turned ? edge.pieces - at : at)];
  }

  void add_triangle(int a, int b, int c, std::size_t f) {
    if (a == b || b == c || c == a) return;
    for (const int v : {a, b, c}) shape_.triangles.push_back(static_cast<std::uint32_t>(v));
    shape_.triangle_facets.push_back(static_cast<std::uint32_t>(f));
  }

  void add_face(std::size_t f, int n) {
    const bool square = shape_.facets[f].kind == CellKind::quadrilateral;
    const int step = finest / n;
    std::vector<int> grid(static_cast<std::size_t>((n + 1) * (n + 1)), -1);
    const auto at = [&](int i, int j) -> int& { return grid[static_cast<std::size_t>(j * (n + 1) + i)]; };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= (square ? n : n - j); ++i) {
        if (j == 0)
          at(i, j) = edge_vertex(f, 0, i, n);
        else if (square && i == n)
          at(i, j) = edge_vertex(f, 1, j, n);
        else if (square && j == n)
          at(i, j) = edge_vertex(f, 2, n - i, n);
        else if (!square && i + j == n)
          at(i, j) = edge_vertex(f, 1, j, n);
        else if (i == 0)
          at(i, j) = edge_vertex(f, square ? 3 : 2, n - j, n);
        else
          at(i, j) = add_vertex(f, {step * i, step * j});
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < (square ? n : n - j); ++i) {
        add_triangle(at(i, j), at(i + 1, j), square ? at(i + 1, j + 1) : at(i, j + 1), f);
        if (square)
          add_triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1), f);
        else if (i + j + 2 <= n)
          add_triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), f);
      }
  }

  /// Reference normal of a face at its centre.
  Vec3<double> normal(const PageFacet& facet) const {
    const auto x = [&](int k) { return positions_.at(0, facet.part, facet.nodes[static_cast<std::size_t>(k)]); };
    const Vec3<double> n = facet.kind == CellKind::triangle ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1));
    const double l = length(n);
    return l > 0 ? (1 / l) * n : n;
  }

  bool is_strong(const Edge& e) const {
    if (e.facets.size() != 2) return true;
    if (store_->parts[static_cast<std::size_t>(e.part)].dim != 3) return false;
    return std::abs(dot(normal(shape_.facets[static_cast<std::size_t>(e.facets[0])]), normal(shape_.facets[static_cast<std::size_t>(e.facets[1])]))) <
           crease_cosine;
  }

  void add_edges() {
    for (const bool strong : {true, false})
      for (const Edge& e : edges_) {
        if (shape_.facets[static_cast<std::size_t>(e.facets[0])].kind == CellKind::line || is_strong(e) != strong) continue;
        for (const int v : e.vertices) shape_.edges.push_back(static_cast<std::uint32_t>(v));
        shape_.edge_lengths.push_back(static_cast<std::uint32_t>(e.vertices.size()));
        shape_.strong_edges += strong;
      }
  }

  const Store* store_;
  Positions positions_;
  PageGeometry shape_;
  std::vector<Edge> edges_;
  std::vector<std::vector<Pair>> facet_edges_;  ///< [facet][local edge]: edge, turned
  std::vector<int> inside_;                     ///< pieces of the inside of every facet
  std::map<Pair, int> point_;                   ///< (part, node) -> vertex at the ends of edges
};

/// Merges vertices of boxes of an even grid until few enough triangles are left (Rossignac and Borrel 1993). Edges are left out.
void thin(PageGeometry& shape, const Store& store, std::size_t most) {
  std::vector<Vec3<double>> x(shape.vertices.size());
  Vec3<double> low{{HUGE_VAL, HUGE_VAL, HUGE_VAL}}, high = -1.0 * low;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const StoredPart& part = store.parts[static_cast<std::size_t>(shape.facets[static_cast<std::size_t>(shape.vertices[v].facet)].part)];
    shape.interpolate(v, part.reference, 3, &x[v][0]);
    for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], x[v][i]), high[i] = std::max(high[i], x[v][i]);
  }
  std::vector<std::uint32_t> triangles, facets;
  double h = length(high - low) / std::sqrt(static_cast<double>(most));
  for (;; h *= 1.1) {
    std::unordered_map<std::uint64_t, std::uint32_t> box;
    std::vector<std::uint32_t> to(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) {
      std::uint64_t key = 0;
      for (int i = 0; i < 3; ++i) key = (key << 21) | (static_cast<std::uint64_t>((x[v][i] - low[i]) / h) & 0x1fffff);
      to[v] = box.try_emplace(key, static_cast<std::uint32_t>(v)).first->second;
    }
    triangles.clear();
    facets.clear();
    for (std::size_t t = 0; t < shape.triangle_facets.size(); ++t) {
      const std::uint32_t a = to[shape.triangles[3 * t]], b = to[shape.triangles[3 * t + 1]], c = to[shape.triangles[3 * t + 2]];
      if (a == b || b == c || c == a) continue;
      triangles.insert(triangles.end(), {a, b, c});
      facets.push_back(shape.triangle_facets[t]);
    }
    if (facets.size() <= most) break;
  }
  // Keep the vertices that are used, curves included.
  std::vector<std::uint32_t> number(x.size(), UINT32_MAX);
  std::vector<PageVertex> vertices;
  for (auto* list : {&triangles, &shape.curves})
    for (std::uint32_t& v : *list) {
      if (number[v] == UINT32_MAX) {
        number[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(shape.vertices[v]);
      }
      v = number[v];
    }
  shape.note =
      fmt::format("The page shows {} of {} triangles of the surface and no element edges, so that it stays small; the files for ParaView have all.",
                  facets.size(), shape.triangle_facets.size());
  shape.vertices = std::move(vertices);
  shape.triangles = std::move(triangles);
  shape.triangle_facets = std::move(facets);
  shape.edges.clear();
  shape.edge_lengths.clear();
  shape.strong_edges = 0;
}

/// Adds the faces inside solids, where at most `most` triangles show them, and says so where not.
void add_inner_faces(PageGeometry& shape, const Store& store, const std::vector<int>& states, const std::vector<PageFacet>& inner, std::size_t most) {
  std::vector<PageFacet> first_sides;
  for (std::size_t k = 0; k < inner.size(); k += 2) first_sides.push_back(inner[k]);
  Cutter cutter(store, states, std::move(first_sides));
  int limit = finest;
  while (limit > 1 && cutter.triangle_count(limit) > most) limit /= 2;
  if (cutter.triangle_count(limit) > most) {
    shape.note += (shape.note.empty() ? "" : " ") +
                  std::string("The inside of the solid is left out, so that the page stays small: cut open, it is a shell here.");
    return;
  }
  const PageGeometry cut = cutter.cut(limit);
  const auto facets = static_cast<std::uint32_t>(shape.facets.size()), vertices = static_cast<std::uint32_t>(shape.vertices.size());
  shape.facets.insert(shape.facets.end(), inner.begin(), inner.end());
  for (const PageVertex& v : cut.vertices) shape.vertices.push_back({static_cast<int>(facets) + 2 * v.facet, v.weights});
  for (const std::uint32_t v : cut.triangles) shape.inner_triangles.push_back(vertices + v);
  for (const std::uint32_t f : cut.triangle_facets) shape.inner_facets.push_back(facets + 2 * f);

  std::vector<std::size_t> begin;  // numbers of the cells of a part start here
  std::size_t count = 0;
  for (const StoredPart& p : store.parts) {
    begin.push_back(count);
    count += p.cells.size();
  }
  for (const PageFacet& f : shape.facets) {
    const auto part = static_cast<std::size_t>(f.below_part >= 0 ? f.below_part : f.part);
    shape.solid_cells.push_back(static_cast<std::uint32_t>(begin[part] + static_cast<std::size_t>(f.below_part >= 0 ? f.below_cell : f.cell)));
  }
}

}  // namespace

void PageGeometry::interpolate(std::size_t vertex, const std::vector<float>& values, int components, double* out) const {
  const PageVertex& v = vertices[vertex];
  const PageFacet& facet = facets[static_cast<std::size_t>(v.facet)];
  const std::vector<double>& w = *v.weights;
  std::fill_n(out, components, 0.0);
  for (std::size_t k = 0; k < w.size(); ++k) {
    if (w[k] == 0) continue;
    const float* value = values.data() + static_cast<std::size_t>(facet.nodes[k]) * static_cast<std::size_t>(components);
    for (int c = 0; c < components; ++c) out[c] += w[k] * static_cast<double>(value[c]);
  }
}

PageGeometry page_geometry(const Store& store, const std::vector<int>& states, int most_triangles) {
  std::vector<PageFacet> inner;
  std::vector<PageFacet> facets = visible_facets(store, inner);
  // Curvature over all states is asked for where that is quick; of many facets the last state stands for the others.
  std::vector<int> measured = states;
  if (facets.size() * states.size() > 500000 && !states.empty()) measured = {states.back()};
  Cutter cutter(store, measured, std::move(facets));
  const auto most = static_cast<std::size_t>(most_triangles);
  const std::size_t wanted = cutter.triangle_count(finest);
  int limit = finest;
  while (limit > 1 && cutter.triangle_count(limit) > most) limit /= 2;
  PageGeometry shape = cutter.cut(limit);
  if (shape.triangle_facets.size() > most)
    thin(shape, store, most);
  else if (limit < finest && shape.triangle_facets.size() < wanted)
    shape.note = fmt::format("Curved elements are cut into at most {} pieces in each direction, so that the page stays small.", limit);
  // They are seen only in a cut, so they must not make the page much larger than it is without them.
  if (!inner.empty()) {
    const std::size_t wanted_most = std::max(most_inner_values / std::max<std::size_t>(1, states.size()), least_inner_triangles);
    add_inner_faces(shape, store, measured, inner, std::min(wanted_most, most - shape.triangle_facets.size()));
  }
  return shape;
}

}  // namespace karcher
