#pragma once
/// \file
/// The body of the shell kernel, shared by both interpolation rules. Notation and derivation: docs/cosserat-kernel.md.
///
/// What the solver needs of an element is sum_p [ A^T C A + second variation ]. In the node loop every rotation node i gets two 9 x 3 matrices a_i
/// and b_i such
/// that its blocks are H_ij = a_i^T w_j + w_i^T a_j, w_j = 1/2 M a_j + b_j; this rank-18 update is a third of all work and is done point by point in
/// register
/// blocks of 3 x 6. The blocks with deformation nodes need only a few numbers per point and are summed over a chunk of points at its end.

#include <limits>

#include "assembly/shell_algebra.hpp"
#include "karcher/assembly/shell_kernel.hpp"

/// All that the function calls becomes part of it; not under the address sanitizer, which would make that a matter of minutes for the compiler.
#if defined(__SANITIZE_ADDRESS__)
#define KARCHER_FLATTEN
#else
#define KARCHER_FLATTEN [[gnu::flatten]]
#endif

namespace karcher::shell {

/// Strain E_cb and K_cb in the principal frame, and the stresses f = C z.
template <class T>
struct Strain {
  Vec3<T> e[2], k[2];
};

template <class T>
Strain<T> stress(const ShellForm<T>& c, const Strain<T>& z) {
  const T e11 = z.e[0][0], e21 = z.e[0][1], e31 = z.e[0][2], e12 = z.e[1][0], e22 = z.e[1][1], e32 = z.e[1][2];
  const T k11 = z.k[0][0], k21 = z.k[0][1], k31 = z.k[0][2], k12 = z.k[1][0], k22 = z.k[1][1], k32 = z.k[1][2];
  const auto& a = c.a;
  const auto& b = c.b;
  Strain<T> f;
  f.e[0] = {{a[0] * e11 + a[1] * e22 + a[2] * k21 + a[3] * k12, b[1] * e12 + b[4] * e21 + b[5] * k22 + b[6] * k11, c.s[0] * e31}};
  f.e[1] = {{b[0] * e12 + b[1] * e21 + b[2] * k22 + b[3] * k11, a[1] * e11 + a[4] * e22 + a[5] * k21 + a[6] * k12, c.s[1] * e32}};
  f.k[0] = {{b[3] * e12 + b[6] * e21 + b[8] * k22 + b[9] * k11, a[2] * e11 + a[5] * e22 + a[7] * k21 + a[8] * k12, c.s[2] * k31}};
  f.k[1] = {{a[3] * e11 + a[6] * e22 + a[8] * k21 + a[9] * k12, b[2] * e12 + b[5] * e21 + b[7] * k22 + b[8] * k11, c.s[3] * k32}};
  return f;
}

/// The matrices of the second variation at a point that do not depend on the node.
template <class T>
struct PointOperator {
  Sym3<T> ww;      ///< 1/2 of M on (w, w)
  T wk[4][3];      ///< M on w and K21, K12, K22, K11; the other two rates do not couple
  T kk[8];         ///< 1/2 of C on (K21, K12), (K22, K11) and on K31, K32
  T m_w[2][9];     ///< [a]: from w to the force at d_a m
  T m_k[2][4][3];  ///< [a]: from K21, K12, K22, K11 to the force at d_a m
};

template <class T>
void build(PointOperator<T>& o, const ShellForm<T>& c, const Vec3<T> (&e)[2], const Strain<T>& f, const Mat3<T>& qf, const T (&j)[2][2],
           const Sym3<T>& value_block) {
  const auto& a = c.a;
  const auto& b = c.b;
  // C_ee [e]: the rows of the strains E_c1 and E_c2 under a rotation of the frame
  const T x0 = e[0][0], y0 = e[0][1], z0 = e[0][2], x1 = e[1][0], y1 = e[1][1], z1 = e[1][2];
  const Mat3<T> c0{
      {a[1] * z1, -(a[0] * z0), a[0] * y0 - a[1] * x1, b[4] * z0, -(b[1] * z1), b[1] * y1 - b[4] * x0, -(c.s[0] * y0), c.s[0] * x0, T(0.0)}};
  const Mat3<T> c1{
      {b[1] * z0, -(b[0] * z1), b[0] * y1 - b[1] * x0, a[4] * z1, -(a[1] * z0), a[1] * y0 - a[4] * x1, -(c.s[1] * y1), c.s[1] * x1, T(0.0)}};

  Mat3<T> ww = -(hat_times(e[0], c0) + hat_times(e[1], c1)) + outer(f.e[0], e[0]) + outer(f.e[1], e[1]);
  const T work = dot(f.e[0], e[0]) + dot(f.e[1], e[1]);
  const Sym3<T> s = symmetric_part(ww);
  const T half(0.5);
  o.ww = {half * (s.xx + value_block.xx - work), half * (s.xy + value_block.xy), half * (s.xz + value_block.xz),
          half * (s.yy + value_block.yy - work), half * (s.yz + value_block.yz), half * (s.zz + value_block.zz - work)};

  // columns of [e]^T C_ek: E11 = (0, -z0, y0), E22 = (z1, 0, -x1), E12 = (0, -z1, y1), E21 = (z0, 0, -x0) as rows of [e]
  const auto column_a = [&](T(&r)[3], const T& f11, const T& f22) {
    r[0] = f22 * z1;
    r[1] = -(f11 * z0);
    r[2] = f11 * y0 - f22 * x1;
  };
  const auto column_b = [&](T(&r)[3], const T& f12, const T& f21) {
    r[0] = f21 * z0;
    r[1] = -(f12 * z1);
    r[2] = f12 * y1 - f21 * x0;
  };
  column_a(o.wk[0], a[2], a[5]);
  column_a(o.wk[1], a[3], a[6]);
  column_b(o.wk[2], b[2], b[5]);
  column_b(o.wk[3], b[3], b[6]);
  o.kk[0] = half * a[7];
  o.kk[1] = half * a[8];
  o.kk[2] = half * a[9];
  o.kk[3] = half * b[7];
  o.kk[4] = half * b[8];
  o.kk[5] = half * b[9];
  o.kk[6] = half * c.s[2];
  o.kk[7] = half * c.s[3];

  const Mat3<T> q0 = qf * (c0 - hat(f.e[0])), q1 = qf * (c1 - hat(f.e[1]));
  for (int d = 0; d < 2; ++d) {
    for (int k = 0; k < 9; ++k) o.m_w[d][k] = j[d][0] * q0.e[static_cast<std::size_t>(k)] + j[d][1] * q1.e[static_cast<std::size_t>(k)];
    const T ja0 = j[d][0], ja1 = j[d][1];
    for (int r = 0; r < 3; ++r) {
      const T u0 = ja0 * qf(r, 0), u1 = ja1 * qf(r, 1), v0 = ja1 * qf(r, 0), v1 = ja0 * qf(r, 1);
      o.m_k[d][0][r] = a[2] * u0 + a[5] * u1;
      o.m_k[d][1][r] = a[3] * u0 + a[6] * u1;
      o.m_k[d][2][r] = b[2] * v0 + b[5] * v1;
      o.m_k[d][3][r] = b[3] * v0 + b[6] * v1;
    }
  }
}

/// The second derivatives of the density with respect to d_1 m and d_2 m: blocks (1, 1) and (2, 2) as upper triangles, (1, 2) whole.
template <class T>
void deformation_block(T* g, const ShellForm<T>& c, const Mat3<T>& qf, const T (&j)[2][2]) {
  const Vec3<T> q0 = column(qf, 0), q1 = column(qf, 1), q2 = column(qf, 2);
  const auto& a = c.a;
  const auto& b = c.b;
  const auto diagonal_block = [&](const T& d0, const T& d1, const T& d2) {
    const Vec3<T> p0 = d0 * q0, p1 = d1 * q1, p2 = d2 * q2;
    Sym3<T> s;
    s.xx = p0[0] * q0[0] + p1[0] * q1[0] + p2[0] * q2[0];
    s.xy = p0[0] * q0[1] + p1[0] * q1[1] + p2[0] * q2[1];
    s.xz = p0[0] * q0[2] + p1[0] * q1[2] + p2[0] * q2[2];
    s.yy = p0[1] * q0[1] + p1[1] * q1[1] + p2[1] * q2[1];
    s.yz = p0[1] * q0[2] + p1[1] * q1[2] + p2[1] * q2[2];
    s.zz = p0[2] * q0[2] + p1[2] * q1[2] + p2[2] * q2[2];
    return s;
  };
  const Sym3<T> g11 = diagonal_block(a[0], b[4], c.s[0]), g22 = diagonal_block(b[0], a[4], c.s[1]);
  const Mat3<T> g12 = outer(a[1] * q0, q1) + outer(b[1] * q1, q0);
  const T d0[6] = {g11.xx, g11.xy, g11.xz, g11.yy, g11.yz, g11.zz}, d1[6] = {g22.xx, g22.xy, g22.xz, g22.yy, g22.yz, g22.zz};
  const T m[6] = {g12(0, 0) + g12(0, 0), g12(0, 1) + g12(1, 0), g12(0, 2) + g12(2, 0),
                  g12(1, 1) + g12(1, 1), g12(1, 2) + g12(2, 1), g12(2, 2) + g12(2, 2)};
  for (int d = 0; d < 2; ++d) {
    const T j00 = j[d][0] * j[d][0], j01 = j[d][0] * j[d][1], j11 = j[d][1] * j[d][1];
    for (int k = 0; k < 6; ++k) g[6 * d + k] = j00 * d0[k] + j01 * m[k] + j11 * d1[k];
  }
  const T j00 = j[0][0] * j[1][0], j01 = j[0][0] * j[1][1], j10 = j[0][1] * j[1][0], j11 = j[0][1] * j[1][1];
  constexpr int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int r = 0; r < 3; ++r)
    for (int s = 0; s < 3; ++s) g[12 + 3 * r + s] = j00 * d0[at[r][s]] + j01 * g12(r, s) + j10 * g12(s, r) + j11 * d1[at[r][s]];
}

