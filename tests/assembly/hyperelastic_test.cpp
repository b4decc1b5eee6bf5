#include "karcher/energy/hyperelastic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/adolc_comparison.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/testing/energy_laws.hpp"
#include "karcher/testing/objectivity_checks.hpp"

namespace karcher {
namespace {

using testing::cells_of;
using testing::Dense;
using testing::MapProblem;
using Point3 = Vec3<double>;

constexpr double mu = 1.3, lambda = 0.9, kappa = lambda + 2 * mu / 3, k = 0.8, k_hat = 0.5;
// mu = 2 (a + b), lambda = 4 (b + c)
constexpr double a = 0.5, b = 0.15, c = 0.075;
const std::vector<std::string> materials{"saint-venant-kirchhoff", "neo-hooke", "mooney-rivlin", "hencky", "exp-hencky"};

/// With the nodes at position(x).
template <class F>
void deform(MapProblem& p, F position) {
  p.u.values[0].clear();
  for (int i = 0; i < p.space().node_count(); ++i) {
    const Point3 m = position(p.space().position(i));
    for (int x = 0; x < p.manifold().dim; ++x) p.u.values[0].push_back(m[x]);
  }
}
/// Moved at random by up to `amount` from m = A x, A of determinant 1.2.
void perturb(MapProblem& p, double amount) {
  karcher::Random random(3);
  deform(p, [&](const Point3& x) {
    Point3 moved{{1.2 * x[0] + 0.3 * x[1], x[1], x[2] - 0.2 * x[0]}};
    for (double& y : moved.e) y += random.uniform(-amount, amount);
    return moved;
  });
}

MapProblem solid(std::shared_ptr<const Mesh> mesh, const std::string& material, int order, bool normalised = true) {
  MapProblem p(mesh, mesh->dim == 3 ? manifold_ops<Euclidean<3>>() : manifold_ops<Euclidean<2>>(), Rule::projection, order);
  p.input.choices = {{"material", material}};
  if (material == "mooney-rivlin") {
    p.input.parameters = {{"a", a}, {"b", b}, {"c", c}};
    p.input.choices["volumetric"] = "ciarlet";
  } else {
    p.input.parameters = {{"mu", mu}, {"lambda", lambda}};
  }
  if (material == "exp-hencky") p.input.parameters.insert({{"k", k}, {"k_hat", k_hat}});
  if (material == "mooney-rivlin" || material == "exp-hencky") p.input.choices["normalised"] = normalised ? "true" : "false";
  deform(p, [](const Point3& x) { return x; });
  p.make("hyperelastic");
  return p;
}
MapProblem solid(CellKind kind, const std::string& material, int order) { return solid(cells_of(kind), material, order); }

double modulus(const Point3& x) { return 0.7 + 0.2 * x[0] - 0.1 * x[1]; }

/// The densities as docs/models.md writes them, of F by rows.
template <class S>
S formula(const std::string& material, const std::vector<S>& f, double m) {
  using density_oracle::dot_of, density_oracle::matrix_log, density_oracle::matrix_product;
  using std::exp, std::log;
  std::vector<S> transposed = f, cof(9, S(0.0));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      transposed[3 * i + j] = f[3 * j + i];
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cof[3 * i + j] = f[3 * i1 + j1] * f[3 * i2 + j2] - f[3 * i1 + j2] * f[3 * i2 + j1];
    }
  const S det = f[0] * cof[0] + f[1] * cof[1] + f[2] * cof[2], log_det = log(det);
  std::vector<S> strain = matrix_product(transposed, f, 3);
  if (material == "neo-hooke") return 0.5 * m * (dot_of(f, f) - 3.0 - 2.0 * log_det) + 0.5 * lambda * log_det * log_det;
  if (material == "mooney-rivlin")
    return a * dot_of(f, f) + b * dot_of(cof, cof) + c * det * det - (2 * a + 4 * b + 2 * c) * log_det - (3 * a + 3 * b + c);
  if (material == "saint-venant-kirchhoff") {
    for (std::size_t i = 0; i < 3; ++i) strain[4 * i] = strain[4 * i] - 1.0;
    const S trace = 0.5 * (strain[0] + strain[4] + strain[8]);
    return 0.25 * m * dot_of(strain, strain) + 0.5 * lambda * trace * trace;
  }
  const std::vector<S> log_c = matrix_log(strain, 3);
  const S deviatoric = 0.25 * dot_of(log_c, log_c) - (1.0 / 3) * log_det * log_det;
  const double bulk = lambda + 2 * m / 3;
  if (material == "hencky") return m * deviatoric + 0.5 * bulk * log_det * log_det;
  return m / k * (exp(k * deviatoric) - 1.0) + 0.5 * bulk / k_hat * (exp(k_hat * log_det * log_det) - 1.0);
}

template <int D>
void agrees(CellKind kind, int order, const std::string& material) {
  SCOPED_TRACE(material + " " + std::string(name(kind)));
  MapProblem p = solid(kind, material, order);
  p.input.quadrature_degree[kind] = 2;
  if (material != "mooney-rivlin") p.input.parameters["mu"].function = [](const Point3& x, double) { return modulus(x); };
  p.make("hyperelastic");
  perturb(p, 0.03);
  expect_small(testing::compare<density_oracle::Linear<D>, D>(p, 2, [&](const auto&, const auto& d, const Point3& x) {
    using S = std::decay_t<decltype(d[0][0])>;
    std::vector<S> f{S(1.0), S(0.0), S(0.0), S(0.0), S(1.0), S(0.0), S(0.0), S(0.0), S(1.0)};
    for (std::size_t i = 0; i < D; ++i)
      for (std::size_t j = 0; j < D; ++j) f[3 * i + j] = d[j][i];
    return formula(material, f, modulus(x));
  }));
}

TEST(Hyperelastic, AgreesWithAdolC) {
  for (const std::string& material : materials) {
    agrees<3>(CellKind::tetrahedron, 1, material);
    agrees<2>(CellKind::triangle, 2, material);
  }
  agrees<3>(CellKind::hexahedron, 1, "exp-hencky");
  agrees<3>(CellKind::tetrahedron, 2, "neo-hooke");
  agrees<2>(CellKind::quadrilateral, 1, "mooney-rivlin");
}

TEST(Hyperelastic, ObeysTheLawsOfAnEnergyOnEveryCellOfEveryOrder) {
  std::size_t next = 0;
  for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron, CellKind::triangle, CellKind::quadrilateral})
    for (const int order : {1, 2, 3}) {
      if (kind == CellKind::hexahedron && order == 3) continue;  // as the others, and slow
      const std::string material = materials[next++ % materials.size()];
      const auto dim = static_cast<std::size_t>(dimension(kind));
      MapProblem p =
          solid(testing::moved_mesh(dim == 2 ? "rectangle" : "box", {{"cells", std::vector<double>(dim, 1)}, {"size", std::vector<double>(dim, 6)}},
                                    std::string(name(kind)), 0.5, dimension(kind)),
                material, order);
      perturb(p, 0.2 / order);
      for (const std::string& broken : energy_laws(*p.functional, p.u)) ADD_FAILURE() << broken << material << name(kind) << order;
    }
}

