#pragma once
/// \file
/// exp and log of symmetric matrices and Cholesky factors, of sizes 1 to 3, at any scalar, smooth where eigenvalues meet.
///
/// At a plain scalar, f(S) = V f(lambda) V^T with the eigenvectors from Jacobi rotations. A scalar with derivatives is S = V (Lambda + E) V^T where the plain
/// value of E vanishes, so that the expansion in divided differences of f ends with the order of the derivatives, and is exact:
///
///   (V^T f(S) V)_ij = f[i] delta_ij + f[i,j] E_ij + sum_k f[i,k,j] E_ik E_kj + sum_kl f[i,k,l,j] E_ik E_kl E_lj,
///
/// f[i,j,...] the divided difference at the eigenvalues lambda_i, lambda_j, ... (Daleckii and Krein 1965; Higham, "Functions of Matrices", 2008, section 3.2
/// and B.16). Divided differences at near points come from a series in the complete homogeneous polynomials h_k of their distances to the mean,
/// (x^k)[x_0, ..., x_n] = h_(k-n), so there is no case of equal eigenvalues.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "karcher/math/elementary.hpp"
#include "karcher/math/tensor.hpp"

namespace karcher {

/// Lower triangular L with A = L L^T. A pivot that is not positive gives NaN or infinity: A is not positive definite. Reads the lower triangle.
template <class T, int N>
Mat<T, N, N> cholesky(const Mat<T, N, N>& a) {
  using karcher::sqrt;
  Mat<T, N, N> l;
  for (int j = 0; j < N; ++j) {
    T d = a(j, j);
    for (int k = 0; k < j; ++k) d -= l(j, k) * l(j, k);
    l(j, j) = sqrt(d);
    if (j + 1 < N) {
      const T r = T(1.0) / l(j, j);
      for (int i = j + 1; i < N; ++i) {
        T s = a(i, j);
        for (int k = 0; k < j; ++k) s -= l(i, k) * l(j, k);
        l(i, j) = s * r;
      }
    }
  }
  return l;
}

/// Inverse of a lower triangular matrix.
template <class T, int N>
Mat<T, N, N> lower_inverse(const Mat<T, N, N>& l) {
  Mat<T, N, N> m;
  for (int j = 0; j < N; ++j) m(j, j) = T(1.0) / l(j, j);
  for (int j = 0; j < N; ++j)
    for (int i = j + 1; i < N; ++i) {
      T s = l(i, j) * m(j, j);
      for (int k = j + 1; k < i; ++k) add_product(s, l(i, k), m(k, j));
      m(i, j) = -(s * m(i, i));
    }
  return m;
}

/// L S L^T for a lower triangular L and symmetric S, exactly symmetric.
template <class T, int N>
Mat<T, N, N> lower_congruence(const Mat<T, N, N>& l, const Mat<T, N, N>& s) {
  Mat<T, N, N> ls, r;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      T t = l(i, 0) * s(0, j);
      for (int k = 1; k <= i; ++k) add_product(t, l(i, k), s(k, j));
      ls(i, j) = t;
    }
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) {
      T t = ls(i, 0) * l(j, 0);
      for (int k = 1; k <= j; ++k) add_product(t, ls(i, k), l(j, k));
      r(i, j) = t;
      r(j, i) = t;
    }
  return r;
}

/// Eigenvalues (not sorted) and orthonormal eigenvectors (columns) of a symmetric matrix of plain scalars, by cyclic Jacobi rotations.
/// Golub and Van Loan, "Matrix Computations" (2013), section 8.5. A matrix with NaN gives NaN.
template <class T, int N>
struct Eigen {
  Vec<T, N> values;
  Mat<T, N, N> vectors;
};