/// w = 1/2 M a + b on 9 x 3 matrices; b is overwritten.
template <class T>
void apply(const PointOperator<T>& o, const T* a, T* b) {
  // rows of a and b: w 0..2, K11 3, K21 4, K31 5, K12 6, K22 7, K32 8
  for (int c = 0; c < 3; ++c) {
    const T w0 = a[c], w1 = a[3 + c], w2 = a[6 + c], k11 = a[9 + c], k21 = a[12 + c], k31 = a[15 + c], k12 = a[18 + c], k22 = a[21 + c],
            k32 = a[24 + c];
    const auto add = [&](int row, const T& f, const T& x) { b[3 * row + c] += f * x; };
    const Sym3<T>& s = o.ww;
    const T ww[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    for (int r = 0; r < 3; ++r) {
      add(r, ww[r][0], w0);
      add(r, ww[r][1], w1);
      add(r, ww[r][2], w2);
      add(r, o.wk[0][r], k21);
      add(r, o.wk[1][r], k12);
      add(r, o.wk[2][r], k22);
      add(r, o.wk[3][r], k11);
    }
    add(3, o.kk[4], k22);
    add(3, o.kk[5], k11);
    add(4, o.kk[0], k21);
    add(4, o.kk[1], k12);
    add(5, o.kk[6], k31);
    add(6, o.kk[1], k21);
    add(6, o.kk[2], k12);
    add(7, o.kk[3], k22);
    add(7, o.kk[4], k11);
    add(8, o.kk[7], k32);
  }
}

/// Change of the forces at d_a m under the variation a: 3 x 3 for each a.
template <class T>
void force(const PointOperator<T>& o, const T* a, T* h) {
  T x[7][3];
  constexpr int rows[7] = {0, 1, 2, 4, 6, 7, 3};  // w, K21, K12, K22, K11
  for (int k = 0; k < 7; ++k)
    for (int c = 0; c < 3; ++c) x[k][c] = a[3 * rows[k] + c];
  for (int d = 0; d < 2; ++d)
    for (int r = 0; r < 3; ++r) {
      T sum[3];
      for (int k = 0; k < 7; ++k) {
        const T f = in_register(k < 3 ? o.m_w[d][3 * r + k] : o.m_k[d][k - 3][r]);
        for (int c = 0; c < 3; ++c) sum[c] = k == 0 ? f * x[k][c] : sum[c] + f * x[k][c];
      }
      for (int c = 0; c < 3; ++c) h[9 * d + 3 * r + c] = sum[c];
    }
}

/// Nodes whose 3 x 3 blocks are summed at once: 18 sums fit the 32 registers of AVX-512, 9 the 16 of AVX.
template <class T>
inline constexpr int block_nodes = lanes<T> == 8 ? 2 : 1;

/// Adds a_i^T w_j + w_i^T a_j for N consecutive nodes j, whose 9 x 3 matrices follow one another.
template <class T, int N>
void rank_update(const T* ai, const T* wi, const T* aj, const T* wj, double* hessian, int stride) {
  T sum[3][3 * N];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3 * N; ++c) sum[r][c] = load<T>(hessian + (r * stride + c) * lanes<T>);
  for (int k = 0; k < 9; ++k)
    for (int n = 0; n < N; ++n)
      for (int c = 0; c < 3; ++c) {
        const T w = in_register(wj[27 * n + 3 * k + c]), a = in_register(aj[27 * n + 3 * k + c]);
        for (int r = 0; r < 3; ++r) {
          sum[r][3 * n + c] += ai[3 * k + r] * w;
          sum[r][3 * n + c] += wi[3 * k + r] * a;
        }
      }
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3 * N; ++c) store(sum[r][c], hessian + (r * stride + c) * lanes<T>);
}