/// Density and derivatives by the six by six (three by three) entries of F.
struct AtPoint {
  double energy;
  Jet<double, 9> jet;
};
AtPoint at(const std::string& material, const Mat3<double>& f, bool normalised = true) {
  using S = Jet<double, 9>;
  Mat3<S> h;
  for (int i = 0; i < 9; ++i) h.e[static_cast<std::size_t>(i)] = S::variable(f.e[static_cast<std::size_t>(i)], i);
  S w(0.0);
  const auto add = [&](const auto& density) { density.add_energy_of_gradient(w, h); };
  const double less = normalised ? 1 : 0;
  if (material == "saint-venant-kirchhoff") add(SaintVenantKirchhoff<double>{{}, mu, lambda});
  if (material == "neo-hooke") add(NeoHooke<double>{{}, mu, lambda});
  if (material == "mooney-rivlin") add(MooneyRivlin<double>{{}, a, b, c, less});
  if (material == "hencky") add(Hencky<double>{{}, mu, lambda});
  if (material == "exp-hencky") add(ExpHencky<double>{{}, mu, lambda, k, k_hat, less});
  return {w.v, w};
}
Mat3<double> diagonal_matrix(double x, double y, double z) { return diagonal(Point3{{x, y, z}}); }

TEST(Hyperelastic, HasTheDensitiesThatFortyDigitsGive) {
  const Mat3<double> f{{1.2, 0.3, -0.1, -0.2, 0.9, 0.25, 0.1, -0.15, 1.1}}, plane{{1.2, 0.3, 0, -0.2, 0.9, 0, 0, 0, 1}};
  const std::map<std::string, std::array<double, 2>> expected{{"saint-venant-kirchhoff", {0.18088312500000001, 0.11543499999999995}},
                                                              {"neo-hooke", {0.13151274539879793, 0.084389041368833317}},
                                                              {"hencky", {0.12013513898402948, 0.075490802177451754}},
                                                              {"exp-hencky", {3.51395939302692, 3.4683564715459644}}};
  for (const auto& [material, w] : expected) {
    EXPECT_NEAR(at(material, f, false).energy, w[0], 1e-15 * (1 + 3 * w[0])) << material;
    EXPECT_NEAR(at(material, plane, false).energy, w[1], 1e-15 * (1 + 3 * w[0])) << material;
  }
  double w = 0, in_plane = 0;
  MooneyRivlin<double>{{}, 0.7, 0.4, 0.3, 0}.add_energy_of_gradient(w, f);
  MooneyRivlin<double>{{}, 0.7, 0.4, 0.3, 0}.add_energy_of_gradient(in_plane, plane);
  EXPECT_NEAR(w, 3.8990679992588897, 1e-14);
  EXPECT_NEAR(in_plane, 3.7560182553369452, 1e-14);
}

