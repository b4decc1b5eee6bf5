// What a manifold is called is nobody's business: two types that differ in nothing but their names give the same bits.
#include <gtest/gtest.h>

#include <cmath>

#include "karcher/manifold/sphere.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/norm.hpp"
#include "karcher/solve/petsc.hpp"
#include "solve/small_problem.hpp"

namespace karcher {
namespace {

/// Lines through the origin of R^3, as the nearer of their two unit vectors.
struct Directors : Sphere<2> {
  template <class T>
  static Vec<T, 3> log(const Vec<T, 3>& p, const Vec<T, 3>& q) {
    return unit_vector::projective_log(p, q);
  }
};
struct Line : Directors {
  static constexpr std::string_view name = "Line";
};
struct RP2 : Directors {  // begins as R2 does
  static constexpr std::string_view name = "RP2";
};

/// Sum over cells of 1/2 (1 - <a, b>^2) and of 1/2 u.A u at both nodes, A = diag(1, 2, 4): neighbours are alike, and like to lie along the first axis.
/// Derivatives are those of the pullback through exp, whose second derivative along the frame is -u.
testing::CellValue alike(const std::vector<const double*>& u, const Vec3<double>&, double, double* g, double* h) {
  const double eigenvalues[] = {1, 2, 4};
  double frame[2][6], product = 0, energy = 0;
  for (int i = 0; i < 3; ++i) product += u[0][i] * u[1][i];
  energy += 0.5 * (1 - product * product);
  for (std::size_t node = 0; node < 2; ++node) {
    manifold_ops<Line>().frame(u[node], frame[node]);
    double twice = 0;
    for (int i = 0; i < 3; ++i) twice += eigenvalues[i] * u[node][i] * u[node][i];
    energy += 0.5 * twice;
    for (std::size_t k = 0; k < 2; ++k) {
      double slope = 0, turn = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        slope += frame[node][i * 2 + k] * eigenvalues[i] * u[node][i];
        turn += frame[node][i * 2 + k] * u[1 - node][i];
      }
      if (g) g[node * 2 + k] = slope - product * turn;
      for (std::size_t l = 0; h && l < 2; ++l) {
        double c = k == l ? product * product - twice : 0.0, other = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          c += frame[node][i * 2 + k] * eigenvalues[i] * frame[node][i * 2 + l];
          other += frame[node][i * 2 + l] * u[1 - node][i];
        }
        h[(node * 2 + k) * 4 + node * 2 + l] = c - turn * other;
      }
    }
  }
  for (std::size_t k = 0; h && k < 2; ++k)
    for (std::size_t l = 0; l < 2; ++l) {
      double across = 0, first = 0, second = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        across += frame[0][i * 2 + k] * frame[1][i * 2 + l];
        first += frame[0][i * 2 + k] * u[1][i];
        second += frame[1][i * 2 + l] * u[0][i];
      }
      h[k * 4 + 2 + l] = h[(2 + l) * 4 + k] = -product * across - first * second;
    }
  return {energy};
}

TEST(Names, OfAManifoldDoNotChangeTheNormOfSteps) {
  const std::vector<double> values(3 * 1001);
  const testing::SmallProblem p(1000, manifold_ops<Line>(), {}, values);
  const std::vector<double> line = step_mass(*p.layout);
  EXPECT_EQ(line, step_mass(*testing::SmallProblem(1000, manifold_ops<RP2>(), {}, values).layout));
  double sum = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(p.layout->owned_dofs()); ++d) sum += line[d];
  EXPECT_NEAR(sum_over_ranks(sum), 2,
              1e-12);  // one for each tangent coordinate: the mean square of an angle is measured by 1, not by the size of the mesh
}

TEST(Names, OfAManifoldDoNotChangeAMinimisation) {
  std::vector<double> initial;
  for (int i = 0; i <= 40; ++i)
    for (double x : {std::sin(0.3 + i) * 0.6, std::cos(0.3 + i), std::sin(0.3 + i) * 0.8}) initial.push_back(x);
  const auto minimum = [&](const ManifoldOps& manifold) {
    testing::SmallProblem p(40, manifold, alike, initial);
    const StepReport report = minimize(*p.functional, p.u, {.gradient_tolerance = 1e-10}, {});
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_NEAR(report.energy, 80 * 0.5, 1e-10);  // all along the first axis
    complete(*p.layout, p.u);
    return std::pair(report.iterations, p.u.values);
  };
  const auto line = minimum(manifold_ops<Line>()), rp2 = minimum(manifold_ops<RP2>());
  EXPECT_EQ(line.first, rp2.first);
  if (world_size() == 1) {
    EXPECT_EQ(line.second, rp2.second);
    return;
  }
  // MUMPS adds the contributions of several ranks as they arrive.
  for (std::size_t i = 0; i < line.second[0].size(); ++i) EXPECT_NEAR(line.second[0][i], rp2.second[0][i], 1e-12);
}

}  // namespace
}  // namespace karcher
