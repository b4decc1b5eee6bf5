#pragma once
/// \file
/// The energy of one element of a map into a manifold, written straight from the formulas over any scalar (double, adouble): nodal unknowns -> retraction ->
/// interpolation -> density. Shares nothing with the generic kernel but Lagrange bases, quadrature points and the frames that say what tangent coordinates are.
///
/// Rotations are matrices here once they are interpolated: Heron's iteration for the polar factor, quaternions only for the Riemannian mean. Means are found by
/// Newton's method with the Jacobian of the plain values: each step from the converged mean makes the derivatives right to one order more. The space
/// derivatives of the interpolated map travel along (Slope), so nothing is differentiated by hand.

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/rule.hpp"
#include "karcher/math/tensor.hpp"
#include "karcher/mesh/mesh.hpp"
#include "karcher/mesh/quadrature.hpp"

namespace karcher::density_oracle {

using std::acos;
using std::log;
using std::sqrt;

/// A number with its derivatives in D directions.
template <class S, int D>
struct Slope {
  S v = S(0.0);
  std::array<S, D> d = zeros();

  Slope() = default;
  Slope(double x) : v(x) {}
  static std::array<S, D> zeros() {
    std::array<S, D> z;
    for (auto& x : z) x = S(0.0);
    return z;
  }
  Slope chained(const S& f, const S& slope) const {
    Slope r;
    r.v = f;
    for (std::size_t a = 0; a < D; ++a) r.d[a] = d[a] * slope;
    return r;
  }
  friend Slope operator+(Slope x, const Slope& y) {
    x.v += y.v;
    for (std::size_t a = 0; a < D; ++a) x.d[a] += y.d[a];
    return x;
  }
  friend Slope operator-(const Slope& x) { return x.chained(-x.v, S(-1.0)); }
  friend Slope operator-(Slope x, const Slope& y) {
    x.v -= y.v;
    for (std::size_t a = 0; a < D; ++a) x.d[a] -= y.d[a];
    return x;
  }
  friend Slope operator*(const Slope& x, const Slope& y) {
    Slope r;
    r.v = x.v * y.v;
    for (std::size_t a = 0; a < D; ++a) r.d[a] = x.d[a] * y.v + x.v * y.d[a];
    return r;
  }
  friend Slope operator/(const Slope& x, const Slope& y) {
    const S r = 1.0 / y.v;
    return x * y.chained(r, -r * r);
  }
  friend Slope sqrt(const Slope& x) {
    const S r = sqrt(x.v);
    return x.chained(r, 0.5 / r);
  }
  friend Slope acos(const Slope& x) { return x.chained(acos(x.v), -1.0 / sqrt(1.0 - x.v * x.v)); }
  friend Slope log(const Slope& x) { return x.chained(log(x.v), 1.0 / x.v); }
};

inline double plain(double x) { return x; }
template <class S>
double plain(const S& x) {
  if constexpr (requires { x.v; }) {
    return plain(x.v);
  } else {
    return x.value();
  }
}

template <class X, class Y>
X dot_of(const std::vector<X>& a, const std::vector<Y>& b) {
  X s = a[0] * b[0];
  for (std::size_t i = 1; i < a.size(); ++i) s = s + a[i] * b[i];
  return s;
}
template <class X>
std::vector<X> lifted(const std::vector<double>& a) {
  std::vector<X> r;
  for (double x : a) r.push_back(X(x));
  return r;
}
/// a + f b
template <class X>
std::vector<X> plus(std::vector<X> a, const X& f, const std::vector<X>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] + f * b[i];
  return a;
}
template <class X>
std::vector<X> times(const X& f, std::vector<X> a) {
  for (auto& x : a) x = f * x;
  return a;
}

