#pragma once
/// \file
/// Weighted means of unit vectors (S^n, SU(2), SO(3) as quaternions), with both variations in closed form: the general construction of weighted_mean.hpp for
/// two-point functions that depend on the angle only.
///
/// The mean q maximises sum l_i phi(<q, p_i>). phi' = a, the arc ratio arccos(c)/sqrt(1 - c^2): the Riemannian centre of mass (phi = -arccos^2/2); phi' = c: on
/// SO(3) the mean of rotation matrices in Frobenius' norm, the projection rule. In the projection (gnomonic) chart q(w) = (q + E w)/|q + E w| with b = E^T p,
/// c = <q, p>, psi(w) = phi((c + b.w) (1 + |w|^2)^(-1/2)) has at w = 0 the symmetric derivatives (phi_n the n-th derivative of phi at c)
///
///   psi'[x]      = phi_1 bx
///   psi''[xy]    = phi_2 bx by - phi_1 c xy
///   psi'''[xyz]  = phi_3 bx by bz - kappa (xy bz + xz by + yz bx),                                  kappa  = c phi_2 + phi_1
///   psi''''[xyzt] = phi_4 bx by bz bt - kappa' (xy bz bt + five more) + c kappa* (xy zt + two more),  kappa' = c phi_3 + 2 phi_2, kappa* = c phi_2 + 3 phi_1
///
/// and a moving p(v) = (1 - |v|^2/2) p + F v changes c by e.v - c |v|^2/2, e = F^T q, and b by B v - b |v|^2/2, B = E^T F. With theta = psi' all terms of
/// weighted_mean.hpp follow by differentiating these polynomials. Lengths are those of the ambient space; a metric scaled by s^2 (SO(3): s = 2) multiplies
/// tangent coordinates by s.

#include <vector>

#include "karcher/interpolation/implicit_mean.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

/// phi_1, ..., phi_n at c.
struct ArcPotential {
  static constexpr bool is_geodesic = true;
  template <int N, class T>
  static std::array<T, static_cast<std::size_t>(N)> derivatives(const T& c) {
    return arc_detail::ArcRatio{}.template derivatives<N - 1>(c);
  }
};
struct SquarePotential {
  static constexpr bool is_geodesic = false;
  template <int N, class T>
  static std::array<T, static_cast<std::size_t>(N)> derivatives(const T& c) {
    std::array<T, static_cast<std::size_t>(N)> phi{};
    for (auto& x : phi) x = T(0.0);
    phi[0] = c;
    phi[1] = T(1.0);
    return phi;
  }
};

/// M: a manifold with M::unit_scale (manifold.hpp).
template <class M, class Potential, int D, class T>
class UnitVectorMean {
 public:
  using Manifold = M;
  using Chart = ProjectionChart;
  static constexpr int k = M::dim, N = M::ambient, L = local_dim<M, D>;
  static constexpr double scale = M::unit_scale;