template <class T, int N>
requires is_base<T> Eigen<T, N> eigen(Mat<T, N, N> a) {
  using karcher::abs, karcher::sqrt;
  Mat<T, N, N> v = identity<T, N>();
  constexpr int most_sweeps = 12;
  for (int sweep = 0; N > 1 && sweep < most_sweeps; ++sweep) {
    T off = T(0.0), size = T(0.0);
    for (int p = 0; p < N; ++p) {
      size += a(p, p) * a(p, p);
      for (int q = p + 1; q < N; ++q) off += a(p, q) * a(p, q);
    }
    if (!any(off > T(1e-34) * size)) break;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        // t = tan of the angle: the smaller root of t^2 + 2 theta t - 1 = 0, written without division by a(p, q)
        const T d = a(q, q) - a(p, p), b = T(2.0) * a(p, q);
        const T root = abs(d) + sqrt(d * d + b * b);
        const T t = select(root > T(0.0), select(d < T(0.0), -b, b) / select(root > T(0.0), root, T(1.0)), T(0.0));
        const T c = T(1.0) / sqrt(T(1.0) + t * t), s = t * c;
        a(p, p) -= t * a(p, q);
        a(q, q) += t * a(p, q);
        a(p, q) = T(0.0);
        a(q, p) = T(0.0);
        for (int k = 0; k < N; ++k) {
          if (k != p && k != q) {
            const T x = a(k, p), y = a(k, q);
            a(k, p) = c * x - s * y;
            a(k, q) = s * x + c * y;
            a(p, k) = a(k, p);
            a(q, k) = a(k, q);
          }
          const T x = v(k, p), y = v(k, q);
          v(k, p) = c * x - s * y;
          v(k, q) = s * x + c * y;
        }
      }
  }
  Eigen<T, N> e;
  for (int i = 0; i < N; ++i) e.values[i] = a(i, i);
  e.vectors = v;
  return e;
}

