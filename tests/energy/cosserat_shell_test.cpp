#include "karcher/energy/cosserat_shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "karcher/math/jet.hpp"

namespace karcher {
namespace {

/// A surface with principal curvatures k1, k2 along the columns of a random orthonormal frame.
struct Surface {
  double k1, k2;
  Vec3<double> t1, t2, n;
  Mat3<double> b, c;

  Surface(double first, double second, std::mt19937& generator) : k1(first), k2(second) {
    std::normal_distribution<double> normal;
    const Vec3<double> x{{normal(generator), normal(generator), normal(generator)}}, y{{normal(generator), normal(generator), normal(generator)}};
    t1 = (1 / std::sqrt(norm2(x))) * x;
    const Vec3<double> z = y - dot(y, t1) * t1;
    t2 = (1 / std::sqrt(norm2(z))) * z;
    n = cross(t1, t2);
    b = k1 * outer(t1, t1) + k2 * outer(t2, t2);
    c = outer(t1, t2) - outer(t2, t1);
  }
};

Mat3<double> random_strain(const Surface& s, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Mat3<double> e;
  for (double& x : e.e) x = normal(generator);
  return e * (identity<double, 3>() - outer(s.n, s.n));  // strains act on tangent vectors
}

ShellMaterial<double> material() { return {0.7, 1.3, 0.9, 0.4, 0.3, {1.1, 0.8, 0.6}}; }

double quadratic(const ShellForm<double>& f, const Surface& s, const Mat3<double>& e, const Mat3<double>& k) {
  const auto component = [&](const Mat3<double>& x, int c, int d) {
    const std::array<Vec3<double>, 3> frame{s.t1, s.t2, s.n};
    return dot(frame[static_cast<std::size_t>(c - 1)], x * frame[static_cast<std::size_t>(d - 1)]);
  };
  const std::array<double, 4> a{component(e, 1, 1), component(e, 2, 2), component(k, 2, 1), component(k, 1, 2)},
      b{component(e, 1, 2), component(e, 2, 1), component(k, 2, 2), component(k, 1, 1)},
      scalars{component(e, 3, 1), component(e, 3, 2), component(k, 3, 1), component(k, 3, 2)};
  double w = 0;
  for (int i = 0; i < 4; ++i) {
    const auto p = static_cast<std::size_t>(i);
    for (int j = i; j < 4; ++j) {
      const auto q = static_cast<std::size_t>(j);
      w += (i == j ? 0.5 : 1.0) * (f.a[ShellForm<double>::index(i, j)] * a[p] * a[q] + f.b[ShellForm<double>::index(i, j)] * b[p] * b[q]);
    }
    w += 0.5 * f.s[p] * scalars[p] * scalars[p];
  }
  return w;
}

TEST(CosseratShell, PrincipalFormEqualsTheTensorsPartByPart) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> curvature(-2, 2);
  for (ShellCoupling coupling : {ShellCoupling::standard, ShellCoupling::birsan_2021})
    for (int sample = 0; sample < 50; ++sample) {
      const Surface s(curvature(generator), curvature(generator), generator);
      const Mat3<double> e = random_strain(s, generator), k = random_strain(s, generator);
      const auto w = cosserat_shell_density(e, k, s.b, s.c, s.n, material(), coupling);
      const auto form = [&](ShellParts parts) { return quadratic(shell_form(s.k1, s.k2, material(), coupling, parts), s, e, k); };
      const double scale = 1e-14 * (std::fabs(w.membrane) + std::fabs(w.bending) + std::fabs(w.curvature));
      EXPECT_NEAR(form({}), w.total(), scale);
      EXPECT_NEAR(form({true, false, false}), w.membrane, scale);
      EXPECT_NEAR(form({false, true, false}), w.bending, scale);
      EXPECT_NEAR(form({false, false, true}), w.curvature, scale);
    }
}

TEST(CosseratShell, IsEvenInTheNormal) {
  std::mt19937 generator(2);
  for (ShellCoupling coupling : {ShellCoupling::standard, ShellCoupling::birsan_2021}) {
    const Surface s(0.8, -0.5, generator);
    const Mat3<double> e = random_strain(s, generator), k = random_strain(s, generator);
    const double one = cosserat_shell_density(e, k, s.b, s.c, s.n, material(), coupling).total();
    const double other = cosserat_shell_density(e, k, -s.b, -s.c, -s.n, material(), coupling).total();
    EXPECT_NEAR(other, one, 1e-15 * one);
  }
}

TEST(CosseratShell, HasTheClosedFormOnACylinder) {
  // Sector phi -> alpha phi, radius r -> r': s = r' alpha/r, E = (s - 1) e_phi (x) e_phi, K = kappa e_z (x) e_phi, and E b + c K must be (alpha - s)/r, which
  // fixes the relative sign of b and c. Outward normal: b = -(1/r) e_phi (x) e_phi.
  const double r = 0.8, r1 = 1.1, alpha = 1.3, s = r1 * alpha / r, kappa = (alpha - 1) / r, chi = (alpha - s) / r;
  const Vec3<double> phi{{0, 1, 0}}, z{{0, 0, 1}}, n{{1, 0, 0}};
  const Mat3<double> b = (-1 / r) * outer(phi, phi), c = outer(phi, z) - outer(z, phi);
  const Mat3<double> e = (s - 1) * outer(phi, phi), k = kappa * outer(z, phi), bending = e * b + c * k;
  EXPECT_NEAR(dot(phi, bending * phi), chi, 1e-15);
  const auto m = material();
  const double h = m.thickness, stretch = m.mu + m.lambda * m.mu / (m.lambda + 2 * m.mu);
  const double curvature = m.mu * m.internal_length * m.internal_length * (m.b[0] + m.b[1]) / 2;
  const auto w = cosserat_shell_density(e, k, b, c, n, m, ShellCoupling::standard);
  EXPECT_NEAR(w.membrane, h * stretch * (s - 1) * (s - 1), 1e-15);
  EXPECT_NEAR(w.bending, std::pow(h, 3) / 12 * stretch * chi * chi + std::pow(h, 5) / 80 * (m.mu + m.lambda / 2) * std::pow(chi / r, 2), 1e-15);
  EXPECT_NEAR(w.curvature, curvature * kappa * kappa * (h + std::pow(h, 3) / (12 * r * r) + std::pow(h, 5) / (80 * std::pow(r, 4))), 1e-15);
}

TEST(CosseratShell, RefinedFormHasTheHarmonicMeanAsShearModulus) {
  // On a flat sheet with E = gamma n (x) t: W = h (mu + mu_c)/2 gamma^2 in the default form, h 2 mu mu_c/(mu + mu_c) gamma^2 in the refined one.
  const Vec3<double> t{{1, 0, 0}}, n{{0, 0, 1}};
  const auto m = material();
  const Mat3<double> zero, e = 0.3 * outer(n, t), c = outer(t, Vec3<double>{{0, 1, 0}}) - outer(Vec3<double>{{0, 1, 0}}, t);
  EXPECT_NEAR(cosserat_shell_density(e, zero, zero, c, n, m, ShellCoupling::standard).total(), m.thickness * 0.5 * (m.mu + m.mu_c) * 0.09, 1e-16);
  EXPECT_NEAR(cosserat_shell_density(e, zero, zero, c, n, m, ShellCoupling::birsan_2021).total(),
              m.thickness * 2 * m.mu * m.mu_c / (m.mu + m.mu_c) * 0.09, 1e-16);
}

TEST(CosseratShell, TakesStrainsThatCarryDerivatives) {
  using J = Jet<double, 2>;
  std::mt19937 generator(4);
  const Surface s(0.3, -0.9, generator);
  const Mat3<double> e = random_strain(s, generator), k = random_strain(s, generator);
  const J x = J::variable(1.0, 0), y = J::variable(1.0, 1);
  const J w = cosserat_shell_density(x * cast<J>(e), y * cast<J>(k), s.b, s.c, s.n, material(), ShellCoupling::standard).total();
  // a quadratic form: x W_x + y W_y = 2 W, and the Hessian reproduces it
  EXPECT_NEAR(w.gradient(0) + w.gradient(1), 2 * w.v, 1e-14 * w.v);
  EXPECT_NEAR(w.hessian(0, 0) + 2 * w.hessian(0, 1) + w.hessian(1, 1), 2 * w.v, 1e-14 * w.v);
}

}  // namespace
}  // namespace karcher