TEST(Hyperelastic, HasTheClosedFormsOfStretchAndShear) {
  const double s = 1.4, t = 0.8, log_s = std::log(s), log_t = std::log(t), log_j = log_s + 2 * log_t;
  const Mat3<double> stretched = diagonal_matrix(t, s, t);
  const double e = 0.5 * (s * s - 1), g = 0.5 * (t * t - 1);
  const double deviatoric = 2.0 / 3 * std::pow(log_s - log_t, 2);
  EXPECT_NEAR(at("saint-venant-kirchhoff", stretched).energy, mu * (e * e + 2 * g * g) + 0.5 * lambda * std::pow(e + 2 * g, 2), 1e-15);
  EXPECT_NEAR(at("neo-hooke", stretched).energy, 0.5 * mu * (s * s + 2 * t * t - 3 - 2 * log_j) + 0.5 * lambda * log_j * log_j, 1e-15);
  EXPECT_NEAR(
      at("mooney-rivlin", stretched).energy,
      a * (s * s + 2 * t * t - 3) + b * (2 * s * s * t * t + t * t * t * t - 3) + c * (s * s * t * t * t * t - 1) - (2 * a + 4 * b + 2 * c) * log_j,
      1e-15);
  EXPECT_NEAR(at("hencky", stretched).energy, mu * deviatoric + 0.5 * kappa * log_j * log_j, 1e-15);
  EXPECT_NEAR(at("exp-hencky", stretched).energy,
              mu / k * (std::exp(k * deviatoric) - 1) + 0.5 * kappa / k_hat * (std::exp(k_hat * log_j * log_j) - 1), 1e-15);
  // Simple shear by 2 sinh(x) has the stretches exp(x), exp(-x), 1.
  const double x = 0.3;
  const Mat3<double> sheared{{1, 2 * std::sinh(x), 0, 0, 1, 0, 0, 0, 1}};
  EXPECT_NEAR(at("hencky", sheared).energy, 2 * mu * x * x, 1e-15);
  EXPECT_NEAR(at("neo-hooke", sheared).energy, 2 * mu * std::pow(std::sinh(x), 2), 1e-15);
}

TEST(Hyperelastic, IsLinearElasticityForSmallStrains) {
  // d2W = 2 mu |sym H|^2 + lambda (tr H)^2
  for (const std::string& material : materials) {
    const AtPoint rest = at(material, identity<double, 3>());
    EXPECT_EQ(rest.energy, 0) << material;
    for (int i = 0; i < 9; ++i) {
      EXPECT_LT(std::fabs(rest.jet.gradient(i)), 1e-15) << material;
      for (int j = i; j < 9; ++j) {
        const double shear = (i == j ? mu : 0) + (i % 3 == j / 3 && i / 3 == j % 3 ? mu : 0), volume = i % 4 == 0 && j % 4 == 0 ? lambda : 0;
        EXPECT_NEAR(rest.jet.hessian(i, j), shear + volume, 2e-15) << material << i << j;
      }
    }
    // Of strains of 1e-8, whose energies are 1e-16, eight digits are right.
    Mat3<double> h{{1e-8, 3e-8, 0, -1e-8, -2e-8, 1e-8, 0, 2e-8, 1e-8}};
    EXPECT_NEAR(at(material, identity<double, 3>() + h).energy / (mu * norm2(sym(h)) + 0.5 * lambda * trace(h) * trace(h)), 1, 1e-6) << material;
  }
}