/// Square matrices, row by row.
template <class X>
std::vector<X> matrix_product(const std::vector<X>& a, const std::vector<X>& b, std::size_t n, bool transposed_a = false) {
  std::vector<X> c(n * n, X(0.0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) c[i * n + j] = c[i * n + j] + a[transposed_a ? k * n + i : i * n + k] * b[k * n + j];
  return c;
}
/// Gauss-Jordan without pivoting: for matrices near the identity or positive definite. b has any number of columns.
template <class X>
std::vector<X> solved(std::vector<X> a, std::vector<X> b, std::size_t n) {
  const std::size_t m = b.size() / n;
  for (std::size_t p = 0; p < n; ++p) {
    const X r = X(1.0) / a[p * n + p];
    for (std::size_t j = 0; j < n; ++j) a[p * n + j] = a[p * n + j] * r;
    for (std::size_t j = 0; j < m; ++j) b[p * m + j] = b[p * m + j] * r;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      const X f = a[i * n + p];
      for (std::size_t j = 0; j < n; ++j) a[i * n + j] = a[i * n + j] - f * a[p * n + j];
      for (std::size_t j = 0; j < m; ++j) b[i * m + j] = b[i * m + j] - f * b[p * m + j];
    }
  }
  return b;
}
/// log of a matrix not far from the identity: int_0^1 (A - I)(I + t (A - I))^-1 dt by Gauss' rule, which is a diagonal Pade approximant.
template <class X>
std::vector<X> matrix_log(const std::vector<X>& a, std::size_t n) {
  std::vector<X> y = a, sum(n * n, X(0.0));
  for (std::size_t i = 0; i < n; ++i) y[i * n + i] = y[i * n + i] - X(1.0);
  const Quadrature& gauss = quadrature(CellKind::line, 27);
  for (std::size_t k = 0; k < gauss.weights.size(); ++k) {
    std::vector<X> b = times(X(gauss.points[k][0]), y);
    for (std::size_t i = 0; i < n; ++i) b[i * n + i] = b[i * n + i] + X(1.0);
    sum = plus(sum, X(gauss.weights[k]), solved(b, y, n));
  }
  return sum;
}

// What a manifold is to the oracle: exp to the third order of a, log, coordinates of tangent vectors at q, |d|^2 in the metric, squared distance, and `value`,
// the form in which densities see a point.

template <int N>
struct UnitVectors {
  static constexpr std::size_t dim = N - 1;
  static std::size_t largest(const std::vector<double>& q) {
    std::size_t at = 0;
    for (std::size_t i = 1; i < q.size(); ++i)
      if (std::fabs(q[i]) > std::fabs(q[at])) at = i;
    return at;
  }
  /// All components but the largest one of q are free.
  template <class X>
  static std::vector<X> tangent(const std::vector<double>& q, const std::vector<X>& w) {
    const std::size_t j = largest(q);
    std::vector<X> a;
    X s = X(0.0);
    for (std::size_t i = 0, k = 0; i < N; ++i) {
      a.push_back(i == j ? X(0.0) : w[k++]);
      s = s + X(q[i]) * a[i];
    }
    a[j] = X(-1.0 / q[j]) * s;
    return a;
  }
  template <class X>
  static std::vector<X> components(const std::vector<double>& q, const std::vector<X>& a) {
    std::vector<X> w;
    for (std::size_t i = 0; i < N; ++i)
      if (i != largest(q)) w.push_back(a[i]);
    return w;
  }
  template <class X>
  static std::vector<X> exp(const std::vector<double>& p, const std::vector<X>& a) {
    const X t = dot_of(a, a), c = X(1.0) - X(0.5) * t, s = X(1.0) - X(1.0 / 6) * t;
    return plus(times(c, lifted<X>(p)), s, a);
  }
  static std::vector<double> settled(const std::vector<double>& q) { return times(1 / std::sqrt(dot_of(q, q)), q); }
  template <class X>
  static std::vector<X> log(const std::vector<X>& q, const std::vector<X>& p) {
    const X c = dot_of(q, p), f = acos(c) / sqrt(X(1.0) - c * c);
    return plus(times(f, p), X(-1.0) * f * c, q);
  }
  template <class X>
  static std::vector<X> value(const std::vector<X>& q) {
    return q;
  }
  template <class X>
  static std::vector<X> projected(const std::vector<X>& x) {
    return times(X(1.0) / sqrt(dot_of(x, x)), x);
  }
  template <class X>
  static X square(const std::vector<X>&, const std::vector<X>& d) {
    return dot_of(d, d);
  }
  template <class X>
  static X distance2(const std::vector<X>& q, const std::vector<X>& p) {
    const X angle = acos(dot_of(q, p));
    return angle * angle;
  }
};

