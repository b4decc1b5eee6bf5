#pragma once
/// \file
/// Small dense vectors and matrices of compile-time size over any scalar (double, Pack, Jet, Dual, ...).
/// Plain aggregates: trivially copyable when the scalar is, no expression templates, row-major storage.

#include <array>
#include <cstddef>
#include <type_traits>

namespace karcher {

/// Column vector of N scalars. `Vec<T, N>{}` is zero.
template <class T, int N>
struct Vec {
  std::array<T, static_cast<std::size_t>(N)> e{};

  static constexpr int size() { return N; }
  constexpr T& operator[](int i) { return e[static_cast<std::size_t>(i)]; }
  constexpr const T& operator[](int i) const { return e[static_cast<std::size_t>(i)]; }
};

/// M x N matrix, row-major. `Mat<T, M, N>{}` is zero.
template <class T, int M, int N>
struct Mat {
  std::array<T, static_cast<std::size_t>(M* N)> e{};

  static constexpr int rows() { return M; }
  static constexpr int cols() { return N; }
  constexpr T& operator()(int i, int j) { return e[static_cast<std::size_t>(i * N + j)]; }
  constexpr const T& operator()(int i, int j) const { return e[static_cast<std::size_t>(i * N + j)]; }
};

template <class T>
using Vec3 = Vec<T, 3>;
template <class T>
using Mat3 = Mat<T, 3, 3>;

// Element-wise algebra. The scalar of a product may differ from the entries' (double * Vec<Jet>); the result has the entries' type.
template <class T, int N>
constexpr Vec<T, N> operator+(Vec<T, N> a, const Vec<T, N>& b) {
  for (int i = 0; i < N; ++i) a[i] += b[i];
  return a;
}
template <class T, int N>
constexpr Vec<T, N> operator-(Vec<T, N> a, const Vec<T, N>& b) {
  for (int i = 0; i < N; ++i) a[i] -= b[i];
  return a;
}
template <class T, int N>
constexpr Vec<T, N> operator-(Vec<T, N> a) {
  for (int i = 0; i < N; ++i) a[i] = -a[i];
  return a;
}
template <class T, int N, class S>
constexpr Vec<T, N> operator*(const S& s, Vec<T, N> a) {
  for (int i = 0; i < N; ++i) a[i] = s * a[i];
  return a;
}
template <class T, int N>
constexpr Vec<T, N>& operator+=(Vec<T, N>& a, const Vec<T, N>& b) {
  for (int i = 0; i < N; ++i) a[i] += b[i];
  return a;
}
template <class T, int N>
constexpr Vec<T, N>& operator-=(Vec<T, N>& a, const Vec<T, N>& b) {
  for (int i = 0; i < N; ++i) a[i] -= b[i];
  return a;
}

template <class T, int M, int N>
constexpr Mat<T, M, N> operator+(Mat<T, M, N> a, const Mat<T, M, N>& b) {
  for (std::size_t i = 0; i < a.e.size(); ++i) a.e[i] += b.e[i];
  return a;
}
template <class T, int M, int N>
constexpr Mat<T, M, N> operator-(Mat<T, M, N> a, const Mat<T, M, N>& b) {
  for (std::size_t i = 0; i < a.e.size(); ++i) a.e[i] -= b.e[i];
  return a;
}
template <class T, int M, int N>
constexpr Mat<T, M, N> operator-(Mat<T, M, N> a) {
  for (auto& x : a.e) x = -x;
  return a;
}
template <class T, int M, int N, class S>
constexpr Mat<T, M, N> operator*(const S& s, Mat<T, M, N> a) {
  for (auto& x : a.e) x = s * x;
  return a;
}
template <class T, int M, int N>
constexpr Mat<T, M, N>& operator+=(Mat<T, M, N>& a, const Mat<T, M, N>& b) {
  for (std::size_t i = 0; i < a.e.size(); ++i) a.e[i] += b.e[i];
  return a;
}
template <class T, int M, int N>
constexpr Mat<T, M, N>& operator-=(Mat<T, M, N>& a, const Mat<T, M, N>& b) {
  for (std::size_t i = 0; i < a.e.size(); ++i) a.e[i] -= b.e[i];
  return a;
}

/// s += a b. Scalars with derivatives have their own, without temporaries, which are large there.
template <class T>
constexpr void add_product(T& s, const T& a, const T& b) {
  s += a * b;
}

/// s += w x^2 for a plain number w. Scalars with derivatives have their own, as above.
template <class T, class W>
constexpr void add_square(T& s, const T& x, const W& w) {
  s += x * x * w;
}

// Products.
template <class T, int N>
constexpr T dot(const Vec<T, N>& a, const Vec<T, N>& b) {
  T s = a[0] * b[0];
  for (int i = 1; i < N; ++i) add_product(s, a[i], b[i]);
  return s;
}
template <class T, int N>
constexpr T norm2(const Vec<T, N>& a) {
  return dot(a, a);
}
/// Frobenius product A : B.
template <class T, int M, int N>
constexpr T dot(const Mat<T, M, N>& a, const Mat<T, M, N>& b) {
  T s = a.e[0] * b.e[0];
  for (std::size_t i = 1; i < a.e.size(); ++i) add_product(s, a.e[i], b.e[i]);
  return s;
}
template <class T, int M, int N>
constexpr T norm2(const Mat<T, M, N>& a) {
  return dot(a, a);
}
template <class T>
constexpr Vec<T, 3> cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
// Of a vector of plain numbers (the geometry of the domain) and one of scalars with derivatives, in either order: the result has the derivatives.
template <class S, class T, int N>
requires(!std::is_same_v<S, T>) constexpr auto dot(const Vec<S, N>& a, const Vec<T, N>& b) {
  auto s = a[0] * b[0];
  for (int i = 1; i < N; ++i) s += a[i] * b[i];
  return s;
}
template <class S, class T>
requires(!std::is_same_v<S, T>) constexpr auto cross(const Vec<S, 3>& a, const Vec<T, 3>& b) {
  using R = decltype(a[0] * b[0]);
  return Vec<R, 3>{{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
template <class T, int M, int N>
constexpr Vec<T, M> operator*(const Mat<T, M, N>& a, const Vec<T, N>& x) {
  Vec<T, M> y;
  for (int i = 0; i < M; ++i) {
    T s = a(i, 0) * x[0];
    for (int j = 1; j < N; ++j) add_product(s, a(i, j), x[j]);
    y[i] = s;
  }
  return y;
}
template <class T, int M, int K, int N>
constexpr Mat<T, M, N> operator*(const Mat<T, M, K>& a, const Mat<T, K, N>& b) {
  Mat<T, M, N> c;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) {
      T s = a(i, 0) * b(0, j);
      for (int k = 1; k < K; ++k) add_product(s, a(i, k), b(k, j));
      c(i, j) = s;
    }
  return c;
}
template <class T, int M, int N>
constexpr Mat<T, N, M> transpose(const Mat<T, M, N>& a) {
  Mat<T, N, M> b;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) b(j, i) = a(i, j);
  return b;
}
/// A^T x.
template <class T, int M, int N>
constexpr Vec<T, N> transpose_times(const Mat<T, M, N>& a, const Vec<T, M>& x) {
  Vec<T, N> y;
  for (int j = 0; j < N; ++j) {
    T s = a(0, j) * x[0];
    for (int i = 1; i < M; ++i) add_product(s, a(i, j), x[i]);
    y[j] = s;
  }
  return y;
}
/// A^T B.
template <class T, int K, int M, int N>
constexpr Mat<T, M, N> transpose_times(const Mat<T, K, M>& a, const Mat<T, K, N>& b) {
  Mat<T, M, N> c;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) {
      T s = a(0, i) * b(0, j);
      for (int k = 1; k < K; ++k) add_product(s, a(k, i), b(k, j));
      c(i, j) = s;
    }
  return c;
}
template <class T, int M, int N>
constexpr Mat<T, M, N> outer(const Vec<T, M>& a, const Vec<T, N>& b) {
  Mat<T, M, N> c;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) c(i, j) = a[i] * b[j];
  return c;
}

