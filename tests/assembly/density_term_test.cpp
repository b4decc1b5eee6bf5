// The generic kernel against ADOL-C on the same elements, and the laws that hold for every density.
#include "karcher/assembly/density_term.hpp"

#include <gtest/gtest.h>

#include "assembly/adolc_comparison.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/manifold/unitary.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using namespace density_oracle;
using testing::cells_of;
using testing::compare;
using testing::Dense;
using testing::expect_small;
using testing::MapProblem;
using testing::moved_mesh;

/// Parameters as expressions of the place, the same on both sides.
double modulus(const Vec3<double>& x) { return 0.7 + 0.2 * x[0] - 0.1 * x[1]; }

template <class M, class G, int D>
void harmonic_agrees(CellKind kind, int order, Rule rule, double spread, double tolerance = 1e-10, int degree = 3) {
  MapProblem p(cells_of(kind), manifold_ops<M>(), rule, order);
  const auto origin = M::origin();
  p.set_random({origin.e.begin(), origin.e.end()}, spread);
  p.input.quadrature_degree[kind] = degree;
  p.input.parameters["scale"].function = [](const Vec3<double>& x, double) { return modulus(x); };
  p.make("harmonic");
  SCOPED_TRACE(std::string(M::name) + " " + std::string(name(kind)) + " " + std::to_string(order));
  const auto density = [](const auto& u, const auto& d, const Vec3<double>& x) {
    auto sum = G::square(u, d[0]);
    for (std::size_t a = 1; a < D; ++a) sum = sum + G::square(u, d[a]);
    return sum * (0.5 * modulus(x));
  };
  expect_small(compare<G, D>(p, degree, density), tolerance);
}

}  // namespace

TEST(HarmonicTerm, AgreesWithAdolCOnEveryCellOfEveryOrderOnTheSphere) {
  using G = UnitVectors<3>;
  for (int order : {1, 2, 3}) {
    harmonic_agrees<Sphere<2>, G, 1>(CellKind::line, order, Rule::geodesic, 0.5);
    harmonic_agrees<Sphere<2>, G, 2>(CellKind::triangle, order, order == 2 ? Rule::geodesic : Rule::projection, 0.4);
    harmonic_agrees<Sphere<2>, G, 2>(CellKind::quadrilateral, order, order == 2 ? Rule::projection : Rule::geodesic, 0.4);
  }
  harmonic_agrees<Sphere<2>, G, 3>(CellKind::tetrahedron, 1, Rule::geodesic, 0.4);
  harmonic_agrees<Sphere<2>, G, 3>(CellKind::tetrahedron, 3, Rule::projection, 0.3, 1e-10, 2);
  harmonic_agrees<Sphere<2>, G, 3>(CellKind::hexahedron, 1, Rule::projection, 0.4);
  harmonic_agrees<Sphere<2>, G, 3>(CellKind::hexahedron, 2, Rule::geodesic, 0.3, 1e-10, 2);
}

TEST(HarmonicTerm, AgreesWithAdolCForRotations) {
  harmonic_agrees<Rotation, Rotations, 1>(CellKind::line, 3, Rule::projection, 0.4);
  harmonic_agrees<Rotation, Rotations, 2>(CellKind::triangle, 2, Rule::projection, 0.4);
  harmonic_agrees<Rotation, Rotations, 2>(CellKind::triangle, 2, Rule::geodesic, 0.4);
  harmonic_agrees<Rotation, Rotations, 2>(CellKind::quadrilateral, 1, Rule::geodesic, 0.5);
  harmonic_agrees<Rotation, Rotations, 3>(CellKind::tetrahedron, 1, Rule::projection, 0.4);
  harmonic_agrees<Rotation, Rotations, 3>(CellKind::hexahedron, 1, Rule::geodesic, 0.4, 1e-10, 1);
}

