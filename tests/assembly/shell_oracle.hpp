#pragma once
/// \file
/// The energy of one Cosserat shell element, written straight from the formulas over any scalar (double, Jet, adouble): rotation matrices, Heron's
/// iteration
/// or the Riemannian mean with their derivatives, strain tensors, the density in tensors. Shares nothing with the fast kernel but the tables of the
/// basis.

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "karcher/assembly/shell_kernel.hpp"
#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/math/elementary.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/mesh/surface_geometry.hpp"

namespace karcher::shell_oracle {

inline double value_of(double x) { return x; }
template <class S>
double value_of(const S& x) {
  if constexpr (requires { x.v; }) {
    return value_of(x.v);
  } else {
    return x.value();
  }
}

/// One element with its reference geometry, its data and its configuration.
struct Element {
  shell::Tables tables;
  std::vector<SurfaceGeometry> geometry;  ///< at the quadrature points
  std::vector<double> weight;             ///< times sqrt(det a)
  std::vector<ShellMaterial<double>> material;
  ShellCoupling coupling = ShellCoupling::standard;
  Rule rule = Rule::projection;
  std::vector<Vec3<double>> m;
  std::vector<Vec<double, 4>> q;

  int unknowns() const { return 3 * static_cast<int>(m.size() + q.size()); }
};

inline shell::Tables make_tables(CellKind kind, int m_order, int r_order, const Quadrature& rule) {
  shell::Tables t;
  t.points = rule.size();
  t.m_nodes = node_count(kind, m_order);
  t.r_nodes = node_count(kind, r_order);
  for (const auto& xi : rule.points) {
    const Shape m = lagrange(kind, m_order, xi), r = lagrange(kind, r_order, xi);
    for (const auto& g : m.gradient) t.m_gradient.insert(t.m_gradient.end(), {g[0], g[1]});
    t.r_value.insert(t.r_value.end(), r.value.begin(), r.value.end());
    for (const auto& g : r.gradient) t.r_gradient.insert(t.r_gradient.end(), {g[0], g[1]});
  }
  return t;
}

inline Vec<double, 4> quaternion_of(const Vec3<double>& v) {
  const double angle = std::sqrt(norm2(v)), s = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
  return {{std::cos(angle / 2), s * v[0], s * v[1], s * v[2]}};
}

template <class S, class T>
Vec<S, 4> product(const Vec<T, 4>& a, const Vec<S, 4>& b) {
  return {{b[0] * a[0] - b[1] * a[1] - b[2] * a[2] - b[3] * a[3], b[1] * a[0] + b[0] * a[1] + b[3] * a[2] - b[2] * a[3],
           b[2] * a[0] - b[3] * a[1] + b[0] * a[2] + b[1] * a[3], b[3] * a[0] + b[2] * a[1] - b[1] * a[2] + b[0] * a[3]}};
}

/// q exp(v) to second order in v, which is all that second derivatives at v = 0 see; exact for constants v only if they vanish.
template <class S>
Vec<S, 4> moved(const Vec<double, 4>& q, const S* v) {
  return product(q, Vec<S, 4>{{1.0 - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.125, v[0] * 0.5, v[1] * 0.5, v[2] * 0.5}});
}

template <class S>
Mat3<S> rotation(const Vec<S, 4>& q) {
  const S xx = q[1] * q[1], yy = q[2] * q[2], zz = q[3] * q[3], xy = q[1] * q[2], xz = q[1] * q[3], yz = q[2] * q[3], wx = q[0] * q[1],
          wy = q[0] * q[2], wz = q[0] * q[3];
  return {{1.0 - (yy + zz) * 2.0, (xy - wz) * 2.0, (xz + wy) * 2.0, (xy + wz) * 2.0, 1.0 - (xx + zz) * 2.0, (yz - wx) * 2.0, (xz - wy) * 2.0,
           (yz + wx) * 2.0, 1.0 - (xx + yy) * 2.0}};
}

/// Value and derivatives in the reference coordinates of the interpolated rotation.
template <class S>
struct RotationJet {
  Mat3<S> value;
  std::array<Vec3<S>, 2> rate;  ///< axl(Q^T d_a Q)
};

/// Heron's iteration X <- (X + X^-T) / 2 for the polar factor of sum l_i R_i, and its derivative in both directions.
template <class S>
RotationJet<S> projected(const std::vector<Mat3<S>>& r, const double* l, const double* dl) {
  Mat3<S> x;
  std::array<Mat3<S>, 2> dx;
  for (std::size_t k = 0; k < 9; ++k) {
    x.e[k] = r[0].e[k] * l[0];
    for (std::size_t a = 0; a < 2; ++a) dx[a].e[k] = r[0].e[k] * dl[a];
    for (std::size_t i = 1; i < r.size(); ++i) {
      x.e[k] += r[i].e[k] * l[i];
      for (std::size_t a = 0; a < 2; ++a) dx[a].e[k] += r[i].e[k] * dl[2 * i + a];
    }
  }
  bool last = false;
  for (int iteration = 0; iteration < 40; ++iteration) {
    // Y = X^-T, Y' = -Y X'^T Y
    const Mat3<S> cof = cofactor(x);
    const S det = x(0, 0) * cof(0, 0) + x(0, 1) * cof(0, 1) + x(0, 2) * cof(0, 2), inverse_det = 1.0 / det;
    Mat3<S> y = cof;
    for (auto& e : y.e) e = e * inverse_det;
    for (auto& d : dx) {
      const Mat3<S> dy = y * transpose_times(d, y);
      for (std::size_t k = 0; k < 9; ++k) d.e[k] = (d.e[k] - dy.e[k]) * 0.5;
    }
    double change = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      change += std::pow(value_of(y.e[k]) - value_of(x.e[k]), 2);
      x.e[k] = (x.e[k] + y.e[k]) * 0.5;
    }
    // Quadratic, but the first and second derivatives come one and two steps behind the value.
    if (last) break;
    last = change < 1e-16;
  }
  RotationJet<S> jet;
  jet.value = x;
  for (std::size_t a = 0; a < 2; ++a) {
    const Mat3<S> w = transpose_times(x, dx[a]);
    jet.rate[a] = {{(w(2, 1) - w(1, 2)) * 0.5, (w(0, 2) - w(2, 0)) * 0.5, (w(1, 0) - w(0, 1)) * 0.5}};
  }
  return jet;
}