struct Rotations : UnitVectors<4> {
  template <class X>
  static std::vector<X> log(const std::vector<X>& q, const std::vector<X>& p) {
    return plain(dot_of(q, p)) < 0 ? UnitVectors<4>::log(q, times(X(-1.0), p)) : UnitVectors<4>::log(q, p);
  }
  /// The rotation matrix.
  template <class X>
  static std::vector<X> value(const std::vector<X>& q) {
    const X two = X(2.0), one = X(1.0);
    const auto s = [&](int i, int j) { return two * q[static_cast<std::size_t>(i)] * q[static_cast<std::size_t>(j)]; };
    return {one - s(2, 2) - s(3, 3), s(1, 2) - s(0, 3), s(1, 3) + s(0, 2), s(1, 2) + s(0, 3),      one - s(1, 1) - s(3, 3),
            s(2, 3) - s(0, 1),       s(1, 3) - s(0, 2), s(2, 3) + s(0, 1), one - s(1, 1) - s(2, 2)};
  }
  /// Heron's iteration X <- (X + X^-T) / 2.
  template <class X>
  static std::vector<X> projected(std::vector<X> x) {
    for (int iteration = 0; iteration < 10; ++iteration) {
      std::vector<X> cof;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
          cof.push_back(x[3 * a + c] * x[3 * b + d] - x[3 * a + d] * x[3 * b + c]);
        }
      const X det = x[0] * cof[0] + x[1] * cof[1] + x[2] * cof[2];
      x = times(X(0.5), plus(x, X(1.0) / det, cof));
    }
    return x;
  }
  /// |axl(Q^T dQ)|^2 = |dQ|^2 / 2 in Frobenius' norm
  template <class X>
  static X square(const std::vector<X>&, const std::vector<X>& d) {
    return X(0.5) * dot_of(d, d);
  }
  template <class X>
  static X distance2(const std::vector<X>& q, const std::vector<X>& p) {
    const X angle = acos(X(0.5) * (dot_of(q, p) - X(1.0)));
    return angle * angle;
  }
};

/// The upper sheet of the hyperboloid.
template <int N>
struct Hyperboloid {
  static constexpr std::size_t dim = N;
  template <class X>
  static X product(const std::vector<X>& a, const std::vector<X>& b) {
    return dot_of(a, b) - X(2.0) * a[0] * b[0];
  }
  template <class X>
  static std::vector<X> tangent(const std::vector<double>& q, const std::vector<X>& w) {
    std::vector<X> a{X(0.0)};
    for (std::size_t i = 0; i < N; ++i) {
      a.push_back(w[i]);
      a[0] = a[0] + X(q[i + 1] / q[0]) * w[i];
    }
    return a;
  }
  template <class X>
  static std::vector<X> components(const std::vector<double>&, const std::vector<X>& a) {
    return {a.begin() + 1, a.end()};
  }
  template <class X>
  static std::vector<X> exp(const std::vector<double>& p, const std::vector<X>& a) {
    const X t = product(a, a), c = X(1.0) + X(0.5) * t, s = X(1.0) + X(1.0 / 6) * t;
    return plus(times(c, lifted<X>(p)), s, a);
  }
  static std::vector<double> settled(std::vector<double> q) {
    q[0] = std::sqrt(1 + dot_of(q, q) - q[0] * q[0]);
    return q;
  }
  template <class X>
  static X arcosh(const X& c) {
    using density_oracle::log;
    return log(c + sqrt(c * c - X(1.0)));
  }
  template <class X>
  static std::vector<X> log(const std::vector<X>& q, const std::vector<X>& p) {
    const X c = X(-1.0) * product(q, p), f = arcosh<X>(c) / sqrt(c * c - X(1.0));
    return plus(times(f, p), X(-1.0) * f * c, q);
  }
  template <class X>
  static std::vector<X> value(const std::vector<X>& q) {
    return q;
  }
  template <class X>
  static X square(const std::vector<X>&, const std::vector<X>& d) {
    return product(d, d);
  }
  template <class X>
  static X distance2(const std::vector<X>& q, const std::vector<X>& p) {
    const X c = X(-1.0) * product(q, p), d = arcosh<X>(c);
    return d * d;
  }
};