TEST(HarmonicTerm, AgreesWithAdolCInTheOtherManifolds) {
  harmonic_agrees<Euclidean<3>, Linear<3>, 2>(CellKind::triangle, 3, Rule::projection, 1.0);
  harmonic_agrees<Sphere<1>, UnitVectors<2>, 2>(CellKind::quadrilateral, 2, Rule::geodesic, 0.4);
  harmonic_agrees<Sphere<3>, UnitVectors<4>, 2>(CellKind::triangle, 2, Rule::geodesic, 0.4);
  harmonic_agrees<Unitary, UnitVectors<4>, 2>(CellKind::triangle, 2, Rule::projection, 0.4);
  harmonic_agrees<Hyperbolic<2>, Hyperboloid<2>, 2>(CellKind::triangle, 2, Rule::geodesic, 0.4);
  harmonic_agrees<Hyperbolic<3>, Hyperboloid<3>, 3>(CellKind::tetrahedron, 1, Rule::geodesic, 0.4);
  harmonic_agrees<Spd<2>, PositiveMatrices<2>, 2>(CellKind::triangle, 2, Rule::geodesic, 0.2, 1e-10, 2);
  harmonic_agrees<Spd<3>, PositiveMatrices<3>, 2>(CellKind::triangle, 1, Rule::geodesic, 0.2, 1e-10, 1);
}

TEST(ChiralSkyrmionTerm, AgreesWithAdolC) {
  for (Rule rule : {Rule::projection, Rule::geodesic})
    for (CellKind kind : {CellKind::triangle, CellKind::quadrilateral}) {
      MapProblem p(cells_of(kind), manifold_ops<Sphere<2>>(), rule, 2);
      p.set_random({0, 0, 1}, 0.4);
      p.input.quadrature_degree[kind] = 3;
      p.input.parameters["kappa"].function = [](const Vec3<double>& x, double) { return modulus(x); };
      p.input.parameters["h"] = 3.0;
      p.make("chiral-skyrmion");
      const auto density = [](const auto& u, const auto& d, const Vec3<double>& x) {
        // curl of a map that does not depend on the third coordinate
        return 0.5 * (dot_of(d[0], d[0]) + dot_of(d[1], d[1])) + modulus(x) * (u[0] * d[1][2] - u[1] * d[0][2] + u[2] * d[0][1] - u[2] * d[1][0]) +
               1.5 * (u[0] * u[0] + u[1] * u[1] + (u[2] - 1.0) * (u[2] - 1.0));
      };
      expect_small(compare<UnitVectors<3>, 2>(p, 3, density));
    }
}