  /// As WeightedMean::begin_cell: false in lanes whose values are too far apart for a unique mean.
  MaskOf<T> begin_cell(const Point<M, T>* nodes, int count) {
    const auto n = static_cast<std::size_t>(count);
    nodes_.resize(n);
    frames_.resize(n);
    b_.resize(n);
    c_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      T sign = T(1.0);
      if constexpr (M::unit_scale == 2) sign = select(dot(nodes[0], nodes[i]) < T(0.0), T(-1.0), T(1.0));
      nodes_[i] = sign * nodes[i];
      frames_[i] = (T(scale) * sign) * M::frame(nodes[i]);
    }
    start_ = nodes_[0];
    const std::vector<double> equal(n, 1.0 / count);
    MaskOf<T> ok = find(equal.data(), start_);
    if constexpr (Potential::is_geodesic) ok = ok & implicit_mean::close_to<M>(start_, nodes_.data(), count);
    return ok;
  }

  /// Value and derivatives. False in lanes where the iteration does not arrive at a maximiser (G positive definite).
  MaskOf<T> evaluate(const Point<M, T>*, const Weights<D, T>& weights) {
    weights_ = weights;
    // The projected mean is close to every other one, except where the values are far apart.
    Point<M, T> x;
    for (std::size_t i = 0; i < nodes_.size(); ++i) x += weights.l[i] * signed_node(i, start_);
    const T x2 = norm2(x);
    const auto good = x2 > T(0.25);
    const T r = T(1.0) / sqrt(select(good, x2, T(1.0)));
    for (int c = 0; c < N; ++c) q_[c] = select(good, r * x[c], start_[c]);
    MaskOf<T> ok = find(weights.l, q_);
    jet_.value = q_;
    frame_ = M::frame(q_);
    if constexpr (D > 0) {
      look_from(q_);
      Mat<T, k, D> right;
      Mat<T, k, k> g;
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const auto phi = Potential::template derivatives<2>(c_[i]);
        subtract_second(g, T(weights.l[i]), phi, i);
        for (std::size_t a = 0; a < D; ++a) {
          const T s = weights.dl[i][a] * phi[0];
          for (int c = 0; c < k; ++c) right(c, static_cast<int>(a)) += s * b_[i][c];
        }
      }
      ok = ok & solve_in_place(g, right);
      for (int a = 0; a < D; ++a) {
        k_[static_cast<std::size_t>(a)] = column(right, a);
        jet_.d[static_cast<std::size_t>(a)] = frame_ * local_derivative(static_cast<std::size_t>(a));
      }
    }
    return ok;
  }
  const FieldJet<M, D, T>& jet() const { return jet_; }
  const Mat<T, N, k>& frame() const { return frame_; }
  Vec<T, L> local_coordinates() const {
    Vec<T, L> y;
    for (std::size_t a = 0; a < D; ++a) {
      const auto ka = local_derivative(a);
      for (int c = 0; c < k; ++c) y[static_cast<int>(1 + a) * k + c] = ka[c];
    }
    return y;
  }

  void linearize(const Point<M, T>* nodes, std::vector<Mat<T, L, k>>& maps);
  void add_second_variation(const Point<M, T>* nodes, const Vec<T, L>& f, Mat<T, k, k>* blocks);

 private:
  using Matrix = Mat<T, k, k>;
  using Vector = Vec<T, k>;

  /// What the derivatives of psi need of a node.
  struct Node {
    std::array<T, 4> phi;
    T kappa, kappa1, kappa2;  ///< kappa, kappa', c kappa*
    Vector e;
    Matrix B;
  };

  Vector local_derivative(std::size_t a) const { return T(scale) * k_[a]; }
  /// The representative on the side of q where p and -p are the same point.
  Point<M, T> signed_node(std::size_t i, const Point<M, T>& q) const {
    if constexpr (M::unit_scale == 2) {
      return select(dot(q, nodes_[i]) < T(0.0), T(-1.0), T(1.0)) * nodes_[i];
    } else {
      return nodes_[i];
    }
  }
  /// Frame at q, b and c of all nodes.
  void look_from(const Point<M, T>& q) {
    unit_frame_ = T(scale) * M::frame(q);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Point<M, T> p = signed_node(i, q);
      b_[i] = transpose_times(unit_frame_, p);
      c_[i] = dot(q, p);
    }
  }
  /// g -= l psi''
  template <class Phi>
  void subtract_second(Matrix& g, const T& l, const Phi& phi, std::size_t i) const {
    const T bb = l * phi[1], one = l * phi[0] * c_[i];
    for (int r = 0; r < k; ++r) {
      const T s = bb * b_[i][r];
      for (int c = 0; c < k; ++c) g(r, c) -= s * b_[i][c];
      g(r, r) += one;
    }
  }
  MaskOf<T> find(const double* l, Point<M, T>& q);

  static void add_outer(Matrix& m, const T& s, const Vector& a, const Vector& b) {
    for (int r = 0; r < k; ++r) {
      const T x = s * a[r];
      for (int c = 0; c < k; ++c) m(r, c) += x * b[c];
    }
  }
  static void add_symmetric_outer(Matrix& m, const T& s, const Vector& a, const Vector& b) {
    add_outer(m, s, a, b);
    add_outer(m, s, b, a);
  }
  static void add_identity(Matrix& m, const T& s) {
    for (int r = 0; r < k; ++r) m(r, r) += s;
  }
  /// m += s psi'''[x]
  void add_third(Matrix& m, const T& s, std::size_t i, const Vector& x) const {
    const Node& n = node_[i];
    const T bx = dot(b_[i], x), kappa = -(s * n.kappa);
    add_outer(m, s * n.phi[2] * bx, b_[i], b_[i]);
    add_symmetric_outer(m, kappa, b_[i], x);
    add_identity(m, kappa * bx);
  }
  /// m += s d/dv psi''[x]
  void add_mixed(Matrix& m, const T& s, std::size_t i, const Vector& x, const Vector& Btx) const {
    const Node& n = node_[i];
    const T bx = dot(b_[i], x), p2 = s * n.phi[1], p2bx = p2 * bx, p3bx = s * n.phi[2] * bx, kappa = s * n.kappa;
    for (int r = 0; r < k; ++r) {
      const T e = p3bx * b_[i][r] - kappa * x[r], t = p2 * b_[i][r];
      for (int c = 0; c < k; ++c) m(r, c) += e * n.e[c] + t * Btx[c] + p2bx * n.B(r, c);
    }
  }

  Weights<D, T> weights_;
  Point<M, T> start_, q_;
  FieldJet<M, D, T> jet_;
  Mat<T, N, k> frame_, unit_frame_;
  std::array<Vector, D> k_{};
  std::vector<Point<M, T>> nodes_;
  std::vector<Mat<T, N, k>> frames_;  // orthonormal in the ambient space
  std::vector<Vector> b_;
  std::vector<T> c_;
  std::vector<Node> node_;
  Matrix inverse_;             // of G
  std::array<Matrix, D> u_{};  // U_a
  std::vector<std::array<Matrix, 1 + D>> variation_;
  std::vector<Matrix> wv_;
  std::vector<std::array<Matrix, D>> mixed_;
};