namespace symmetric_detail {

/// Order of the derivatives that a scalar carries.
template <class T>
inline constexpr int order = 0;
template <class T, int N>
inline constexpr int order<Jet<T, N>> = 2 + order<T>;
template <class U, int D>
inline constexpr int order<Dual<U, D>> = 1 + order<U>;

/// sum_k c_k h_k(u) over Terms terms, u with sum zero, K numbers: h_k = -e_2 h_(k-2) + e_3 h_(k-3) - e_4 h_(k-4).
template <std::size_t Terms, std::size_t K, class T>
T homogeneous_series(const std::array<T, K>& u, const std::array<double, Terms>& c) {
  T e2 = T(0.0), e3 = T(0.0), e4 = T(0.0);
  for (std::size_t i = 0; i < K; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      e2 += u[i] * u[j];
      for (std::size_t k = 0; k < j; ++k) {
        e3 += u[i] * u[j] * u[k];
        for (std::size_t l = 0; l < k; ++l) e4 += u[i] * u[j] * u[k] * u[l];
      }
    }
  std::array<T, Terms> h;
  h[0] = T(1.0);
  h[1] = T(0.0);
  T s = T(c[0]);
#pragma GCC unroll 40
  for (std::size_t n = 2; n < Terms; ++n) {
    h[n] = -(e2 * h[n - 2]);
    if (K >= 3 && n >= 3) h[n] += e3 * h[n - 3];
    if (K >= 4 && n >= 4) h[n] -= e4 * h[n - 4];
    s += T(c[n]) * h[n];
  }
  return s;
}

/// exp: values, and the divided difference at K near points.
struct Exponential {
  template <class T>
  static T value(const T& x) {
    return function_detail::plain_exp(x);
  }
  // Gap of the largest and the smallest point under which the series holds: 26 terms leave 1.4^26 / 26!.
  template <class T>
  static T reach(const T&) {
    return T(2.0);
  }
  template <std::size_t K, class T>
  static T near(const T& mean, const std::array<T, K>& u) {
    // 1/(k + K - 1)!
    static constexpr auto coefficients = [] {
      std::array<double, 26> c{};
      double f = 1;
      for (std::size_t i = 2; i < K; ++i) f /= static_cast<double>(i);
      for (std::size_t k = 0; k < c.size(); ++k) {
        c[k] = f;
        f /= static_cast<double>(k + K);
      }
      return c;
    }();
    return function_detail::plain_exp(mean) * homogeneous_series(u, coefficients);
  }
};

/// log, at points that are positive.
struct Logarithm {
  template <class T>
  static T value(const T& x) {
    return function_detail::plain_log(x);
  }
  // All points within a quarter of the mean: 36 terms leave 0.25^36 (36 choose 3).
  template <class T>
  static T reach(const T& mean) {
    return T(0.25) * mean;
  }
  template <std::size_t K, class T>
  static T near(const T& mean, std::array<T, K> u) {
    const T r = T(1.0) / mean;
    T factor = T(1.0);
    for (std::size_t i = 0; i < K; ++i) u[i] = u[i] * r;
    for (std::size_t i = 1; i < K; ++i) factor = factor * r;
    // of log(1 + x): (-1)^(n+1)/n, n = k + K - 1
    static constexpr auto coefficients = [] {
      std::array<double, 36> c{};
      for (std::size_t k = 0; k < c.size(); ++k) c[k] = ((k + K) % 2 == 0 ? 1.0 : -1.0) / static_cast<double>(k + K - 1);
      return c;
    }();
    return factor * homogeneous_series(u, coefficients);
  }
};

/// Divided difference at K ascending points, K = 1: the value f0[0].
template <class F, std::size_t K, class T>
T divided_difference(const std::array<T, K>& x, const std::array<T, K>& f0) {
  if constexpr (K == 1) {
    return f0[0];
  } else {
    T mean = x[0];
    for (std::size_t i = 1; i < K; ++i) mean += x[i];
    mean = mean * T(1.0 / static_cast<double>(K));
    const T gap = x[K - 1] - x[0];
    const auto near = gap <= F::reach(mean);
    T series = T(0.0);
    if (any(near)) {
      std::array<T, K> u;
      for (std::size_t i = 0; i < K; ++i) u[i] = select(near, x[i] - mean, T(0.0));
      series = F::near(mean, u);
      if (all(near)) return series;
    }
    std::array<T, K - 1> left, right, f_left, f_right;
    for (std::size_t i = 0; i + 1 < K; ++i) {
      left[i] = x[i];
      right[i] = x[i + 1];
      f_left[i] = f0[i];
      f_right[i] = f0[i + 1];
    }
    const T far = (divided_difference<F>(right, f_right) - divided_difference<F>(left, f_left)) / select(near, T(1.0), gap);
    return select(near, series, far);
  }
}

/// The same at points in any order.
template <class F, std::size_t K, class T>
T divided_difference_sorting(std::array<T, K> x, std::array<T, K> f0) {
  for (std::size_t i = 0; i < K; ++i)
    for (std::size_t j = 0; j + 1 < K - i; ++j) {
      const auto wrong = x[j] > x[j + 1];
      const T a = x[j], b = f0[j];
      x[j] = select(wrong, x[j + 1], x[j]);
      f0[j] = select(wrong, f0[j + 1], f0[j]);
      x[j + 1] = select(wrong, a, x[j + 1]);
      f0[j + 1] = select(wrong, b, f0[j + 1]);
    }
  return divided_difference<F>(x, f0);
}

/// f(shift I + S), given the eigenvalues and vectors of the plain part of S, the shifted eigenvalues and f there.
template <class F, class X, int N>
Mat<X, N, N> apply(const Mat<X, N, N>& s, const Mat<Base<X>, N, N>& v, const Vec<Base<X>, N>& lambda, const Vec<Base<X>, N>& f) {
  using T = Base<X>;
  static_assert(order<X> <= 3, "matrix functions carry derivatives to the third order");
  Mat<X, N, N> g;  // V^T f V, upper triangle
  if constexpr (order<X> == 0) {
    for (int i = 0; i < N; ++i) g(i, i) = f[i];
  } else {
    // E = V^T S V without its plain value, which is diagonal
    Mat<X, N, N> sv, e;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        X t = scaled(s(i, 0), v(0, j));
        for (int k = 1; k < N; ++k) add_scaled(t, s(i, k), v(k, j));
        sv(i, j) = t;
      }
    for (int i = 0; i < N; ++i)
      for (int j = i; j < N; ++j) {
        X t = scaled(sv(0, j), v(0, i));
        for (int k = 1; k < N; ++k) add_scaled(t, sv(k, j), v(k, i));
        set_value(t, T(0.0));
        e(i, j) = t;
        e(j, i) = t;
      }
    using I = std::size_t;
    Mat<T, N, N> f2;                              // f[i,j]
    std::array<T, static_cast<I>(N * N * N)> f3;  // f[i,k,j]
    const auto at = [](int i, int j, int k) { return static_cast<I>((i * N + j) * N + k); };
    for (int i = 0; i < N; ++i)
      for (int j = i; j < N; ++j) {
        f2(i, j) = divided_difference_sorting<F, 2, T>({lambda[i], lambda[j]}, {f[i], f[j]});
        f2(j, i) = f2(i, j);
        if constexpr (order<X> >= 2)
          for (int k = j; k < N; ++k) {
            const T d = divided_difference_sorting<F, 3, T>({lambda[i], lambda[j], lambda[k]}, {f[i], f[j], f[k]});
            f3[at(i, j, k)] = f3[at(j, k, i)] = f3[at(k, i, j)] = f3[at(k, j, i)] = f3[at(j, i, k)] = f3[at(i, k, j)] = d;
          }
      }
    // e2[i,k,j] = E_ik E_kj for i <= j; the product is the same for j, k, i.
    std::array<X, order<X> >= 2 ? static_cast<I>(N * N * N) : 0> e2;
    for (int i = 0; i < N; ++i)
      for (int j = i; j < N; ++j) {
        X t = scaled(e(i, j), f2(i, j));
        if constexpr (order<X> >= 2)
          for (int k = 0; k < N; ++k) {
            e2[at(i, k, j)] = e(i, k) * e(k, j);
            add_scaled(t, e2[at(i, k, j)], f3[at(i, k, j)]);
          }
        if (i == j) set_value(t, f[i]);
        g(i, j) = t;
      }
    if constexpr (order<X> >= 3) {
      // The multisets of four eigenvalues once each.
      std::array<T, static_cast<I>(N * N * N * N)> f4;
      const auto at4 = [](int i, int j, int k, int l) { return static_cast<I>(((i * N + j) * N + k) * N + l); };
      for (int i = 0; i < N; ++i)
        for (int j = i; j < N; ++j)
          for (int k = j; k < N; ++k)
            for (int l = k; l < N; ++l)
              f4[at4(i, j, k, l)] = divided_difference_sorting<F, 4, T>({lambda[i], lambda[j], lambda[k], lambda[l]}, {f[i], f[j], f[k], f[l]});
      const auto fourth = [&](int i, int j, int k, int l) {
        std::array<int, 4> m{i, j, k, l};
        for (I a = 0; a < 4; ++a)
          for (I b = 0; b + 1 < 4 - a; ++b)
            if (m[b] > m[b + 1]) std::swap(m[b], m[b + 1]);
        return f4[at4(m[0], m[1], m[2], m[3])];
      };
      for (int i = 0; i < N; ++i)
        for (int j = i; j < N; ++j)
          for (int l = 0; l < N; ++l) {
            const auto pair = [&](int k) -> const X& { return e2[i <= l ? at(i, k, l) : at(l, k, i)]; };
            X t = scaled(pair(0), fourth(i, 0, l, j));
            for (int k = 1; k < N; ++k) add_scaled(t, pair(k), fourth(i, k, l, j));
            add_product(g(i, j), t, e(l, j));
          }
    }
  }
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) g(i, j) = g(j, i);
  Mat<X, N, N> vg, r;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      X t = scaled(g(0, j), v(i, 0));
      for (int k = 1; k < N; ++k) add_scaled(t, g(k, j), v(i, k));
      vg(i, j) = t;
    }
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) {
      X t = scaled(vg(i, 0), v(j, 0));
      for (int k = 1; k < N; ++k) add_scaled(t, vg(i, k), v(j, k));
      r(i, j) = t;
      r(j, i) = t;
    }
  return r;
}