TEST(FrankOseenTerm, AgreesWithAdolCInThePlaneAndInSpace) {
  const auto check = [&]<int D>(CellKind kind, int order, Rule rule) {
    MapProblem p(cells_of(kind), manifold_ops<Sphere<2>>(), rule, order);
    p.set_random({0, 0, 1}, 0.4);
    p.input.quadrature_degree[kind] = 2;
    p.input.parameters = {{"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.8}, {"H[0]", 0.3}, {"H[1]", -1.1}, {"H[2]", 0.6}};
    p.input.parameters["K2"].function = [](const Vec3<double>& x, double) { return modulus(x); };
    p.make("frank-oseen");
    const auto density = [](const auto& u, const auto& d, const Vec3<double>& x) {
      using S = std::decay_t<decltype(u[0])>;
      // curl_i = eps_ijk d_j u_k
      std::vector<S> curl(3, S(0.0));
      S divergence = S(0.0);
      for (std::size_t j = 0; j < D; ++j) {
        divergence = divergence + d[j][j];
        curl[(j + 2) % 3] = curl[(j + 2) % 3] + d[j][(j + 1) % 3];
        curl[(j + 1) % 3] = curl[(j + 1) % 3] - d[j][(j + 2) % 3];
      }
      const S twist = dot_of(u, curl), bend2 = dot_of(u, u) * dot_of(curl, curl) - twist * twist;  // Lagrange's identity
      const S along = u[0] * 0.3 - u[1] * 1.1 + u[2] * 0.6;
      return 0.6 * divergence * divergence + (0.5 * modulus(x)) * twist * twist + 0.95 * bend2 - 0.4 * along * along;
    };
    expect_small(compare<UnitVectors<3>, D>(p, 2, density));
  };
  check.template operator()<2>(CellKind::triangle, 3, Rule::projection);
  check.template operator()<2>(CellKind::quadrilateral, 1, Rule::geodesic);
  check.template operator()<3>(CellKind::tetrahedron, 2, Rule::projection);
  check.template operator()<3>(CellKind::hexahedron, 1, Rule::geodesic);
}

namespace {

template <class M, class G>
void distance_agrees(CellKind kind, int order, Rule rule, double spread) {
  MapProblem p(cells_of(kind), manifold_ops<M>(), rule, order);
  const auto origin = M::origin();
  p.set_random({origin.e.begin(), origin.e.end()}, spread);
  p.input.quadrature_degree[kind] = 2;
  p.input.parameters["weight"].function = [](const Vec3<double>& x, double) { return modulus(x); };
  const auto target = retract<M>(M::origin(), 0.1 * Vec<double, M::dim>{{1.0}});
  for (int c = 0; c < M::ambient; ++c) p.input.parameters["target[" + std::to_string(c) + "]"] = target[c];
  p.make("l2-distance");
  const auto density = [&](const auto& u, const auto&, const Vec3<double>& x) {
    using S = std::decay_t<decltype(u[0])>;
    return G::distance2(u, G::value(lifted<S>({target.e.begin(), target.e.end()}))) * (0.5 * modulus(x));
  };
  SCOPED_TRACE(M::name);
  expect_small(compare<G, 0>(p, 2, density));
}

}  // namespace

TEST(L2DistanceTerm, AgreesWithAdolC) {
  distance_agrees<Sphere<2>, UnitVectors<3>>(CellKind::triangle, 2, Rule::geodesic, 0.4);
  distance_agrees<Sphere<2>, UnitVectors<3>>(CellKind::hexahedron, 1, Rule::projection, 0.4);
  distance_agrees<Rotation, Rotations>(CellKind::line, 2, Rule::geodesic, 0.4);
  distance_agrees<Rotation, Rotations>(CellKind::quadrilateral, 1, Rule::projection, 0.4);
  distance_agrees<Hyperbolic<2>, Hyperboloid<2>>(CellKind::triangle, 1, Rule::geodesic, 0.4);
  distance_agrees<Spd<2>, PositiveMatrices<2>>(CellKind::triangle, 1, Rule::geodesic, 0.1);
  distance_agrees<Euclidean<2>, Linear<2>>(CellKind::tetrahedron, 2, Rule::projection, 1.0);
}

TEST(DeadLoadTerm, AgreesWithAdolCInTheVolumeAndOnABoundary) {
  for (const bool boundary : {false, true}) {
    MapProblem p(cells_of(CellKind::quadrilateral), manifold_ops<Sphere<2>>(), Rule::geodesic, 2, boundary ? "boundary" : "all");
    p.set_random({0, 0, 1}, 0.4);
    p.input.quadrature_degree[boundary ? CellKind::line : CellKind::quadrilateral] = 3;
    p.input.parameters = {{"value[0]", 0.4}, {"value[1]", 0.0}, {"value[2]", -1.3}};
    p.input.parameters["value[1]"].function = [](const Vec3<double>& x, double) { return modulus(x); };
    p.make(boundary ? "traction-load" : "volume-load");
    const auto density = [](const auto& u, const auto&, const Vec3<double>& x) { return -0.4 * u[0] - modulus(x) * u[1] + 1.3 * u[2]; };
    expect_small(compare<UnitVectors<3>, 0>(p, 3, density));
  }
}

namespace {

template <class M>
MapProblem harmonic_problem(std::shared_ptr<const Mesh> mesh, Rule rule, int order, double spread) {
  MapProblem p(std::move(mesh), manifold_ops<M>(), rule, order);
  const auto origin = M::origin();
  p.set_random({origin.e.begin(), origin.e.end()}, spread);
  p.input.parameters["scale"] = 1.0;
  p.make("harmonic");
  return p;
}

template <class M>
void expect_taylor_slopes(Rule rule) {
  const MapProblem p = harmonic_problem<M>(cells_of(CellKind::triangle), rule, 2, 0.3);
  const TaylorSlopes s = taylor_slopes(*p.functional, p.u);
  EXPECT_TRUE(s.hessian_holds()) << M::name << ": " << s.sentence();
}

}  // namespace

TEST(DeadLoadTerm, FollowsTheLoadParameterWhereItIsAFunctionOfIt) {
  MapProblem p(moved_mesh("rectangle", {{"cells", {3, 3}}}, "triangle"), manifold_ops<Euclidean<2>>(), Rule::projection, 1);
  p.u.values[0].assign(static_cast<std::size_t>(2 * p.space().node_count()), 1.0);
  p.input.parameters["value[0]"] = 0.25;
  ParameterValue& growing = p.input.parameters["value[1]"];
  growing.function = [](const Vec3<double>& x, double t) { return x[0] + t; };
  growing.depends_on_t = true;
  p.input.t = 1;
  p.make("volume-load");
  EXPECT_NEAR(p.functional->energy(p.u).energy, -1.75, 1e-13);
  p.functional->set_load_parameter(3);
  EXPECT_NEAR(p.functional->energy(p.u).energy, -3.75, 1e-13);
  p.functional->set_load_parameter(1);
  EXPECT_NEAR(p.functional->energy(p.u).energy, -1.75, 1e-13);
}

TEST(DensityTerm, DerivativesPassTheTaylorTestThroughTheRetraction) {
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    expect_taylor_slopes<Sphere<1>>(rule);
    expect_taylor_slopes<Sphere<2>>(rule);
    expect_taylor_slopes<Sphere<3>>(rule);
    expect_taylor_slopes<Rotation>(rule);
    expect_taylor_slopes<Unitary>(rule);
  }
  expect_taylor_slopes<Spd<2>>(Rule::geodesic);
  expect_taylor_slopes<Spd<3>>(Rule::geodesic);
  expect_taylor_slopes<Hyperbolic<2>>(Rule::geodesic);
  expect_taylor_slopes<Hyperbolic<3>>(Rule::geodesic);
}

TEST(DensityTerm, DiagonalBlocksOfTheHessianAreSymmetric) {
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    const Dense k(harmonic_problem<Rotation>(cells_of(CellKind::quadrilateral), rule, 2, 0.4));
    double largest = 0, skewness = 0;
    for (std::size_t r = 0; r < k.gradient.size(); ++r)
      for (std::size_t c = 0; c < k.gradient.size(); ++c) {
        largest = std::max(largest, std::fabs(k.hessian[r][c]));
        skewness = std::max(skewness, std::fabs(k.hessian[r][c] - k.hessian[c][r]));
      }
    EXPECT_LT(skewness, 1e-13 * largest);
  }
}