template <class T, int N>
constexpr T trace(const Mat<T, N, N>& a) {
  T s = a(0, 0);
  for (int i = 1; i < N; ++i) s += a(i, i);
  return s;
}
template <class T, int N>
constexpr Mat<T, N, N> sym(const Mat<T, N, N>& a) {
  return 0.5 * (a + transpose(a));
}
template <class T, int N>
constexpr Mat<T, N, N> skew(const Mat<T, N, N>& a) {
  return 0.5 * (a - transpose(a));
}
template <class T, int N>
constexpr Mat<T, N, N> identity() {
  Mat<T, N, N> a;
  for (int i = 0; i < N; ++i) a(i, i) = T(1.0);
  return a;
}

/// [w]: the skew matrix with [w] x = w cross x.
template <class T>
constexpr Mat<T, 3, 3> hat(const Vec<T, 3>& w) {
  Mat<T, 3, 3> a;
  a(0, 1) = -w[2];
  a(0, 2) = w[1];
  a(1, 0) = w[2];
  a(1, 2) = -w[0];
  a(2, 0) = -w[1];
  a(2, 1) = w[0];
  return a;
}
/// Ax(M) = axl(M - M^T) = (M32 - M23, M13 - M31, M21 - M12); axl of a skew W is Ax(W) / 2.
template <class T>
constexpr Vec<T, 3> ax(const Mat<T, 3, 3>& m) {
  return {{m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}};
}

