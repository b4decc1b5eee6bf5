#include <gtest/gtest.h>

#include <tuple>

#include "assembly/shell_adolc.hpp"
#include "assembly/shell_fallback.hpp"
#include "assembly/shell_oracle.hpp"
#include "assembly/shell_series.hpp"
#include "karcher/math/jet.hpp"

namespace karcher {
namespace {

using namespace shell_oracle;

std::vector<Element> random_elements(CellKind kind, int m_order, int r_order, Rule rule, ShellCoupling coupling, unsigned seed, double spread,
                                     int degree) {
  std::mt19937 generator(seed);
  std::vector<Element> elements;
  for (int lane = 0; lane < native_width; ++lane) {
    Element& e = elements.emplace_back(random_element(kind, m_order, r_order, generator, spread, degree));
    e.rule = rule;
    e.coupling = coupling;
  }
  return elements;
}

struct Difference {
  double energy = 0, gradient = 0, hessian = 0;  // relative to the largest entry
};

/// Second-order jets in six variables at a time: every pair of 3 x 3 blocks.
Difference compare_with_jets(const Element& e, const BatchResult& k, int lane) {
  using J = Jet<double, 6>;
  const int n = e.unknowns();
  Difference d;
  double largest_gradient = 0, largest_hessian = 0;
  const auto of = [&](const AlignedVector<double>& a, int i) { return a[static_cast<std::size_t>(i * native_width + lane)]; };
  for (int i = 0; i < n; i += 3)
    for (int j = i; j < n; j += 3) {
      std::vector<J> x(static_cast<std::size_t>(n));
      for (int c = 0; c < 3; ++c) {
        x[static_cast<std::size_t>(i + c)] = J::variable(0, c);
        if (j != i) x[static_cast<std::size_t>(j + c)] = J::variable(0, 3 + c);
      }
      const J w = energy(e, x.data());
      d.energy = std::max(d.energy, std::fabs(w.v - k.energy[static_cast<std::size_t>(lane)]) / w.v);
      for (int r = 0; r < 3; ++r) {
        largest_gradient = std::max(largest_gradient, std::fabs(w.gradient(r)));
        d.gradient = std::max(d.gradient, std::fabs(w.gradient(r) - of(k.gradient, i + r)));
        for (int c = 0; c < 3; ++c) {
          const double h = w.hessian(r, i == j ? c : 3 + c);
          largest_hessian = std::max(largest_hessian, std::fabs(h));
          d.hessian = std::max(d.hessian, std::fabs(h - of(k.hessian, (i + r) * n + j + c)));
        }
      }
    }
  d.gradient /= largest_gradient;
  d.hessian /= largest_hessian;
  return d;
}

Difference compare_with_adolc(const Element& e, const BatchResult& k, int lane) {
  const Derivatives a = by_adolc(e);
  const auto n = static_cast<std::size_t>(e.unknowns()), l = static_cast<std::size_t>(lane);
  Difference d;
  double largest_gradient = 0, largest_hessian = 0;
  d.energy = std::fabs(a.energy - k.energy[l]) / a.energy;
  for (std::size_t r = 0; r < n; ++r) {
    largest_gradient = std::max(largest_gradient, std::fabs(a.gradient[r]));
    d.gradient = std::max(d.gradient, std::fabs(a.gradient[r] - k.gradient[r * native_width + l]));
    for (std::size_t c = r; c < n; ++c) {
      const double h = a.hessian[c][r];
      largest_hessian = std::max(largest_hessian, std::fabs(h));
      d.hessian = std::max(d.hessian, std::fabs(h - k.hessian[(r * n + c) * native_width + l]));
    }
  }
  d.gradient /= largest_gradient;
  d.hessian /= largest_hessian;
  return d;
}

void expect_small(const Difference& d, double tolerance) {
  EXPECT_LT(d.energy, tolerance);
  EXPECT_LT(d.gradient, tolerance);
  EXPECT_LT(d.hessian, tolerance);
}

/// Cell, order of the deformation, order of the rotation, rule, coupling.
using Case = std::tuple<CellKind, int, int, Rule, ShellCoupling>;

class ShellKernel : public testing::TestWithParam<Case> {
 protected:
  static std::vector<Element> elements(unsigned seed, double spread, int degree) {
    const auto [kind, m, r, rule, coupling] = GetParam();
    return random_elements(kind, m, r, rule, coupling, seed, spread, degree);
  }
};

TEST_P(ShellKernel, AgreesWithAdolCInEnergyGradientAndHessian) {
  const auto e = elements(11, 0.3, 3);
  const BatchResult k = evaluate(e[0], Lanes(e), Want::hessian);
  const auto lane = e.size() - 1;
  ASSERT_EQ(k.trouble[lane], Trouble::none);
  expect_small(compare_with_adolc(e[lane], k, static_cast<int>(lane)), 1e-12);
}

TEST_P(ShellKernel, GivesTheSameEnergyAndGradientWhateverElseIsWanted) {
  const auto e = elements(12, 0.4, 5);
  const Lanes lanes(e);
  const BatchResult full = evaluate(e[0], lanes, Want::hessian), gradient = evaluate(e[0], lanes, Want::gradient),
                    value = evaluate(e[0], lanes, Want::energy);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < full.gradient.size(); ++i) {
    largest = std::max(largest, std::fabs(full.gradient[i]));
    difference = std::max(difference, std::fabs(full.gradient[i] - gradient.gradient[i]));
  }
  EXPECT_LT(difference, 1e-14 * largest);
  for (std::size_t lane = 0; lane < e.size(); ++lane) {
    EXPECT_NEAR(gradient.energy[lane], full.energy[lane], 1e-14 * full.energy[lane]);
    EXPECT_NEAR(value.energy[lane], full.energy[lane], 1e-14 * full.energy[lane]);
  }
}

TEST_P(ShellKernel, IsInvariantUnderRigidMotions) {
  auto e = elements(13, 0.3, 5);
  const BatchResult before = evaluate(e[0], Lanes(e), Want::gradient);
  const auto turn = quaternion_of({{0.7, -1.1, 0.4}});
  const Mat3<double> a = rotation(turn);
  for (Element& x : e) {
    for (auto& m : x.m) m = a * m + Vec3<double>{{0.3, -2, 0.8}};
    for (auto& q : x.q) q = product(turn, q);
  }
  const BatchResult after = evaluate(e[0], Lanes(e), Want::gradient);
  for (std::size_t lane = 0; lane < e.size(); ++lane) EXPECT_NEAR(after.energy[lane], before.energy[lane], 1e-12 * before.energy[lane]);
  // body coordinates of the rotations: their part of the gradient is the same number for number
  const auto first = static_cast<std::size_t>(3 * e[0].tables.m_nodes * native_width);
  for (std::size_t i = first; i < before.gradient.size(); ++i) EXPECT_NEAR(after.gradient[i], before.gradient[i], 1e-12);
}

TEST_P(ShellKernel, HasTaylorRemaindersOfOrderTwoAndThree) {
  auto e = elements(14, 0.3, 5);
  const Lanes lanes(e);
  const BatchResult k = evaluate(e[0], lanes, Want::hessian);
  const auto n = static_cast<std::size_t>(e[0].unknowns());
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  std::array<double, 2> linear{}, quadratic{};  // sums of squares over some directions
  const std::array<double, 2> steps{4e-3, 2e-3};
  for (int direction = 0; direction < 6; ++direction) {
    std::vector<double> x(n);
    for (double& v : x) v = normal(generator);
    for (std::size_t s = 0; s < 2; ++s) {
      Element moved_element = e[0];
      std::size_t at = 0;
      for (auto& m : moved_element.m)
        for (int c = 0; c < 3; ++c) m[c] += steps[s] * x[at++];
      for (auto& q : moved_element.q) {
        q = product(q, quaternion_of({{steps[s] * x[at], steps[s] * x[at + 1], steps[s] * x[at + 2]}}));
        at += 3;
      }
      Lanes trial = lanes;
      trial.set_configuration(moved_element, 0);
      double remainder = evaluate(e[0], trial, Want::energy).energy[0] - k.energy[0];
      for (std::size_t r = 0; r < n; ++r) remainder -= steps[s] * x[r] * k.gradient[r * native_width];
      linear[s] += remainder * remainder;
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = r; c < n; ++c)
          remainder -= (c == r ? 0.5 : 1.0) * steps[s] * steps[s] * x[r] * x[c] * k.hessian[(r * n + c) * native_width];
      quadratic[s] += remainder * remainder;
    }
  }
  EXPECT_NEAR(0.5 * std::log2(linear[0] / linear[1]), 2, 0.1);
  EXPECT_NEAR(0.5 * std::log2(quadratic[0] / quadratic[1]), 3, 0.1);
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const auto [kind, m, r, rule, coupling] = info.param;
  return std::string(kind == CellKind::triangle ? "P" : "Q") + std::to_string(m) + (kind == CellKind::triangle ? "P" : "Q") + std::to_string(r) +
         (rule == Rule::projection ? "Projection" : "Geodesic") + (coupling == ShellCoupling::standard ? "" : "Birsan2021");
}