// ---------------------------------------------------------------------------------------------------------------------------------------------------

template <class M, class Potential, int D, class T>
MaskOf<T> UnitVectorMean<M, Potential, D, T>::find(const double* l, Point<M, T>& q) {
  constexpr int max_iterations = 40;
  MaskOf<T> done = T(1.0) < T(0.0);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    look_from(q);
    Matrix g;
    Mat<T, k, 1> residual;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (l[i] == 0) continue;
      const auto phi = Potential::template derivatives<2>(c_[i]);
      subtract_second(g, T(l[i]), phi, i);
      const T s = l[i] * phi[0];
      for (int c = 0; c < k; ++c) residual(c, 0) += s * b_[i][c];
    }
    q += unit_frame_ * implicit_mean::newton_step(g, residual, 1e-17, done);
    q = (T(1.0) / sqrt(norm2(q))) * q;
    if (all(done)) break;
  }
  return done;
}

template <class M, class Potential, int D, class T>
void UnitVectorMean<M, Potential, D, T>::linearize(const Point<M, T>*, std::vector<Mat<T, L, k>>& maps) {
  const std::size_t count = nodes_.size();
  variation_.resize(count);
  node_.resize(count);
  Matrix g;
  for (auto& u : u_) u = {};
  if constexpr (D == 0) look_from(q_);
  for (std::size_t i = 0; i < count; ++i) {
    const T l = T(weights_.l[i]), c = c_[i];
    Node& n = node_[i];
    n.phi = Potential::template derivatives<4>(c);
    n.kappa = c * n.phi[1] + n.phi[0];
    n.kappa1 = c * n.phi[2] + T(2.0) * n.phi[1];
    n.kappa2 = c * (n.kappa + T(2.0) * n.phi[0]);
    T sign = T(1.0);
    if constexpr (M::unit_scale == 2) sign = select(dot(q_, nodes_[i]) < T(0.0), T(-1.0), T(1.0));
    n.e = sign * transpose_times(frames_[i], q_);
    n.B = sign * transpose_times(unit_frame_, frames_[i]);
    subtract_second(g, l, n.phi, i);
    // theta_v
    Matrix v = n.phi[0] * n.B;
    add_outer(v, n.phi[1], b_[i], n.e);
    variation_[i][0] = l * v;
    for (std::size_t a = 0; a < D; ++a) {
      subtract_second(u_[a], -weights_.dl[i][a], n.phi, i);
      add_third(u_[a], l, i, k_[a]);
      variation_[i][1 + a] = weights_.dl[i][a] * v;
      add_mixed(variation_[i][1 + a], l, i, k_[a], transpose_times(n.B, k_[a]));
    }
  }
  inverse_ = identity<T, k>();
  solve_in_place(g, inverse_);
  implicit_mean::solve_variations(inverse_, u_, variation_, maps);
}