template <class T>
constexpr T determinant(const Mat<T, 1, 1>& a) {
  return a(0, 0);
}
template <class T>
constexpr T determinant(const Mat<T, 2, 2>& a) {
  return a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
}
template <class T>
constexpr T determinant(const Mat<T, 3, 3>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}
/// Cofactor matrix: A cof(A)^T = det(A) I.
template <class T>
constexpr Mat<T, 3, 3> cofactor(const Mat<T, 3, 3>& a) {
  Mat<T, 3, 3> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c(i, j) = a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
    }
  return c;
}
template <class T>
constexpr Mat<T, 2, 2> cofactor(const Mat<T, 2, 2>& a) {
  Mat<T, 2, 2> c;
  c(0, 0) = a(1, 1);
  c(0, 1) = -a(1, 0);
  c(1, 0) = -a(0, 1);
  c(1, 1) = a(0, 0);
  return c;
}
template <class T>
constexpr Mat<T, 1, 1> inverse(const Mat<T, 1, 1>& a) {
  Mat<T, 1, 1> b;
  b(0, 0) = T(1.0) / a(0, 0);
  return b;
}
/// Inverse by cofactors. The caller makes sure that the determinant is not zero; a zero one gives infinities.
template <class T, int N>
requires(N == 2 || N == 3) constexpr Mat<T, N, N> inverse(const Mat<T, N, N>& a) {
  const T d = T(1.0) / determinant(a);
  Mat<T, N, N> b = transpose(cofactor(a));
  for (auto& x : b.e) x = x * d;
  return b;
}

template <class T, int N>
constexpr Mat<T, N, N> diagonal(const Vec<T, N>& d) {
  Mat<T, N, N> a;
  for (int i = 0; i < N; ++i) a(i, i) = d[i];
  return a;
}
template <class T, int M, std::size_t N>
constexpr Mat<T, M, static_cast<int>(N)> matrix_of_columns(const std::array<Vec<T, M>, N>& columns) {
  Mat<T, M, static_cast<int>(N)> a;
  for (std::size_t j = 0; j < N; ++j)
    for (int i = 0; i < M; ++i) a(i, static_cast<int>(j)) = columns[j][i];
  return a;
}
template <class T, int M, int N>
constexpr Vec<T, M> column(const Mat<T, M, N>& a, int j) {
  Vec<T, M> c;
  for (int i = 0; i < M; ++i) c[i] = a(i, j);
  return c;
}

/// Entry-wise conversion of the scalar, e.g. double -> Jet (constants) or double -> Pack (broadcast).
template <class To, class From, int N>
constexpr Vec<To, N> cast(const Vec<From, N>& a) {
  Vec<To, N> b;
  for (int i = 0; i < N; ++i) b[i] = To(a[i]);
  return b;
}
template <class To, class From, int M, int N>
constexpr Mat<To, M, N> cast(const Mat<From, M, N>& a) {
  Mat<To, M, N> b;
  for (std::size_t i = 0; i < a.e.size(); ++i) b.e[i] = To(a.e[i]);
  return b;
}

}  // namespace karcher