TEST(DensityTerm, EnergyAndGradientAreTheSameWhateverElseIsWanted) {
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    const MapProblem p = harmonic_problem<Sphere<2>>(cells_of(CellKind::triangle), rule, 2, 0.4);
    const Dense k(p);
    std::vector<double> g(p.dofs());
    EXPECT_NEAR(p.functional->gradient(p.u, g).energy, k.evaluation.energy, 1e-14 * k.evaluation.energy);
    EXPECT_NEAR(p.functional->energy(p.u).energy, k.evaluation.energy, 1e-14 * k.evaluation.energy);
    for (std::size_t i = 0; i < g.size(); ++i) EXPECT_NEAR(g[i], k.gradient[i], 1e-13);
  }
}

namespace {

/// |E(isometry(u)) - E(u)| / E(u)
template <class M, class Isometry>
double change_by(Rule rule, const Isometry& isometry) {
  const MapProblem p = harmonic_problem<M>(cells_of(CellKind::quadrilateral), rule, 2, 0.4);
  Configuration moved = p.u;
  for (int i = 0; i < p.space().node_count(); ++i) {
    double* x = moved.at(0, i, M::ambient);
    manifold_detail::write(isometry(manifold_detail::read<M::ambient>(x)).e, x);
  }
  const double before = p.functional->energy(p.u).energy;
  return std::fabs(p.functional->energy(moved).energy / before - 1);
}

}  // namespace