TEST(Hyperelastic, SubtractsItsConstantOnlyIfItIsTold) {
  EXPECT_NEAR(at("mooney-rivlin", identity<double, 3>(), false).energy, 3 * a + 3 * b + c, 1e-15);
  EXPECT_NEAR(at("exp-hencky", identity<double, 3>(), false).energy, mu / k + 0.5 * kappa / k_hat, 1e-15);
  for (const char* material : {"mooney-rivlin", "exp-hencky"}) {
    const MapProblem plain = solid(cells_of(CellKind::tetrahedron), material, 1, false), less = solid(CellKind::tetrahedron, material, 1);
    const double volume = plain.functional->energy(plain.u).energy / at(material, identity<double, 3>(), false).energy;
    EXPECT_NEAR(volume, 1, 0.5);
    EXPECT_LT(less.functional->energy(less.u).energy, 1e-29);
  }
}

TEST(Hyperelastic, HasDerivativesWherePrincipalStretchesMeet) {
  const Mat3<double> turn = rotation_matrix(quaternion_of_rotation_vector(Point3{{0.4, -0.9, 0.3}}));
  for (const char* material : {"hencky", "exp-hencky"})
    for (const Point3& stretch : {Point3{{1, 1, 1}}, Point3{{1.4, 1.4, 1.4}}, Point3{{1.3, 0.7, 1.3}}, Point3{{0.6, 0.6, 1}}}) {
      const auto f = [&](double split) {
        return turn * diagonal_matrix(stretch[0] * (1 + split), stretch[1] * (1 - split), stretch[2]) * transpose(turn);
      };
      const AtPoint together = at(material, f(0));
      double size = 0;
      for (const double x : together.jet.h) size = std::max(size, std::fabs(x));
      // By differences of the gradient, whose order is measured at distances where rounding counts nothing.
      for (int j = 0; j < 9; ++j) {
        const double step = 1e-5;
        Mat3<double> up = f(0), down = up;
        up.e[static_cast<std::size_t>(j)] += step;
        down.e[static_cast<std::size_t>(j)] -= step;
        const AtPoint above = at(material, up), below = at(material, down);
        EXPECT_NEAR((above.energy - below.energy) / (2 * step), together.jet.gradient(j), 1e-9 * size) << material << stretch[0];
        for (int i = 0; i < 9; ++i)
          EXPECT_NEAR((above.jet.gradient(i) - below.jet.gradient(i)) / (2 * step), together.jet.hessian(i, j), 1e-8 * size)
              << material << stretch[0];
      }
      for (const double split : {1e-9, 1e-13}) {
        const AtPoint apart = at(material, f(split));
        for (int i = 0; i < 9; ++i)
          for (int j = i; j < 9; ++j)
            EXPECT_NEAR(apart.jet.hessian(i, j), together.jet.hessian(i, j), size * (10 * split + 1e-13)) << material << split;
      }
    }
}

TEST(Hyperelastic, IsTheSameAfterARigidMotion) {
  for (const std::string& material : materials) {
    MapProblem p = solid(CellKind::tetrahedron, material, 2);
    perturb(p, 0.03);
    std::vector<Point3> positions;
    for (int i = 0; i < p.space().node_count(); ++i) positions.push_back(manifold_detail::read<3>(p.u.at(0, i, 3)));
    const auto energy = [&](const std::vector<Point3>& m, const std::vector<Quaternion<double>>&) {
      Configuration moved = p.u;
      for (std::size_t i = 0; i < m.size(); ++i) std::copy(m[i].e.begin(), m[i].e.end(), moved.at(0, static_cast<int>(i), 3));
      return p.functional->energy(moved).energy;
    };
    EXPECT_LT(largest_change_by_rigid_motions(energy, positions, {}), 1e-12) << material;
  }
}

TEST(Hyperelastic, OfPlaneStrainIsTheSolidWhoseThicknessStays) {
  // One layer of hexahedra of thickness 1 on the quadrilaterals; the cells of the plane run either way round.
  auto flat = std::make_shared<Mesh>(*testing::moved_mesh("rectangle", {{"cells", {2, 1}}, {"size", {2, 1}}}, "quadrilateral"));
  for (Cell* cell : {&flat->cells[0], &flat->regions.at("all").cells[0]}) std::swap(cell->nodes[1], cell->nodes[3]);
  const auto block = testing::moved_mesh("box", {{"cells", {2, 1, 1}}, {"size", {2, 1, 1}}}, "hexahedron");
  for (const std::string& material : materials) {
    MapProblem plane = solid(flat, material, 2), space = solid(block, material, 2);
    for (MapProblem* p : {&plane, &space})
      deform(*p, [](const Point3& x) { return Point3{{1.1 * x[0] + 0.2 * x[1] * x[0], x[1] - 0.1 * x[0] * x[0] * x[1], x[2]}}; });
    EXPECT_NEAR(plane.functional->energy(plane.u).energy / space.functional->energy(space.u).energy, 1, 1e-13) << material;
  }
}