INSTANTIATE_TEST_SUITE_P(AllOrders, ShellKernel,
                         testing::Combine(testing::Values(CellKind::triangle, CellKind::quadrilateral), testing::Values(1, 2, 3),
                                          testing::Values(1, 2, 3), testing::Values(Rule::projection),
                                          testing::Values(ShellCoupling::standard, ShellCoupling::birsan_2021)),
                         case_name);
INSTANTIATE_TEST_SUITE_P(AllOrdersGeodesic, ShellKernel,
                         testing::Combine(testing::Values(CellKind::triangle, CellKind::quadrilateral), testing::Values(1, 2),
                                          testing::Values(1, 2, 3), testing::Values(Rule::geodesic), testing::Values(ShellCoupling::standard)),
                         case_name);

TEST(ShellKernel, AgreesWithJetsInEveryLane) {
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    const auto e = random_elements(CellKind::triangle, 2, 2, rule, ShellCoupling::standard, 21, 0.3, 5);
    const BatchResult k = evaluate(e[0], Lanes(e), Want::hessian);
    for (std::size_t lane = 0; lane < e.size(); lane += rule == Rule::projection ? 1 : 5)
      expect_small(compare_with_jets(e[lane], k, static_cast<int>(lane)), 1e-12);
  }
}

TEST(ShellKernel, IsExactForLargeRotationsWithinAnElement) {
  // Two rotations of a linear triangle around one axis, close to the limit of either rule: half a turn between neighbours for the projection at the
  // midpoint,
  // 90 degrees from the mean for the geodesic rule.
  for (Rule rule : {Rule::projection, Rule::geodesic})
    for (double angle : {1.0, 2.0, 2.9}) {
      auto e = random_elements(CellKind::triangle, 1, 1, rule, ShellCoupling::standard, 31, 0, 2);
      e.resize(1);
      const auto common = e[0].q[0];
      e[0].q[0] = product(common, quaternion_of({{0, 0, -angle / 2}}));
      e[0].q[1] = product(common, quaternion_of({{0, 0, angle / 2}}));
      e[0].q[2] = product(common, quaternion_of({{0.3, 0.2, 0.1}}));
      const BatchResult k = evaluate(e[0], Lanes(e), Want::hessian);
      ASSERT_EQ(k.trouble[0], Trouble::none) << angle;
      expect_small(compare_with_jets(e[0], k, 0), 1e-10);
    }
}