template <class X, int N>
Mat<Base<X>, N, N> plain(const Mat<X, N, N>& a) {
  Mat<Base<X>, N, N> b;
  for (std::size_t i = 0; i < a.e.size(); ++i) b.e[i] = base(a.e[i]);
  return b;
}

}  // namespace symmetric_detail

/// exp of a symmetric matrix.
template <class X, int N>
Mat<X, N, N> symmetric_exp(const Mat<X, N, N>& s) {
  namespace d = symmetric_detail;
  const auto e = eigen(d::plain(s));
  Vec<Base<X>, N> f;
  for (int i = 0; i < N; ++i) f[i] = d::Exponential::value(e.values[i]);
  return d::apply<d::Exponential>(s, e.vectors, e.values, f);
}

/// log(I + S) of a symmetric matrix S with eigenvalues greater than -1, accurate also for small S.
template <class X, int N>
Mat<X, N, N> symmetric_log1p(const Mat<X, N, N>& s) {
  namespace d = symmetric_detail;
  using T = Base<X>;
  const auto e = eigen(d::plain(s));
  Vec<T, N> f, lambda;
  for (int i = 0; i < N; ++i) {
    lambda[i] = T(1.0) + e.values[i];
    f[i] = function_detail::plain_log1p(e.values[i]);
  }
  return d::apply<d::Logarithm>(s, e.vectors, lambda, f);
}