TEST(Hyperelastic, IsInfiniteWhereVolumeVanishesOrTurnsOverAndNamesTheCell) {
  for (const std::string& material : materials)
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::triangle})
      for (const double width : {0.0, -0.5}) {
        MapProblem p = solid(kind, material, 1);
        deform(p, [&](const Point3& x) { return Point3{{width * x[0], x[1], x[2]}}; });
        std::vector<double> g(p.dofs());
        BlockMatrix hessian = p.functional->make_matrix();
        for (const Evaluation& e : {p.functional->energy(p.u), p.functional->gradient(p.u, g), p.functional->hessian(p.u, g, hessian)}) {
          ASSERT_TRUE(e.failure);
          EXPECT_EQ(e.failure->trouble, Trouble::infinite_energy) << material;
          EXPECT_NE(e.failure->sentence().find("in the cell around ("), std::string::npos) << e.failure->sentence();
        }
      }
}

TEST(Hyperelastic, TellsItsStressesAndStretches) {
  MapProblem p = solid(CellKind::hexahedron, "neo-hooke", 1);
  const Mat3<double> turn = rotation_matrix(quaternion_of_rotation_vector(Point3{{0, 0, 1.2}}));
  const double s = 1.4, t = 0.8, log_j = std::log(s * t * 1.1), j = s * t * 1.1;
  deform(p, [&](const Point3& x) { return turn * Point3{{t * x[0], s * x[1], 1.1 * x[2]}}; });
  const auto q = p.functional->terms()[0]->batch_quantities(p.u, 0);
  ASSERT_EQ(q.size(), 10u);
  const auto principal = [&](double stretch) { return (mu * (stretch * stretch - 1) + lambda * log_j) / j; };
  const Mat3<double> sigma = turn * diagonal_matrix(principal(t), principal(s), principal(1.1)) * transpose(turn);
  const double expected[] = {sigma(0, 0), sigma(1, 1), sigma(2, 2), sigma(0, 1), sigma(1, 2), sigma(0, 2)};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(q[i][0], expected[i], 1e-14) << i;
  const double x = principal(t), y = principal(s), z = principal(1.1);
  EXPECT_NEAR(q[6][0], std::sqrt(0.5 * ((x - y) * (x - y) + (y - z) * (y - z) + (z - x) * (z - x))), 1e-14);
  EXPECT_NEAR(q[7][0], s, 1e-14);
  EXPECT_NEAR(q[8][0], 1.1, 1e-14);
  EXPECT_NEAR(q[9][0], t, 1e-14);
}

TEST(Hyperelastic, RefusesFieldsThatDoNotFitAndModuliWithoutALowerBound) {
  const auto refusal = [](MapProblem& p) -> std::string {
    try {
      p.make("hyperelastic");
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  };
  MapProblem sheet(cells_of(CellKind::triangle), manifold_ops<Euclidean<3>>(), Rule::projection, 1);
  sheet.input.choices = {{"material", "hencky"}};
  EXPECT_NE(refusal(sheet).find("\"u\" has values in R3, but the region \"all\" has dimension 2"), std::string::npos) << refusal(sheet);
  MapProblem soft = solid(CellKind::tetrahedron, "neo-hooke", 1);
  soft.input.parameters["lambda"] = -0.1;
  EXPECT_NE(refusal(soft).find("lambda is -0.1; it (and Poisson's ratio) must be at least 0 for the material \"neo-hooke\""), std::string::npos);
  soft.input.choices["material"] = "hencky";
  EXPECT_EQ(refusal(soft), "none");
  soft.input.parameters["lambda"] = -2 * mu / 3;
  EXPECT_NE(refusal(soft).find("must be greater than -2/3 mu"), std::string::npos);
  MapProblem curved = solid(CellKind::triangle, "hencky", 1);
  curved.input.reference_position = [](const Point3& x) { return Point3{{x[0], x[1], 0.1 * x[0]}}; };
  EXPECT_NE(refusal(curved).find("hyperelastic in plane strain: the stress-free configuration must lie in the plane z = 0"), std::string::npos);
}

}  // namespace
}  // namespace karcher