/// Rotation vector of a unit quaternion: the square root is taken five times, the rest is the series of the arc sine.
template <class S>
Vec3<S> log_of(Vec<S, 4> p) {
  using std::sqrt;
  if (value_of(p[0]) < 0)
    for (int c = 0; c < 4; ++c) p[c] = -p[c];
  for (int k = 0; k < 5; ++k) {
    const S scale = 1.0 / sqrt((p[0] + 1.0) * 2.0);
    p[0] = (p[0] + 1.0) * scale;
    for (int c = 1; c < 4; ++c) p[c] = p[c] * scale;
  }
  const S x = p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
  const S series = ((((((x * (231.0 / 13312) + 63.0 / 2816) * x + 35.0 / 1152) * x + 5.0 / 112) * x + 3.0 / 40) * x + 1.0 / 6) * x + 1.0) * 64.0;
  return {{series * p[1], series * p[2], series * p[3]}};
}

/// Inverse of the right Jacobian of the exponential map: d log(exp(theta) exp(v)) / dv at v = 0 (Chirikjian 2012), to all orders by the cotangent
/// series.
template <class S>
Mat3<S> inverse_right_jacobian(const Vec3<S>& t) {
  const S tau = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  // (1 - x cot x) / (4 x^2) with x^2 = tau / 4: sum over the poles 1 / (k pi)^2, by their closed differences
  S beta = S(0.0);
  constexpr int poles = 6;
  const double pi = std::acos(-1.0);
  for (int k = 1; k <= poles; ++k) beta += 2.0 / (std::pow(2 * pi * k, 2) - tau);
  // the tail sum_{k > poles} 2 / ((2 pi k)^2 - tau) = sum_n 2 tau^n sum_k (2 pi k)^(-2n-2)
  S power = S(1.0);
  for (int n = 0; n < 12; ++n) {
    double zeta = 0;
    const int s = 2 * n + 2, cut = 40;
    for (int k = poles + 1; k < cut; ++k) zeta += std::pow(2 * pi * k, -s);
    // Euler-Maclaurin for k >= cut
    const double c = 2 * pi * cut;
    zeta += std::pow(c, -s) * (cut / double(s - 1) + 0.5 + s / (12.0 * cut) - s * (s + 1.0) * (s + 2.0) / (720.0 * cut * cut * cut) +
                               s * (s + 1.0) * (s + 2.0) * (s + 3.0) * (s + 4.0) / (30240.0 * std::pow(cut, 5)));
    beta += power * (2 * zeta);
    power = power * tau;
  }
  Mat3<S> d = hat(t);
  for (auto& e : d.e) e = e * 0.5;
  const Mat3<S> h = hat(t), hh = h * h;
  for (std::size_t k = 0; k < 9; ++k) d.e[k] += hh.e[k] * beta;
  for (int i = 0; i < 3; ++i) d(i, i) += 1.0;
  return d;
}