TEST(HarmonicTerm, IsInvariantUnderIsometriesOfTheTarget) {
  const Quaternion<double> a = Rotation::from_rotation_vector(Vec3<double>{{1.2, -0.7, 0.4}});
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    EXPECT_LT(change_by<Sphere<2>>(rule, [&](const auto& p) { return Rotation::to_matrix(a) * p; }), 1e-13);
    EXPECT_LT(change_by<Rotation>(rule, [&](const auto& p) { return Rotation::product(a, p); }), 1e-13);
    EXPECT_LT(change_by<Rotation>(rule, [&](const auto& p) { return Rotation::product(p, a); }), 1e-13);
    EXPECT_LT(change_by<Rotation>(rule, [&](const auto& p) { return p[1] > 0 ? -p : p; }), 1e-13);  // another quaternion of the same rotation
  }
  Mat3<double> g = Rotation::to_matrix(a);
  g(0, 1) += 0.8, g(2, 2) += 0.9;
  EXPECT_LT(change_by<Spd<3>>(Rule::geodesic, [&](const auto& p) { return Spd<3>::point(sym(g * Spd<3>::matrix(p) * transpose(g))); }), 1e-12);
  EXPECT_LT(change_by<Spd<3>>(Rule::geodesic, [&](const auto& p) { return Spd<3>::point(inverse(Spd<3>::matrix(p))); }), 1e-12);
  EXPECT_LT(change_by<Hyperbolic<2>>(Rule::geodesic,
                                     [&](const auto& p) {
                                       const double c = std::cosh(0.8), s = std::sinh(0.8);
                                       return Point<Hyperbolic<2>>{{c * p[0] + s * p[1], s * p[0] + c * p[1], -p[2]}};
                                     }),
            1e-12);
}