template <class M, class Potential, int D, class T>
void UnitVectorMean<M, Potential, D, T>::add_second_variation(const Point<M, T>*, const Vec<T, L>& f, Mat<T, k, k>* blocks) {
  const std::size_t count = nodes_.size();
  // adjoints; G is symmetric
  const T unit = T(1.0 / scale);  // second derivatives of scaled coordinates by scaled coordinates
  std::array<Vector, D> mu;
  Vector eta;
  for (int c = 0; c < k; ++c) eta[c] = unit * f[c];
  for (std::size_t a = 0; a < D; ++a) {
    Vector fa;
    for (int c = 0; c < k; ++c) fa[c] = unit * f[static_cast<int>(1 + a) * k + c];
    mu[a] = inverse_ * fa;
    eta += u_[a] * mu[a];
  }
  eta = inverse_ * eta;

  Matrix sum_ww;
  std::array<Matrix, D> sum_n{};
  wv_.assign(count, {});
  mixed_.assign(count, {});
  for (std::size_t i = 0; i < count; ++i) {
    const Node& n = node_[i];
    const Vector& b = b_[i];
    const T l = T(weights_.l[i]);
    // s = psi'[omega] + l sum_a psi''[mu_a, k_a] as a function of (w, v_i)
    Vector omega = l * eta;
    for (std::size_t a = 0; a < D; ++a) omega += weights_.dl[i][a] * mu[a];
    const Vector Bomega = transpose_times(n.B, omega);
    const T bomega = dot(b, omega);
    add_third(sum_ww, T(1.0), i, omega);
    add_mixed(wv_[i], T(1.0), i, omega, Bomega);
    Matrix vv;
    T vv_ee = n.phi[2] * bomega, vv_one = -(n.kappa * bomega);
    Vector e_side = n.phi[1] * Bomega;
    for (std::size_t a = 0; a < D; ++a) {
      const Vector &m = mu[a], &ka = k_[a];
      const Vector Bm = transpose_times(n.B, m), Bk = transpose_times(n.B, ka);
      const T bm = dot(b, m), bk = dot(b, ka), mk = dot(m, ka), bmbk = bm * bk;
      // psi''''[m, k]
      const Vector both = bk * m + bm * ka;
      add_outer(sum_ww, l * (n.phi[3] * bmbk - n.kappa1 * mk), b, b);
      add_symmetric_outer(sum_ww, -(l * n.kappa1), b, both);
      add_identity(sum_ww, l * (n.kappa2 * mk - n.kappa1 * bmbk));
      add_symmetric_outer(sum_ww, l * n.kappa2, m, ka);
      // d/dv psi'''[m, k] as a row vector of v for every x
      const Vector Bboth = bk * Bm + bm * Bk;
      const T p3 = l * n.phi[2], kappa = l * n.kappa, straight = p3 * bmbk - kappa * mk, turned = l * (n.phi[3] * bmbk - n.kappa1 * mk);
      for (int r = 0; r < k; ++r) {
        const T e = turned * b[r] - l * n.kappa1 * both[r], t = p3 * b[r], km = kappa * m[r], kk = kappa * ka[r];
        for (int c = 0; c < k; ++c) wv_[i](r, c) += e * n.e[c] + t * Bboth[c] + straight * n.B(r, c) - km * Bk[c] - kk * Bm[c];
      }
      // d2/dv2 psi''[m, k]
      vv_ee += turned;
      vv_one += l * (n.kappa * c_[i] * mk - (c_[i] * n.phi[2] + T(2.0) * n.phi[1]) * bmbk);
      e_side += p3 * Bboth;
      add_symmetric_outer(vv, l * n.phi[1], Bm, Bk);

      add_third(sum_n[a], l, i, m);
      add_mixed(mixed_[i][a], l, i, m, Bm);
    }
    add_outer(vv, vv_ee, n.e, n.e);
    add_symmetric_outer(vv, T(1.0), n.e, e_side);
    add_identity(vv, vv_one);
    blocks[i * count + i] += vv;
  }
  implicit_mean::add_products(sum_ww, sum_n, variation_, wv_, mixed_, blocks);
}

}  // namespace karcher