/// Weighted Riemannian mean: sum l_i log(Q^T R_i) = 0 by Newton's method in S, and G k_a = sum l_{i,a} theta_i.
template <class S>
RotationJet<S> averaged(const std::vector<Vec<S, 4>>& r, const double* l, const double* dl) {
  Vec<S, 4> q;
  for (int c = 0; c < 4; ++c) q[c] = S(0.0);
  for (std::size_t i = 0; i < r.size(); ++i) {
    double side = 0;
    for (int c = 0; c < 4; ++c) side += value_of(r[i][c]) * value_of(r[0][c]);
    for (int c = 0; c < 4; ++c) q[c] += r[i][c] * (side < 0 ? -l[i] : l[i]);
  }
  using std::sqrt;
  const auto normalise = [](Vec<S, 4>& x) {
    const S scale = 1.0 / sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    for (int c = 0; c < 4; ++c) x[c] = x[c] * scale;
  };
  normalise(q);
  RotationJet<S> jet;
  int settled = 0;
  for (int iteration = 0; iteration < 30; ++iteration) {
    Vec3<S> sum{{S(0.0), S(0.0), S(0.0)}};
    std::array<Vec3<S>, 2> slope{sum, sum};
    Mat3<S> g = outer(sum, sum);
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Vec<S, 4> conjugate{{q[0], -q[1], -q[2], -q[3]}};
      const Vec3<S> t = log_of(product(conjugate, r[i]));
      const Mat3<S> d = inverse_right_jacobian(t);
      for (int c = 0; c < 3; ++c) {
        sum[c] += t[c] * l[i];
        for (std::size_t a = 0; a < 2; ++a) slope[a][c] += t[c] * dl[2 * i + a];
      }
      for (std::size_t k = 0; k < 9; ++k) g.e[k] += d.e[k] * l[i];
    }
    const Mat3<S> inverse_g = inverse(g);
    for (std::size_t a = 0; a < 2; ++a) jet.rate[a] = inverse_g * slope[a];
    if (settled == 3) break;  // the first and second derivatives come one and two steps behind the value
    const Vec3<S> w = inverse_g * sum;
    double step = 0;
    for (int c = 0; c < 3; ++c) step += std::pow(value_of(w[c]), 2);
    q = product(q, Vec<S, 4>{{S(1.0), w[0] * 0.5, w[1] * 0.5, w[2] * 0.5}});
    normalise(q);
    if (step < 1e-28) ++settled;
  }
  jet.value = rotation(q);
  return jet;
}