TEST(FrankOseenTerm, IsInvariantUnderRotationsOfTheDomainWithTheTarget) {
  const Mat3<double> a = Rotation::to_matrix(Rotation::from_rotation_vector(Vec3<double>{{0.3, -0.7, 1.4}}));
  const auto energy = [&](bool turned) {
    auto mesh = std::make_shared<Mesh>(*cells_of(CellKind::hexahedron));
    if (turned)
      for (auto& x : mesh->nodes) x = a * x;
    mesh->regions["all"].cells = mesh->cells;
    MapProblem p(mesh, manifold_ops<Sphere<2>>(), Rule::projection, 1);
    p.set_random({0, 0, 1}, 0.5);
    Vec3<double> h{{0.3, -1.1, 0.6}};
    if (turned) {
      h = a * h;
      for (int i = 0; i < p.space().node_count(); ++i) {
        double* x = p.u.at(0, i, 3);
        manifold_detail::write((a * manifold_detail::read<3>(x)).e, x);
      }
    }
    p.input.parameters = {{"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.8}, {"H[0]", h[0]}, {"H[1]", h[1]}, {"H[2]", h[2]}};
    p.make("frank-oseen");
    return p.functional->energy(p.u).energy;
  };
  const double before = energy(false);
  EXPECT_NEAR(energy(true), before, 1e-13 * std::fabs(before));
}

TEST(DensityTerm, PartsSumToTheEnergy) {
  const auto check = [](MapProblem& p, const std::string& type, std::size_t count) {
    p.set_random({0, 0, 1}, 0.5);
    p.make(type);
    const auto parts = p.functional->terms().front()->part_energies(p.u);
    ASSERT_EQ(parts.size(), count);
    double sum = 0, size = 0;
    for (double x : parts) {
      sum += x;
      size += std::fabs(x);
      EXPECT_NE(x, 0.0);
    }
    EXPECT_NEAR(sum, p.functional->energy(p.u).energy, 1e-14 * size) << type;
  };
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    MapProblem skyrmion(cells_of(CellKind::triangle), manifold_ops<Sphere<2>>(), rule, 2);
    skyrmion.input.parameters = {{"kappa", 1.0}, {"h", 3.0}};
    check(skyrmion, "chiral-skyrmion", 3);
    MapProblem crystal(cells_of(CellKind::tetrahedron), manifold_ops<Sphere<2>>(), rule, 2);
    crystal.input.parameters = {{"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.8}, {"H[0]", 0.3}, {"H[1]", -1.1}, {"H[2]", 0.6}};
    check(crystal, "frank-oseen", 4);
  }
}

TEST(FrankOseenTerm, OfATwistedCellIsTheClosedForm) {
  // n = (cos kz, sin kz, 0): geodesic interpolation of order 1 is exact, the energy is K2 k^2/2 per volume, all of it twist.
  MapProblem p(moved_mesh("box", {{"cells", {2, 2, 3}}, {"size", {1, 2, 1.5}}}, "hexahedron"), manifold_ops<Sphere<2>>(), Rule::geodesic, 1);
  const double k = 0.9;
  for (int i = 0; i < p.space().node_count(); ++i) {
    const double z = p.space().position(i)[2];
    for (double x : {std::cos(k * z), std::sin(k * z), 0.0}) p.u.values[0].push_back(x);
  }
  p.input.parameters = {{"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.0}, {"H[0]", 0.0}, {"H[1]", 0.0}, {"H[2]", 0.0}};
  p.make("frank-oseen");
  const auto parts = p.functional->terms().front()->part_energies(p.u);
  EXPECT_NEAR(parts[0], 0, 1e-14);
  EXPECT_NEAR(parts[1], 0.5 * 0.7 * k * k * 3.0, 1e-13);
  EXPECT_NEAR(parts[2], 0, 1e-14);
}

namespace {

/// Energy and gradient of one cell: all lanes hold it.
template <class M>
std::pair<double, std::vector<double>> alone(const MapProblem& p, std::size_t cell) {
  TermInput input = p.input;
  input.region.cells = {p.input.region.cells[cell]};
  const auto term = make_term("harmonic", input);
  BatchResult out;
  const std::size_t n = term->batch(0).blocks->size() * M::dim;
  out.gradient.resize(n * native_width);
  term->evaluate(p.u, 0, Want::gradient, out);
  std::vector<double> g;
  for (std::size_t i = 0; i < n; ++i) g.push_back(out.gradient[i * native_width]);
  return {out.energy[0], g};
}

template <class M>
void lanes_do_not_see_each_other(Rule rule) {
  MapProblem p(moved_mesh("rectangle", {{"cells", {3, 3}}}, "triangle", 0.05, 2), manifold_ops<M>(), rule, 2);
  const auto origin = M::origin();
  p.set_random({origin.e.begin(), origin.e.end()}, 0.4);
  p.input.parameters["scale"] = 1.0;
  const auto term = make_term("harmonic", p.input);
  BatchResult out;
  const std::size_t n = term->batch(0).blocks->size() * M::dim;
  out.gradient.resize(n * native_width);
  std::size_t seen = 0;
  for (int b = 0; b < term->batch_count(); ++b) {
    term->evaluate(p.u, b, Want::gradient, out);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(term->batch(b).cells_used); ++lane, ++seen) {
      const auto [energy, gradient] = alone<M>(p, static_cast<std::size_t>(term->batch(b).cells[lane]));
      EXPECT_NEAR(out.energy[lane], energy, 1e-14 * energy);
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(out.gradient[i * native_width + lane], gradient[i], 1e-12);
    }
  }
  EXPECT_EQ(seen, 18u);
}

}  // namespace

TEST(DensityTerm, LanesDoNotSeeEachOther) {
  lanes_do_not_see_each_other<Sphere<2>>(Rule::projection);
  lanes_do_not_see_each_other<Rotation>(Rule::projection);
  lanes_do_not_see_each_other<Rotation>(Rule::geodesic);
  lanes_do_not_see_each_other<Spd<3>>(Rule::geodesic);
}

namespace {

/// A row of cells of which one has values that no interpolation connects: the two ends of its left edge are opposite to those of its right edge.
template <class M>
void undefined_cell_is_reported(Rule rule, const Point<M>& here, const Point<M>& there) {
  constexpr int cells = native_width + 3, bad = 2;
  MapProblem p(moved_mesh("rectangle", {{"cells", {cells, 1}}, {"size", {cells, 1.0}}}, "quadrilateral"), manifold_ops<M>(), rule, 1);
  for (int i = 0; i < p.space().node_count(); ++i)
    for (double x : (p.space().position(i)[0] < bad + 0.5 ? here : there).e) p.u.values[0].push_back(x);
  p.input.parameters["scale"] = 1.0;
  p.make("harmonic");
  const Term& term = *p.functional->terms().front();
  BatchResult out;
  int undefined = 0;
  for (int b = 0; b < term.batch_count(); ++b) {
    for (const Want want : {Want::energy, Want::gradient, Want::hessian}) {
      const std::size_t n = 4 * M::dim;
      out.gradient.resize(n * native_width);
      out.hessian.resize(n * n * native_width);
      term.evaluate(p.u, b, want, out);
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(term.batch(b).cells_used); ++lane) {
        const Cell& cell = term.cell(term.batch(b).cells[lane]);
        double centre = 0;
        for (int v : cell.nodes) centre += 0.25 * p.input.mesh->nodes[static_cast<std::size_t>(v)][0];
        if (std::fabs(centre - bad - 0.5) < 1e-9) {
          EXPECT_EQ(out.trouble[lane], Trouble::undefined_interpolation) << M::name;
          ++undefined;
        } else {
          EXPECT_EQ(out.trouble[lane], Trouble::none) << M::name;
          EXPECT_NEAR(out.energy[lane], 0, 1e-26) << M::name;
        }
      }
    }
  }
  EXPECT_EQ(undefined, 3);
  const Evaluation e = p.functional->energy(p.u);
  ASSERT_TRUE(e.failure);
  EXPECT_EQ(e.failure->trouble, Trouble::undefined_interpolation);
  EXPECT_EQ(e.failure->term, "harmonic");
  EXPECT_NEAR(e.failure->place[0], bad + 0.5, 1e-12);
  EXPECT_NEAR(e.failure->place[1], 0.5, 1e-12);
  EXPECT_EQ(e.energy, std::numeric_limits<double>::infinity());
}

}  // namespace

TEST(DensityTerm, ReportsTheCellWhoseValuesAreOppositeAndKeepsTheOthers) {
  // The mean of the four values is as far from both pairs: exact antipodes, then beyond the radius of a unique mean.
  undefined_cell_is_reported<Sphere<1>>(Rule::geodesic, {{1, 0}}, {{-1, 0}});
  undefined_cell_is_reported<Sphere<2>>(Rule::geodesic, {{1, 0, 0}}, {{-1, 0, 0}});
  undefined_cell_is_reported<Sphere<3>>(Rule::geodesic, {{1, 0, 0, 0}}, {{-1, 0, 0, 0}});
  undefined_cell_is_reported<Rotation>(Rule::geodesic, {{1, 0, 0, 0}}, {{0, 0, 1, 0}});
  undefined_cell_is_reported<Unitary>(Rule::geodesic, {{1, 0, 0, 0}}, {{-1, 0, 0, 0}});
  // The projection is undefined at points only; Gauss points of odd rules meet the middle.
  undefined_cell_is_reported<Rotation>(Rule::projection, {{1, 0, 0, 0}}, {{0, 0, 1, 0}});
}

}  // namespace karcher