/// |log(I + S)|^2 of a symmetric matrix S with eigenvalues greater than -1, accurate also for small S; NaN for others.
///
/// A scalar with derivatives is S = V (Lambda + E) V^T as above, and with f(x) = log^2(1 + x)
///   |log(I + S)|^2 = sum_i f(lambda_i) + f'(lambda_i) E_ii + 1/2 sum_ij f'[lambda_i, lambda_j] E_ij^2,
/// where with y = 1 + lambda, f' = 2 log(y)/y has the divided differences f'[i, j] = 2 (log[y_i, y_j] - log(y_j)/y_j)/y_i.
template <class X, int N>
X squared_log1p(const Mat<X, N, N>& s) {
  namespace d = symmetric_detail;
  using T = Base<X>;
  static_assert(d::order<X> <= 2);
  const auto [values, v] = eigen(d::plain(s));
  Vec<T, N> y, log_y;
  T sum = T(0.0);
  for (int i = 0; i < N; ++i) {
    y[i] = T(1.0) + values[i];
    log_y[i] = function_detail::plain_log1p(values[i]);
    sum += log_y[i] * log_y[i];
  }
  X result = constant<X>(sum);
  if constexpr (d::order < X >> 0)
    for (int j = 0; j < N; ++j) {
      Vec<X, N> sv;
      for (int k = 0; k < N; ++k) {
        sv[k] = scaled(s(k, 0), v(0, j));
        for (int l = 1; l < N; ++l) add_scaled(sv[k], s(k, l), v(l, j));
      }
      for (int i = 0; i <= j; ++i) {
        if (i < j && d::order<X> < 2) continue;
        X e = scaled(sv[0], v(0, i));
        for (int k = 1; k < N; ++k) add_scaled(e, sv[k], v(k, i));
        set_value(e, T(0.0));
        const T slope = log_y[j] / y[j];
        if (i == j) add_scaled(result, e, T(2.0) * slope);
        const T difference = d::divided_difference_sorting<d::Logarithm, 2, T>({y[i], y[j]}, {log_y[i], log_y[j]});
        if (d::order<X> == 2) add_square(result, e, T(i == j ? 1.0 : 2.0) * (difference - slope) / y[i]);
      }
    }
  return result;
}

/// log of a symmetric positive definite matrix; NaN where it is not.
template <class X, int N>
Mat<X, N, N> symmetric_log(const Mat<X, N, N>& s) {
  namespace d = symmetric_detail;
  const auto e = eigen(d::plain(s));
  Vec<Base<X>, N> f;
  for (int i = 0; i < N; ++i) f[i] = d::Logarithm::value(e.values[i]);
  return d::apply<d::Logarithm>(s, e.vectors, e.values, f);
}

}  // namespace karcher