TEST(ShellKernel, FindsTheClosestRotationWhereNewtonsMethodFails) {
  // Rotations of a radian per axis and more make Newton's method fail in about one point of ten; the energy must be that of the eigenvector's
  // rotation.
  std::mt19937 generator(3);
  int points = 0;
  for (int sample = 0; sample < 40; ++sample) {
    const Element e = random_element(CellKind::triangle, 2, 2, generator, 1.1);
    const BatchResult k = evaluate(e, Lanes({e}), Want::energy);
    if (k.trouble[0] != Trouble::none) continue;
    double expected = 0;
    for (int p = 0; p < e.tables.points; ++p) {
      Quaternion<double> found;
      ASSERT_TRUE(shell::closest_rotation(e.q.data(), e.tables.r_value.data() + p * 6, 6, found));
      const Mat3<double> rot = rotation(found);
      Mat3<double> s, strain, curvature;
      std::array<Mat3<double>, 2> ds{};
      std::array<Vec3<double>, 2> d{};
      const double *l = e.tables.r_value.data() + p * 6, *dl = e.tables.r_gradient.data() + p * 12, *dm = e.tables.m_gradient.data() + p * 12;
      for (std::size_t i = 0; i < 6; ++i) {
        const Mat3<double> z = transpose_times(rot, rotation(e.q[i]));
        s += l[i] * z;
        for (std::size_t a = 0; a < 2; ++a) {
          ds[a] += dl[2 * i + a] * z;
          d[a] += dm[2 * i + a] * e.m[i];
        }
      }
      EXPECT_LT(norm2(ax(s)), 1e-24);
      const Mat3<double> g = trace(s) * identity<double, 3>() - sym(s);
      const SurfaceGeometry& surface = e.geometry[static_cast<std::size_t>(p)];
      for (std::size_t a = 0; a < 2; ++a) {
        strain += outer(transpose_times(rot, d[a]), surface.dual[a]);
        curvature += outer(inverse(g) * ax(ds[a]), surface.dual[a]);
      }
      strain -= identity<double, 3>() - outer(surface.normal, surface.normal);
      expected += e.weight[static_cast<std::size_t>(p)] *
                  cosserat_shell_density(strain, curvature, surface.b, surface.c, surface.normal, e.material[static_cast<std::size_t>(p)], e.coupling)
                      .total();
      ++points;
    }
    EXPECT_NEAR(k.energy[0], expected, 1e-9 * expected) << sample;
  }
  EXPECT_GT(points, 200);
}