/// Adds a^T w + w^T a.
template <class T>
void diagonal_update(const T* a, const T* w, double* hessian, int stride) {
  Mat3<T> s{};
  for (int k = 0; k < 9; ++k)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) s(r, c) += a[3 * k + r] * w[3 * k + c];
  for (int r = 0; r < 3; ++r)
    for (int c = r; c < 3; ++c) {
      double* h = hessian + (r * stride + c) * lanes<T>;
      store(load<T>(h) + s(r, c) + s(c, r), h);
    }
}

/// Sums over a chunk of points of the blocks of N consecutive deformation nodes j with rotation node i. \param forces  [point][stride][18] of node i
template <class T, int N>
void mixed_blocks(const double* dm, int nm, int count, const T* forces, int stride, bool fresh, double* hessian, int n) {
  T sum[N][9];
  for (int j = 0; j < N; ++j)
    for (int k = 0; k < 9; ++k) sum[j][k] = fresh ? T(0.0) : load<T>(hessian + ((3 * j + k / 3) * n + k % 3) * lanes<T>);
  for (int p = 0; p < count; ++p, dm += 2 * nm, forces += stride)
    for (int d = 0; d < 2; ++d)
      for (int k = 0; k < 9; ++k) {
        const T f = in_register(forces[9 * d + k]);
        for (int j = 0; j < N; ++j) sum[j][k] += T(dm[2 * j + d]) * f;
      }
  for (int j = 0; j < N; ++j)
    for (int k = 0; k < 9; ++k) store(sum[j][k], hessian + ((3 * j + k / 3) * n + k % 3) * lanes<T>);
}