/// Symmetric positive definite matrices: log_Q(P) = Q log(Q^-1 P), |D|^2 = tr(P^-1 D P^-1 D).
template <int N>
struct PositiveMatrices {
  static constexpr std::size_t n = N, dim = N * (N + 1) / 2;
  template <class X>
  static std::vector<X> tangent(const std::vector<double>&, const std::vector<X>& w) {
    std::vector<X> a(n * n, X(0.0));
    for (std::size_t i = 0, k = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j, ++k) a[i * n + j] = a[j * n + i] = w[k];
    return a;
  }
  template <class X>
  static std::vector<X> components(const std::vector<double>&, const std::vector<X>& a) {
    std::vector<X> w;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) w.push_back(a[i * n + j]);
    return w;
  }
  template <class X>
  static std::vector<X> exp(const std::vector<double>& p, const std::vector<X>& a) {
    const std::vector<X> b = solved(lifted<X>(p), a, n), second = matrix_product(a, b, n), third = matrix_product(second, b, n);
    return plus(plus(plus(lifted<X>(p), X(1.0), a), X(0.5), second), X(1.0 / 6), third);
  }
  static std::vector<double> settled(const std::vector<double>& q) { return q; }
  template <class X>
  static std::vector<X> log(const std::vector<X>& q, const std::vector<X>& p) {
    return matrix_product(q, matrix_log(solved(q, p, n), n), n);
  }
  template <class X>
  static std::vector<X> value(const std::vector<X>& q) {
    return q;
  }
  template <class X>
  static X trace_of_square(const std::vector<X>& b) {
    X s = X(0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) s = s + b[i * n + j] * b[j * n + i];
    return s;
  }
  template <class X>
  static X square(const std::vector<X>& p, const std::vector<X>& d) {
    return trace_of_square(solved(p, d, n));
  }
  template <class X>
  static X distance2(const std::vector<X>& q, const std::vector<X>& p) {
    return trace_of_square(matrix_log(solved(q, p, n), n));
  }
};

/// R^N.
template <int N>
struct Linear {
  static constexpr std::size_t dim = N;
  template <class X>
  static std::vector<X> exp(const std::vector<double>& p, const std::vector<X>& a) {
    return plus(lifted<X>(p), X(1.0), a);
  }
  template <class X>
  static std::vector<X> value(const std::vector<X>& q) {
    return q;
  }
  template <class X>
  static std::vector<X> projected(const std::vector<X>& x) {
    return x;
  }
  template <class X>
  static X square(const std::vector<X>&, const std::vector<X>& d) {
    return dot_of(d, d);
  }
  template <class X>
  static X distance2(const std::vector<X>& q, const std::vector<X>& p) {
    const std::vector<X> d = plus(q, X(-1.0), p);
    return dot_of(d, d);
  }
};