TEST(ShellKernel, ReportsAnUndefinedProjectionInItsLaneAlone) {
  auto e = random_elements(CellKind::triangle, 1, 1, Rule::projection, ShellCoupling::standard, 41, 0.2, 1);
  const BatchResult good = evaluate(e[0], Lanes(e), Want::hessian);
  // Three rotations by thirds of a turn around one axis: at the centroid their mean has no closest rotation.
  Element& bad = e.back();
  const double third = 2 * std::acos(-1.0) / 3;
  for (std::size_t i = 0; i < 3; ++i) bad.q[i] = quaternion_of({{0, 0, static_cast<double>(i) * third}});
  const BatchResult k = evaluate(e[0], Lanes(e), Want::hessian);
  const std::size_t lane = e.size() - 1;
  EXPECT_EQ(k.trouble[lane], Trouble::undefined_interpolation);
  EXPECT_TRUE(std::isinf(k.energy[lane]));
  for (std::size_t other = 0; other < lane; ++other) {
    EXPECT_EQ(k.trouble[other], Trouble::none);
    EXPECT_NEAR(k.energy[other], good.energy[other], 1e-14 * good.energy[other]);
  }
}

TEST(ShellKernel, RefusesGeodesicDataThatHaveNoUniqueMean) {
  auto e = random_elements(CellKind::triangle, 1, 1, Rule::geodesic, ShellCoupling::standard, 42, 0.2, 2);
  const double third = 2 * std::acos(-1.0) / 3;
  for (std::size_t i = 0; i < 3; ++i) e[0].q[i] = quaternion_of({{0, 0, static_cast<double>(i) * third}});
  const BatchResult k = evaluate(e[0], Lanes(e), Want::gradient);
  EXPECT_EQ(k.trouble[0], Trouble::undefined_interpolation);
  for (std::size_t lane = 1; lane < e.size(); ++lane) EXPECT_EQ(k.trouble[lane], Trouble::none);
}

TEST(ShellKernel, ReportsDataThatAreNotFinite) {
  auto e = random_elements(CellKind::triangle, 2, 2, Rule::projection, ShellCoupling::standard, 43, 0.2, 5);
  e[0].m[2][1] = std::nan("");
  EXPECT_EQ(evaluate(e[0], Lanes(e), Want::energy).trouble[0], Trouble::not_finite);
  e[0].m[2][1] = 1e200;
  EXPECT_EQ(evaluate(e[0], Lanes(e), Want::hessian).trouble[0], Trouble::not_finite);
  e[0].m[2][1] = 0;
  e[0].q[1][0] = std::nan("");
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    e[0].rule = rule;
    EXPECT_NE(evaluate(e[0], Lanes(e), Want::energy).trouble[0], Trouble::none);
  }
}

TEST(ShellSeries, MatchTheFunctionsThatTheyStandFor) {
  for (double angle = 1e-8; angle < std::acos(-1.0); angle = angle * 1.3 + 1e-3) {
    EXPECT_NEAR(shell::angle_over_sine(std::cos(angle / 2)) * std::sin(angle / 2) / angle, 1, 4e-16 + 1e-16 / (angle * angle)) << angle;
    const double x = angle / 2, tau = angle * angle;
    const double beta = angle < 0.05 ? 1.0 / 12 + tau / 720 + tau * tau / 30240 : (1 - x / std::tan(x)) / tau;
    EXPECT_NEAR(shell::beta_of(tau), beta, 1e-13) << angle;
    EXPECT_NEAR(shell::beta_jet(tau)[0], shell::beta_of(tau), 1e-16);
    // derivatives by central differences of the value
    const double h = 1e-4;
    if (tau > h && tau + h < shell::pi2) {
      EXPECT_NEAR(shell::beta_jet(tau)[1], (shell::beta_of(tau + h) - shell::beta_of(tau - h)) / (2 * h), 1e-11);
      EXPECT_NEAR(shell::beta_jet(tau)[2], (shell::beta_jet(tau + h)[1] - shell::beta_jet(tau - h)[1]) / (2 * h), 1e-11);
    }
  }
}

}  // namespace
}  // namespace karcher