/// Sums of the blocks of a deformation node i with N consecutive nodes j. \param half  [point][direction of j][9]: second derivatives contracted with
/// node i
template <class T, int N>
void deformation_blocks(const double* dm, int nm, int count, const T (*half)[2][9], bool fresh, double* hessian, int n) {
  T sum[N][9];
  for (int j = 0; j < N; ++j)
    for (int k = 0; k < 9; ++k) sum[j][k] = fresh ? T(0.0) : load<T>(hessian + ((k / 3) * n + 3 * j + k % 3) * lanes<T>);
  for (int p = 0; p < count; ++p, dm += 2 * nm)
    for (int d = 0; d < 2; ++d)
      for (int k = 0; k < 9; ++k) {
        const T x = in_register(half[p][d][k]);
        for (int j = 0; j < N; ++j) sum[j][k] += T(dm[2 * j + d]) * x;
      }
  for (int j = 0; j < N; ++j)
    for (int k = 0; k < 9; ++k) store(sum[j][k], hessian + ((k / 3) * n + 3 * j + k % 3) * lanes<T>);
}

/// The blocks of deformation node i with all nodes j >= i. \param blocks  [point][21], as deformation_block writes them
template <class T>
void deformation_row(const double* dm, int nm, int i, int count, const T (*blocks)[21], bool fresh, double* hessian, int n) {
  T half[max_chunk][2][9];
  constexpr int at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5}, flipped[9] = {0, 3, 6, 1, 4, 7, 2, 5, 8};
  for (int p = 0; p < count; ++p) {
    const T d0(dm[2 * (p * nm + i)]), d1(dm[2 * (p * nm + i) + 1]);
    for (int k = 0; k < 9; ++k) {
      half[p][0][k] = d0 * blocks[p][at[k]] + d1 * blocks[p][12 + flipped[k]];
      half[p][1][k] = d0 * blocks[p][12 + k] + d1 * blocks[p][6 + at[k]];
    }
  }
  double* row = hessian + 3 * i * n * lanes<T>;
  constexpr int group = block_nodes<T>;
  int j = i;
  for (; j + group <= nm; j += group) deformation_blocks<T, group>(dm + 2 * j, nm, count, half, fresh, row + 3 * j * lanes<T>, n);
  for (; j < nm; ++j) deformation_blocks<T, 1>(dm + 2 * j, nm, count, half, fresh, row + 3 * j * lanes<T>, n);
}