/// Sums of the parts over the quadrature points. \param m  nodes of the deformation \param q  unit quaternions of the rotation nodes
template <class S>
ShellEnergy<S> energy_parts(const Element& element, const std::vector<Vec3<S>>& m, const std::vector<Vec<S, 4>>& q) {
  const shell::Tables& t = element.tables;
  std::vector<Mat3<S>> r;
  for (const auto& x : q) r.push_back(rotation(x));
  ShellEnergy<S> sum{S(0.0), S(0.0), S(0.0)};
  for (std::size_t p = 0; p < static_cast<std::size_t>(t.points); ++p) {
    const double *dm = t.m_gradient.data() + 2 * p * m.size(), *l = t.r_value.data() + p * q.size(), *dl = t.r_gradient.data() + 2 * p * q.size();
    const RotationJet<S> jet = element.rule == Rule::projection ? projected(r, l, dl) : averaged(q, l, dl);
    const SurfaceGeometry& g = element.geometry[p];
    // E = sum_a Q^T d_a m (x) a^a - a, K = sum_a k_a (x) a^a
    Mat3<S> e, k;
    for (std::size_t a = 0; a < 2; ++a) {
      Vec3<S> d;
      for (int c = 0; c < 3; ++c) {
        d[c] = m[0][c] * dm[a];
        for (std::size_t i = 1; i < m.size(); ++i) d[c] += m[i][c] * dm[2 * i + a];
      }
      const Vec3<S> body = transpose_times(jet.value, d);
      for (int c = 0; c < 3; ++c)
        for (int s = 0; s < 3; ++s) {
          if (a == 0) {
            e(c, s) = body[c] * g.dual[a][s];
            k(c, s) = jet.rate[a][c] * g.dual[a][s];
          } else {
            e(c, s) += body[c] * g.dual[a][s];
            k(c, s) += jet.rate[a][c] * g.dual[a][s];
          }
        }
    }
    for (int c = 0; c < 3; ++c)
      for (int s = 0; s < 3; ++s) e(c, s) -= (c == s ? 1.0 : 0.0) - g.normal[c] * g.normal[s];
    const ShellEnergy<S> w = cosserat_shell_density(e, k, g.b, g.c, g.normal, element.material[p], element.coupling);
    sum.membrane += w.membrane * element.weight[p];
    sum.bending += w.bending * element.weight[p];
    sum.curvature += w.curvature * element.weight[p];
  }
  return sum;
}

/// Energy as a function of the tangent coordinates x around the element's configuration (to second order in x).
template <class S>
S energy(const Element& element, const S* x) {
  std::vector<Vec3<S>> m;
  std::vector<Vec<S, 4>> q;
  for (const auto& y : element.m) {
    m.push_back({{x[0] + y[0], x[1] + y[1], x[2] + y[2]}});
    x += 3;
  }
  for (const auto& y : element.q) {
    q.push_back(moved(y, x));
    x += 3;
  }
  return energy_parts(element, m, q).total();
}