/// Weighted mean: sum l_i log_q(p_i) = 0.
template <class G, class X>
std::vector<X> mean(const std::vector<std::vector<X>>& p, const std::vector<X>& l) {
  constexpr std::size_t k = G::dim;
  const auto equation = [&]<class Y>(const std::vector<double>& q, const std::vector<std::vector<Y>>& nodes, const std::vector<Y>& weights,
                                     const std::vector<Y>& w) {
    const std::vector<Y> moved = G::exp(q, G::tangent(q, w));
    std::vector<Y> sum(q.size(), Y(0.0));
    for (std::size_t i = 0; i < nodes.size(); ++i) sum = plus(sum, weights[i], G::log(moved, nodes[i]));
    return G::components(q, sum);
  };
  using J = Slope<double, static_cast<int>(k)>;
  std::vector<std::vector<J>> plain_nodes;
  std::vector<J> plain_weights, w(k);
  for (std::size_t i = 0; i < p.size(); ++i) {
    plain_weights.push_back(J(plain(l[i])));
    plain_nodes.emplace_back();
    for (const X& x : p[i]) plain_nodes.back().push_back(J(plain(x)));
  }
  for (std::size_t i = 0; i < k; ++i) w[i].d[i] = 1;
  // Between two nodes, since log is not differentiable at coinciding points in these formulas.
  std::vector<double> q;
  for (std::size_t c = 0; c < p[0].size(); ++c) q.push_back(plain_nodes[0][c].v + 0.1 * plain_nodes[1][c].v);
  q = G::settled(q);
  std::vector<double> jacobian(k * k);
  double error = 1;
  for (int iteration = 0; iteration < 40; ++iteration) {
    const std::vector<J> f = equation(q, plain_nodes, plain_weights, w);
    std::vector<double> step;
    for (std::size_t r = 0; r < k; ++r) {
      step.push_back(f[r].v);
      for (std::size_t c = 0; c < k; ++c) jacobian[r * k + c] = -f[r].d[c];
    }
    step = solved(jacobian, step, k);
    error = std::sqrt(dot_of(step, step));
    if (error < 1e-15) break;
    q = G::settled(G::exp(q, G::tangent(q, times(1 / std::max(1.0, 5 * error), step))));
  }
  if (!(error < 1e-13)) throw std::runtime_error("The oracle does not find the mean.");
  std::vector<double> identity(k * k, 0.0);
  for (std::size_t i = 0; i < k; ++i) identity[i * k + i] = 1;
  const std::vector<double> inverse = solved(jacobian, identity, k);
  // Two derivatives in the unknowns and one in space.
  std::vector<X> x(k, X(0.0));
  for (int step = 0; step < 3; ++step) {
    const std::vector<X> f = equation(q, p, l, x);
    for (std::size_t r = 0; r < k; ++r)
      for (std::size_t c = 0; c < k; ++c) x[r] = x[r] + X(inverse[r * k + c]) * f[c];
  }
  return G::exp(q, G::tangent(q, x));
}

/// \param p  nodes; \param l, dl  weights with their derivatives, which are constants of the element
template <class G, int D, class S>
std::vector<Slope<S, D>> interpolated(Rule rule, const std::vector<std::vector<S>>& p, const std::vector<double>& l,
                                      const std::vector<std::array<double, D>>& dl) {
  using X = Slope<S, D>;
  if constexpr (requires(std::vector<double> q) { G::tangent(q, q); })
    if (rule == Rule::geodesic) {
      std::vector<std::vector<X>> nodes;
      std::vector<X> weights;
      for (std::size_t i = 0; i < p.size(); ++i) {
        weights.emplace_back(l[i]);
        for (std::size_t a = 0; a < D; ++a) weights.back().d[a] = S(dl[i][a]);
        nodes.emplace_back();
        for (const S& x : p[i]) {
          nodes.back().emplace_back();
          nodes.back().back().v = x;
        }
      }
      return G::value(mean<G>(nodes, weights));
    }
  if constexpr (requires(std::vector<X> x) { G::projected(x); }) {
    std::vector<X> sum;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const std::vector<S> value = G::value(p[i]);
      sum.resize(value.size());
      for (std::size_t c = 0; c < value.size(); ++c) {
        sum[c].v += value[c] * l[i];
        for (std::size_t a = 0; a < D; ++a) sum[c].d[a] += value[c] * dl[i][a];
      }
    }
    return G::projected(sum);
  }
  return {};
}