/// Marks what failed: trouble of the interpolation, or results that are not finite.
template <class T>
void report(const T& energy, const T& trouble, int gradient_size, int hessian_size, const Output& out) {
  constexpr int W = lanes<T>;
  // x - x is zero for finite x and not a number otherwise.
  T sum = energy - energy;
  for (int k = 0; k < gradient_size; ++k) {
    const T x = load<T>(out.gradient + k * W);
    sum += x - x;
  }
  for (int k = 0; k < hessian_size; ++k) {
    const T x = load<T>(out.hessian + (k * hessian_size + k) * W);
    sum += x - x;
  }
  for (int k = 0; k < W; ++k) {
    const bool undefined = lane(trouble, k) != 0, finite = lane(sum, k) == 0;
    out.trouble[k] = undefined ? Trouble::undefined_interpolation : finite ? Trouble::none : Trouble::not_finite;
    out.energy[k] = undefined || !finite ? std::numeric_limits<double>::infinity() : lane(energy, k);
  }
}

/// What is too large for the stack frame.
template <class T, class Nodes>
struct Workspace {
  Nodes nodes;
  T lb[max_nodes][2];
  T a[max_nodes][27], b[max_nodes][27];
  T forces[max_chunk * max_nodes][18];  // [point * nodes + node]
  T blocks[max_chunk][21];

  static Workspace& get() {
    alignas(64) static thread_local Workspace workspace;
    return workspace;
  }
};