/// Random curved element: nodes of a bent and sheared cell with random perturbations, random rotations of about `spread` radian per axis around a
/// common one.
inline Element random_element(CellKind kind, int m_order, int r_order, std::mt19937& generator, double spread = 0.3, int degree = 5) {
  std::normal_distribution<double> normal;
  const auto vector = [&](double scale) { return Vec3<double>{{scale * normal(generator), scale * normal(generator), scale * normal(generator)}}; };
  Element e;
  const Quadrature& rule = quadrature(kind, degree);
  e.tables = make_tables(kind, m_order, r_order, rule);
  // cubic geometry, so that the curvature varies over the element
  std::vector<Vec3<double>> nodes;
  for (const auto& xi : lagrange_nodes(kind, 3)) {
    const Vec3<double> bent{{xi[0] + 0.2 * xi[1], xi[1] - 0.1 * xi[0] * xi[1], 0.3 * xi[0] * xi[0] - 0.2 * xi[1] * xi[1] + 0.15 * xi[0] * xi[1]}};
    nodes.push_back(bent + vector(0.004));
  }
  for (std::size_t p = 0; p < rule.weights.size(); ++p) {
    const Shape s = lagrange(kind, 3, rule.points[p]);
    GeometryJet jet;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      jet.x += s.value[n] * nodes[n];
      for (std::size_t a = 0; a < 3; ++a) jet.d[a] += s.gradient[n][a] * nodes[n];
      for (std::size_t a = 0; a < 6; ++a) jet.dd[a] += s.hessian[n][a] * nodes[n];
    }
    e.geometry.push_back(surface_geometry(jet));
    e.weight.push_back(rule.weights[p] * e.geometry.back().area);
    // constants vary from point to point, like expressions of the place do
    const double f = 1 + 0.1 * jet.x[0];
    e.material.push_back({0.1 * f, 1.3 / f, 0.9 * f, 0.4 + 0.1 * jet.x[1], 0.07, {1.1, 0.8, 0.6}});
  }
  const auto common = quaternion_of(vector(1.0));
  const Mat3<double> turn = rotation(common);
  for (const auto& xi : lagrange_nodes(kind, m_order)) {
    const Vec3<double> x{{1.1 * xi[0] + 0.25 * xi[1], 0.95 * xi[1], 0.25 * xi[0] * xi[0]}};
    e.m.push_back(turn * (x + vector(0.05)));
  }
  for (int i = 0; i < e.tables.r_nodes; ++i) {
    auto q = product(common, quaternion_of(vector(spread)));
    if (normal(generator) < 0)
      for (int c = 0; c < 4; ++c) q[c] = -q[c];
    e.q.push_back(q);
  }
  return e;
}

/// Elements side by side, as the kernel wants them; fewer than native_width are repeated.
struct Lanes {
  AlignedVector<double> points, m, q;

  explicit Lanes(const std::vector<Element>& elements) {
    constexpr int W = native_width;
    const shell::Tables& t = elements.front().tables;
    points.resize(static_cast<std::size_t>(t.points * shell::point_entries * W));
    m.resize(static_cast<std::size_t>(t.m_nodes * 3 * W));
    q.resize(static_cast<std::size_t>(t.r_nodes * 4 * W));
    for (int lane = 0; lane < W; ++lane) {
      const Element& e = elements[static_cast<std::size_t>(lane) % elements.size()];
      for (int p = 0; p < t.points; ++p) {
        const auto at = static_cast<std::size_t>(p);
        const SurfaceGeometry& g = e.geometry[at];
        shell::store_point(points.data() + p * shell::point_entries * W, lane, g.jacobian(), g.frame,
                           shell_form(g.curvature[0], g.curvature[1], e.material[at], e.coupling), e.weight[at]);
      }
      set_configuration(e, lane);
    }
  }
  void set_configuration(const Element& e, int lane) {
    for (std::size_t i = 0; i < e.m.size(); ++i)
      for (int c = 0; c < 3; ++c) m[(3 * i + static_cast<std::size_t>(c)) * native_width + static_cast<std::size_t>(lane)] = e.m[i][c];
    for (std::size_t i = 0; i < e.q.size(); ++i)
      for (int c = 0; c < 4; ++c) q[(4 * i + static_cast<std::size_t>(c)) * native_width + static_cast<std::size_t>(lane)] = e.q[i][c];
  }
};

inline BatchResult evaluate(const Element& like, const Lanes& lanes, Want want) {
  BatchResult out;
  const auto n = static_cast<std::size_t>(like.unknowns());
  out.gradient.resize(n * native_width);
  out.hessian.resize(n * n * native_width);
  shell::kernel(like.rule, want)(like.tables, lanes.points.data(), lanes.m.data(), lanes.q.data(),
                                 {out.energy.data(), out.trouble.data(), out.gradient.data(), out.hessian.data()});
  return out;
}

}  // namespace karcher::shell_oracle