/// One element: what does not depend on the unknowns, and its nodal values.
template <int D>
struct Element {
  Rule rule = Rule::projection;
  std::vector<double> weight;                          ///< [point], times the measure
  std::vector<Vec3<double>> x;                         ///< [point]
  std::vector<std::vector<double>> l;                  ///< [point][node]
  std::vector<std::vector<std::array<double, D>>> dl;  ///< [point][node]: derivatives in orthonormal directions
  std::vector<std::vector<double>> nodes;              ///< ambient values
  std::vector<std::vector<double>> frames;             ///< ambient x dim
  std::size_t dim = 0;

  std::size_t unknowns() const { return nodes.size() * dim; }
};

/// Geometry of a cell. Directions: the axes for solids and for cells in the plane z = 0, else Gram and Schmidt's of the tangents.
template <int D>
Element<D> element(const Mesh& mesh, const Cell& cell, int order, int degree) {
  const int dim = dimension(cell.kind);
  Element<D> e;
  const Quadrature& rule = quadrature(cell.kind, degree);
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    const GeometryJet g = geometry(mesh, cell, rule.points[q]);
    std::array<Vec3<double>, 3> t{Vec3<double>{{1, 0, 0}}, Vec3<double>{{0, 1, 0}}, Vec3<double>{{0, 0, 1}}};
    const bool flat = dim == 3 || (dim == 2 && g.d[0][2] == 0 && g.d[1][2] == 0);
    for (std::size_t a = 0; !flat && a < static_cast<std::size_t>(dim); ++a) {
      t[a] = g.d[a];
      for (std::size_t b = 0; b < a; ++b) t[a] -= dot(t[a], t[b]) * t[b];
      t[a] = (1 / std::sqrt(norm2(t[a]))) * t[a];
    }
    // jacobian[a][b] = t_a . d x / d xi_b; its determinant is the measure
    Mat3<double> jacobian = identity<double, 3>();
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) jacobian(a, b) = dot(t[static_cast<std::size_t>(a)], g.d[static_cast<std::size_t>(b)]);
    const Mat3<double> back = inverse(jacobian);
    const Shape shape = lagrange(cell.kind, order, rule.points[q]);
    e.weight.push_back(rule.weights[q] * std::fabs(determinant(jacobian)));
    e.x.push_back(g.x);
    e.l.push_back(shape.value);
    e.dl.emplace_back();
    for (const auto& d : shape.gradient) {
      auto& to = e.dl.back().emplace_back();
      for (std::size_t a = 0; a < D; ++a) {
        to[a] = 0;
        for (int b = 0; b < dim; ++b) to[a] += d[static_cast<std::size_t>(b)] * back(b, static_cast<int>(a));
      }
    }
  }
  return e;
}

/// Energy as a function of the tangent coordinates v around the nodal values (right to second order in v).
/// \param density  S(value, derivatives[direction], place)
template <class G, int D, class S, class Density>
S energy(const Element<D>& e, const S* v, const Density& density) {
  std::vector<std::vector<S>> nodes;
  for (std::size_t i = 0; i < e.nodes.size(); ++i) {
    std::vector<S> a;
    for (std::size_t c = 0; c < e.nodes[i].size(); ++c) {
      a.push_back(v[i * e.dim] * e.frames[i][c * e.dim]);
      for (std::size_t k = 1; k < e.dim; ++k) a[c] += v[i * e.dim + k] * e.frames[i][c * e.dim + k];
    }
    nodes.push_back(G::exp(e.nodes[i], a));
  }
  S sum = S(0.0);
  for (std::size_t q = 0; q < e.weight.size(); ++q) {
    const auto u = interpolated<G, D>(e.rule, nodes, e.l[q], e.dl[q]);
    std::vector<S> value;
    std::array<std::vector<S>, D> d;
    for (const auto& x : u) {
      value.push_back(x.v);
      for (std::size_t a = 0; a < D; ++a) d[a].push_back(x.d[a]);
    }
    sum += density(value, d, e.x[q]) * e.weight[q];
  }
  return sum;
}

}  // namespace karcher::density_oracle