template <class T, template <class> class RotationRule, Want want>
KARCHER_FLATTEN void evaluate_batch(const Tables& tables, const double* points, const double* m, const double* q, const Output& out) {
  constexpr int W = lanes<T>, group = block_nodes<T>;
  constexpr bool hessian_wanted = want == Want::hessian, gradient_wanted = want != Want::energy;
  const int nm = tables.m_nodes, nr = tables.r_nodes, n = 3 * (nm + nr);

  auto& [nodes, lb, a, b, forces, blocks] = Workspace<T, typename RotationRule<T>::Nodes>::get();
  RotationRule<T> rule(nodes, tables, q);
  T energy(0.0);

  const auto at = [&](int r, int c) { return out.hessian + (r * n + c) * W; };
  if constexpr (gradient_wanted)
    for (int k = 0; k < 3 * nm; ++k) store(T(0.0), out.gradient + k * W);
  if constexpr (hessian_wanted)
    for (int r = 3 * nm; r < n; ++r)
      for (int c = r - r % 3; c < n; ++c) store(T(0.0), at(r, c));

  const int chunks = (tables.points + max_chunk - 1) / max_chunk;
  for (int chunk = 0; chunk < chunks; ++chunk) {
    const int first = tables.points * chunk / chunks, count = tables.points * (chunk + 1) / chunks - first;
    rule.solve(first, count);
    for (int p = 0; p < count; ++p) {
      const double* data = points + (first + p) * point_entries * W;
      const double* dm = tables.m_gradient.data() + (first + p) * nm * 2;
      const double* l = tables.r_value.data() + (first + p) * nr;
      const double* dl = tables.r_gradient.data() + (first + p) * nr * 2;
      T j[2][2];
      for (int k = 0; k < 4; ++k) j[k / 2][k % 2] = load<T>(data + k * W);
      const Mat3<T> f = rotation_matrix(Quaternion<T>{{load<T>(data + 4 * W), load<T>(data + 5 * W), load<T>(data + 6 * W), load<T>(data + 7 * W)}});
      ShellForm<T> c;
      for (int k = 0; k < 10; ++k) c.a[static_cast<std::size_t>(k)] = load<T>(data + (8 + k) * W);
      for (int k = 0; k < 10; ++k) c.b[static_cast<std::size_t>(k)] = load<T>(data + (18 + k) * W);
      for (int k = 0; k < 4; ++k) c.s[static_cast<std::size_t>(k)] = load<T>(data + (28 + k) * W);
      for (int i = 0; i < nr; ++i)
        for (int s = 0; s < 2; ++s) lb[i][s] = T(dl[2 * i]) * j[0][s] + T(dl[2 * i + 1]) * j[1][s];

      rule.go_to(p, l, lb);
      const Mat3<T> qf = rule.rotation * f;
      Vec3<T> d0{}, d1{};
      for (int i = 0; i < nm; ++i)
        for (int k = 0; k < 3; ++k) {
          const T x = load<T>(m + (3 * i + k) * W);
          d0[k] += T(dm[2 * i]) * x;
          d1[k] += T(dm[2 * i + 1]) * x;
        }
      Strain<T> z;
      Vec3<T> e[2];
      for (int s = 0; s < 2; ++s) {
        e[s] = transpose_times(qf, j[0][s] * d0 + j[1][s] * d1);
        z.e[s] = e[s];
        z.e[s][s] -= T(1.0);
        z.k[s] = transpose_times(f, rule.rate[s]);
      }
      const Strain<T> t = stress(c, z);
      energy += T(0.5) * (dot(z.e[0], t.e[0]) + dot(z.e[1], t.e[1]) + dot(z.k[0], t.k[0]) + dot(z.k[1], t.k[1]));

      if constexpr (gradient_wanted) {
        const Vec3<T> force0 = qf * (j[0][0] * t.e[0] + j[0][1] * t.e[1]), force1 = qf * (j[1][0] * t.e[0] + j[1][1] * t.e[1]);
        for (int i = 0; i < nm; ++i)
          for (int k = 0; k < 3; ++k) {
            double* g = out.gradient + (3 * i + k) * W;
            store(load<T>(g) + T(dm[2 * i]) * force0[k] + T(dm[2 * i + 1]) * force1[k], g);
          }
        rule.adjoint(f, cross(t.e[0], e[0]) + cross(t.e[1], e[1]), t.k, l, lb);
      }
      if constexpr (want == Want::gradient) rule.add_gradient(l, dl, j);
      if constexpr (hessian_wanted) {
        deformation_block(blocks[p], c, qf, j);  // independent of the chain of operations around it
        rule.linearize(f, l, lb, a, b);
        PointOperator<T> o;
        build(o, c, e, t, qf, j, rule.value_block());
        for (int i = 0; i < nr; ++i) {
          rule.node(i, l, lb, a[i], b[i]);
          force(o, a[i], forces[p * nr + i]);
          apply(o, a[i], b[i]);
        }
        const int r0 = 3 * nm;
        for (int i = 0; i < nr; ++i) {
          diagonal_update(a[i], b[i], at(r0 + 3 * i, r0 + 3 * i), n);
          int k = i + 1;
          for (; k + group <= nr; k += group) rank_update<T, group>(a[i], b[i], a[k], b[k], at(r0 + 3 * i, r0 + 3 * k), n);
          for (; k < nr; ++k) rank_update<T, 1>(a[i], b[i], a[k], b[k], at(r0 + 3 * i, r0 + 3 * k), n);
        }
      }
    }
    if constexpr (hessian_wanted) {
      const double* dm = tables.m_gradient.data() + first * nm * 2;
      const bool fresh = chunk == 0;
      for (int i = 0; i < nr; ++i) {
        int k = 0;
        for (; k + group <= nm; k += group) mixed_blocks<T, group>(dm + 2 * k, nm, count, forces[i], 18 * nr, fresh, at(3 * k, 3 * (nm + i)), n);
        for (; k < nm; ++k) mixed_blocks<T, 1>(dm + 2 * k, nm, count, forces[i], 18 * nr, fresh, at(3 * k, 3 * (nm + i)), n);
      }
      for (int i = 0; i < nm; ++i) deformation_row<T>(dm, nm, i, count, blocks, fresh, out.hessian, n);
    }
  }

  if constexpr (gradient_wanted) {
    for (int i = 0; i < nr; ++i) {
      const Vec3<T> g = hessian_wanted ? rule.node_gradient(i) : rule.gradient(i);
      for (int k = 0; k < 3; ++k) store(g[k], out.gradient + (3 * (nm + i) + k) * W);
    }
  }
  if constexpr (hessian_wanted) {
    for (int i = 0; i < nr; ++i) {
      const int r = 3 * (nm + i);
      const Mat3<T> s = full(rule.node_block(i));
      for (int x = 0; x < 3; ++x)
        for (int y = x; y < 3; ++y) {
          const T h = load<T>(at(r + x, r + y)) + s(x, y);
          store(h, at(r + x, r + y));
          store(h, at(r + y, r + x));
        }
    }
  }
  report(energy, rule.trouble, gradient_wanted ? n : 0, hessian_wanted ? n : 0, out);
}

}  // namespace karcher::shell
