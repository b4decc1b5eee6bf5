#include "karcher/math/symmetric.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/testing/derivative_checks.hpp"
#include "karcher/testing/random.hpp"

using namespace karcher;

namespace {

template <int N>
Mat<double, N, N> random_symmetric(Random& random, double size) {
  Mat<double, N, N> a;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) a(i, j) = a(j, i) = size * random.normal();
  return a;
}

template <int N>
double largest_entry(const Mat<double, N, N>& a) {
  double m = 0;
  for (double x : a.e) m = std::max(m, std::abs(x));
  return m;
}

template <int N>
Mat<double, N, N> with_eigenvalues(Random& random, const Vec<double, N>& lambda) {
  const auto q = eigen(random_symmetric<N>(random, 1)).vectors;
  return sym(q * diagonal(lambda) * transpose(q));
}

/// Divided difference by the defining recursion in extended precision, for points that are far apart.
template <class F>
long double plain_divided_difference(F f, const std::vector<long double>& x) {
  if (x.size() == 1) return f(x[0]);
  const std::vector<long double> left(x.begin(), x.end() - 1), right(x.begin() + 1, x.end());
  return (plain_divided_difference(f, right) - plain_divided_difference(f, left)) / (x.back() - x.front());
}

}  // namespace

TEST(Symmetric, CholeskyAndCongruencesFitTogether) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const auto s = random_symmetric<3>(random, 1);
    const auto a = s * s + identity<double, 3>();
    const auto l = cholesky(a);
    EXPECT_LT(largest_entry(l * transpose(l) - a), 1e-14);
    EXPECT_LT(largest_entry(lower_congruence(lower_inverse(l), a) - identity<double, 3>()), 1e-13);
    EXPECT_LT(largest_entry(lower_congruence(l, s) - l * s * transpose(l)), 1e-13);
  }
  Mat<double, 2, 2> indefinite;
  indefinite(0, 0) = indefinite(1, 1) = 1;
  indefinite(1, 0) = indefinite(0, 1) = 2;
  EXPECT_FALSE(cholesky(indefinite)(1, 1) > 0);
}

TEST(Symmetric, EigenDecomposesToRounding) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const auto a = random_symmetric<4>(random, std::pow(10, i % 7 - 3));
    const auto e = eigen(a);
    EXPECT_LT(largest_entry(e.vectors * diagonal(e.values) * transpose(e.vectors) - a), 1e-14 * largest_entry(a));
    EXPECT_LT(largest_entry(transpose_times(e.vectors, e.vectors) - identity<double, 4>()), 1e-14);
  }
  const auto diagonal_matrix = eigen(diagonal(Vec<double, 3>{{3, 1, 2}}));
  EXPECT_EQ(diagonal_matrix.values[0], 3);
  EXPECT_EQ(diagonal_matrix.values[1], 1);
}

TEST(Symmetric, ExpIsTheLimitOfItsSeries) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const auto s = random_symmetric<3>(random, 0.5);
    auto term = identity<double, 3>(), sum = term;
    for (int k = 1; k < 40; ++k) {
      term = (1.0 / k) * (term * s);
      sum += term;
    }
    EXPECT_LT(largest_entry(symmetric_exp(s) - sum), 1e-14 * largest_entry(sum));
  }
}

TEST(Symmetric, LogInvertsExpAndLog1pKeepsTheDigitsOfSmallMatrices) {
  Random random(6);
  for (double size : {1e-12, 1e-6, 1e-2, 0.3, 2.0}) {
    const auto s = random_symmetric<3>(random, size);
    EXPECT_LT(largest_entry(symmetric_log(symmetric_exp(s)) - s), 1e-14 * std::exp(4 * size));
    if (size < 1e-5) {
      // log(I + S) = S - S^2/2 + S^3/3 - ...
      EXPECT_LT(largest_entry(symmetric_log1p(s) - (s - 0.5 * (s * s) + (1.0 / 3) * (s * s * s))), 1e-15 * size);
    }
  }
}

TEST(Symmetric, DividedDifferencesAgreeWithTheirDefinitionAndWithDerivativesAtEqualPoints) {
  namespace d = symmetric_detail;
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const double spread = random.log_uniform(0.02, 3);
    std::array<double, 4> x;
    for (double& y : x) y = 1.5 * std::exp(spread * random.uniform(-0.5, 0.5));
    std::array<double, 4> e, l;
    std::vector<long double> points;
    for (std::size_t k = 0; k < 4; ++k) {
      e[k] = std::exp(x[k]);
      l[k] = std::log(x[k]);
      points.push_back(x[k]);
    }
    std::sort(points.begin(), points.end());
    // The definition in extended precision loses the digits of the smallest gap for each difference.
    double gap = 10;
    for (std::size_t k = 0; k < 3; ++k) gap = std::min(gap, static_cast<double>(points[k + 1] - points[k]));
    if (gap < 0.01) continue;
    const double limit = 1e-13 + 1e-19 / (gap * gap * gap);
    const double exact_exp = static_cast<double>(plain_divided_difference([](long double t) { return std::exp(t); }, points));
    const double exact_log = static_cast<double>(plain_divided_difference([](long double t) { return std::log(t); }, points));
    EXPECT_NEAR((d::divided_difference_sorting<d::Exponential, 4, double>(x, e)) / exact_exp, 1, limit);
    EXPECT_NEAR((d::divided_difference_sorting<d::Logarithm, 4, double>(x, l)) / exact_log, 1, limit);
  }
  // f[x, ..., x] = f^(n)(x)/n!
  const double x = 0.7, f = std::log(x);
  EXPECT_NEAR((d::divided_difference<d::Logarithm, 3, double>({x, x, x}, {f, f, f})), -0.5 / (x * x), 1e-15);
  EXPECT_NEAR((d::divided_difference<d::Logarithm, 4, double>({x, x, x, x}, {f, f, f, f})), 1 / (3 * x * x * x), 1e-15);
  EXPECT_NEAR((d::divided_difference<d::Exponential, 4, double>({x, x, x, x}, {0, 0, 0, 0})), std::exp(x) / 6, 1e-15);
}

TEST(Symmetric, ExpAndLogHaveExactDerivativesWhereEigenvaluesMeet) {
  Random random(8);
  using J = Jet<double, 1>;
  for (const Vec<double, 3>& lambda :
       {Vec<double, 3>{{1, 1, 1}}, Vec<double, 3>{{2, 2, 0.3}}, Vec<double, 3>{{1, 1 + 1e-9, 1 - 1e-8}}, Vec<double, 3>{{0.1, 3, 8}}}) {
    const auto a = with_eigenvalues(random, lambda), b = random_symmetric<3>(random, 0.3), c = random_symmetric<3>(random, 1);
    const auto along = [&](const auto& t, auto function) {
      using S = std::decay_t<decltype(t)>;
      return dot(cast<S>(c), function(cast<S>(a) + t * cast<S>(b)));
    };
    const auto check = [&](const char* name, auto function) {
      const J j = along(J::variable(0, 0), function);
      const auto f = [&](double t) { return along(t, function); };
      const TaylorSlopes s = taylor_slopes(f, f(0), j.gradient(0), j.hessian(0, 0), 0.05);
      EXPECT_TRUE(s.hessian_holds()) << name << " " << lambda[0] << " " << lambda[1] << " " << lambda[2] << ": " << s.sentence();
      // third derivative
      Dual<J, 1> t = J::variable(0, 0);
      t.d[0] = J(1.0);
      const double third = along(t, function).d[0].hessian(0, 0), h = 1e-3;
      const auto second = [&](double x) { return along(J::variable(x, 0), function).hessian(0, 0); };
      const double difference = (8 * (second(h) - second(-h)) - (second(2 * h) - second(-2 * h))) / (12 * h);
      EXPECT_NEAR(third, difference, 1e-6 * (1 + std::abs(difference))) << name;
    };
    check("exp", [](const auto& m) { return symmetric_exp(m); });
    check("log", [](const auto& m) { return symmetric_log(m); });
  }
}

TEST(Symmetric, SquaredLogHasTheDerivativesOfTheLogWhereverItsEigenvaluesAre) {
  Random random(11);
  using S = Jet<double, 6>;
  for (const Vec<double, 3>& lambda :
       {Vec<double, 3>{{0.5, -0.3, 2}}, {{0.4, 0.4, -0.2}}, {{0.4, 0.4 + 1e-9, 0.4}}, {{0, 0, 0}}, {{-0.999, 30, 1}}}) {
    const Mat<double, 3, 3> at = with_eigenvalues(random, lambda);
    Mat<S, 3, 3> s;
    for (int i = 0, n = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++n) s(i, j) = s(j, i) = S::variable(at(i, j), n);
    const S direct = squared_log1p(s), by_log = norm2(symmetric_log1p(s));
    const double size = 1 + 1e3 * (lambda[0] < -0.9 ? 1e3 : 0);
    EXPECT_NEAR(direct.v, by_log.v, 1e-13 * size);
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(direct.gradient(i), by_log.gradient(i), 1e-13 * size);
      for (int j = i; j < 6; ++j) EXPECT_NEAR(direct.hessian(i, j), by_log.hessian(i, j), 2e-13 * size * size) << lambda[0];
    }
    EXPECT_EQ(squared_log1p(at), direct.v);
  }
  EXPECT_TRUE(std::isnan(squared_log1p(with_eigenvalues(random, Vec<double, 3>{{-1.5, 0, 1}}))));
}
