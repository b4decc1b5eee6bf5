// What a density sees of the surface at its point, and the densities that ask for it.
#include "karcher/energy/reference_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assembly/large_stack.hpp"
#include "assembly/map_problem.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/testing/energy_laws.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using testing::MapProblem;
using testing::moved_mesh;
using Point3 = Vec3<double>;

/// The rotation that takes (e1, e2, e3) to (ek, ek+1, ek+2), or a general one for k = 3.
Point3 turned(int k, const Point3& x) {
  if (k < 3) return {{x[(3 - k) % 3], x[(4 - k) % 3], x[(5 - k) % 3]}};
  return rotation_matrix(quaternion_of_rotation_vector(Point3{{0.9, -0.4, 1.3}})) * x;
}

/// A director pattern on the unit square, with its plane turned in space.
double energy_in_plane(int k, const std::string& type, const ParameterValues& parameters) {
  auto mesh = std::make_shared<Mesh>(*moved_mesh("rectangle", {{"cells", {4, 4}}}, "triangle", 0.02, 2));
  const std::vector<Point3> flat = mesh->nodes;
  for (auto& x : mesh->nodes) x = turned(k, x);
  MapProblem p(mesh, manifold_ops<Sphere<2>>(), Rule::projection, 2);
  MapProblem at_flat(moved_mesh("rectangle", {{"cells", {4, 4}}}, "triangle", 0.02, 2), manifold_ops<Sphere<2>>(), Rule::projection, 2);
  for (int i = 0; i < p.space().node_count(); ++i) {
    const Point3 x = at_flat.space().position(i);
    const Point3 n = turned(k, Point3{{std::cos(x[1]) * std::cos(0.4 * x[0]), std::sin(x[1]) * std::cos(0.4 * x[0]), std::sin(0.4 * x[0])}});
    for (const double c : n.e) p.u.values[0].push_back(c);
  }
  p.input.parameters = parameters;
  p.make(type);
  return p.functional->energy(p.u).energy;
}

TEST(FrankOseen, HasTheSameEnergyInEveryPlaneOfSpace) {
  const ParameterValues parameters{{"K1", 1.0}, {"K2", 0.5}, {"K3", 1.5}, {"chi", 0.0}, {"H[0]", 0.0}, {"H[1]", 0.0}, {"H[2]", 0.0}};
  const double expected = energy_in_plane(0, "frank-oseen", parameters);
  EXPECT_GT(expected, 0.3);
  for (const int k : {1, 2, 3}) EXPECT_NEAR(energy_in_plane(k, "frank-oseen", parameters), expected, 1e-13) << k;
}

TEST(ChiralSkyrmion, HasTheSameEnergyInEveryPlaneOfSpace) {
  const ParameterValues parameters{{"kappa", 0.8}, {"h", 0.0}};
  const double expected = energy_in_plane(0, "chiral-skyrmion", parameters);
  for (const int k : {1, 2, 3}) EXPECT_NEAR(energy_in_plane(k, "chiral-skyrmion", parameters), expected, 1e-13) << k;
}

/// The meridional plane pattern of the issue: n = (cos y, sin y, 0), energy 1/2 int K1 cos^2 y + K3 sin^2 y.
TEST(FrankOseen, OfAPlanePatternIsItsClosedForm) {
  for (const int k : {0, 1, 2}) {
    auto mesh = std::make_shared<Mesh>(*moved_mesh("rectangle", {{"cells", {6, 6}}}, "quadrilateral"));
    for (auto& x : mesh->nodes) x = turned(k, x);
    MapProblem p(mesh, manifold_ops<Sphere<2>>(), Rule::geodesic, 3);
    for (int i = 0; i < p.space().node_count(); ++i) {
      const double y = p.space().position(i)[(k + 1) % 3];
      for (const double c : turned(k, Point3{{std::cos(y), std::sin(y), 0}}).e) p.u.values[0].push_back(c);
    }
    p.input.parameters = {{"K1", 1.0}, {"K2", 0.5}, {"K3", 1.5}, {"chi", 0.0}, {"H[0]", 0.0}, {"H[1]", 0.0}, {"H[2]", 0.0}};
    p.make("frank-oseen");
    EXPECT_NEAR(p.functional->energy(p.u).energy, 0.5 * (1.0 * (0.5 + std::sin(2.0) / 4) + 1.5 * (0.5 - std::sin(2.0) / 4)), 1e-9) << k;
  }
}

/// The normal of a hemisphere of radius r splays with div n = 2/r and does not curl; the tangents e_phi of a band have div = 0 and |curl| = 1/(r sin theta).
TEST(FrankOseen, OnAHemisphereIsThatOfTheSurfaceGradient) {
  const double r = 1.7;
  auto sphere = std::make_shared<Mesh>(generate({"sphere", {{"cells", {12}}, {"order", {3}}, {"radius", {r}}}, {}}));
  sphere->regions["upper"] = select(*sphere, "upper", 2, false, [](const Point3& x) { return x[2] > -1e-12; });
  sphere->regions["band"] = select(*sphere, "band", 2, false, [&](const Point3& x) { return std::fabs(x[2]) < 0.8 * r; });
  const auto energy_of = [&](const std::string& region, const auto& director) {
    MapProblem p(sphere, manifold_ops<Sphere<2>>(), Rule::geodesic, 3, region);
    for (int i = 0; i < p.space().node_count(); ++i)
      for (const double c : Sphere<2>::project(director(p.space().position(i))).e) p.u.values[0].push_back(c);
    p.input.parameters = {{"K1", 1.1}, {"K2", 0.5}, {"K3", 1.5}, {"chi", 0.0}, {"H[0]", 0.0}, {"H[1]", 0.0}, {"H[2]", 0.0}};
    p.make("frank-oseen");
    const auto parts = p.functional->terms().front()->part_energies(p.u);
    double area = 0, inverse_square = 0;  // int 1 / sin^2 theta
    const ReferenceGeometry geometry(*sphere, {}, 1);
    for (const Cell& cell : p.input.region.cells) {
      const Quadrature& rule = quadrature(cell.kind, 8);
      const auto jets = geometry.at(cell, rule.points);
      for (std::size_t q = 0; q < jets.size(); ++q) {
        const double w = rule.weights[q] * cell_frame(jets[q], 2).measure;
        area += w;
        inverse_square += w * norm2(jets[q].x) / (norm2(jets[q].x) - jets[q].x[2] * jets[q].x[2]);
      }
    }
    return std::tuple(parts, area, inverse_square);
  };
  const auto [normal, area, unused] = energy_of("upper", [](const Point3& x) { return x; });
  EXPECT_NEAR(normal[0], 0.5 * 1.1 * 4 / (r * r) * area, 1e-4 * normal[0]);
  EXPECT_NEAR(normal[1], 0, 1e-6);
  EXPECT_NEAR(normal[2], 0, 1e-6);
  const auto [around, band, inverse_square] = energy_of("band", [](const Point3& x) { return Point3{{-x[1], x[0], 0}}; });
  EXPECT_GT(band, 0);
  EXPECT_NEAR(around[0], 0, 1e-5);
  EXPECT_NEAR(around[1], 0, 1e-5);
  EXPECT_NEAR(around[2], 0.5 * 1.5 / (r * r) * inverse_square, 1e-4 * around[2]);
}

/// Records what it is shown.
struct Spy {
  template <class S, class Jet>
  auto parts(const S& s, const Jet& u) const {
    const auto zero = u.value[0] * 0.0;
    const auto number = [&](const auto& x) { return zero + x; };
    // |x|^2, trace and determinant of b, n . x, and what must be 0: t_a . n, t_1 . t_2, t_a . t_a - 1
    const auto& t = s.tangent;
    const auto wrong = dot(t[0], s.normal) * dot(t[0], s.normal) + dot(t[1], s.normal) * dot(t[1], s.normal) + dot(t[0], t[1]) * dot(t[0], t[1]) +
                       (norm2(t[0]) - 1.0) * (norm2(t[0]) - 1.0) + (norm2(t[1]) - 1.0) * (norm2(t[1]) - 1.0) +
                       (norm2(s.normal) - 1.0) * (norm2(s.normal) - 1.0);
    return std::array{
        number(norm2(s.x)), number(trace(s.b)), number(determinant(s.b)), number(dot(s.normal, s.x)), number(wrong), number(s.oriented ? 1.0 : 0.0),
        number(1.0)};
  }
};

/// Means over the region of what Spy records.
std::vector<double> means(const MapProblem& p, double* measure = nullptr) {
  const TermInfo info{"spy", {"x", "trace", "determinant", "side", "wrong", "oriented", "one"}, {}, false, {}};
  const auto term = with_rule<Euclidean<1>, 2>(p.input.field(0), [&]<class I>() -> std::unique_ptr<Term> {
    return std::make_unique<DensityTerm<FixedDensity<Spy>, 2, I>>(info, p.input, FixedDensity<Spy>{}, std::vector<std::string>{});
  });
  std::vector<double> sums = term->part_energies(p.u);
  const double area = sums.back();
  if (measure) *measure = area;
  for (double& s : sums) s /= area;
  return sums;
}

MapProblem on(std::shared_ptr<const Mesh> mesh, const std::string& region = "all") {
  MapProblem p(std::move(mesh), manifold_ops<Euclidean<1>>(), Rule::projection, 1, region);
  p.u.values[0].assign(static_cast<std::size_t>(p.space().node_count()), 0.0);
  return p;
}

TEST(ReferencePoint, OfASphereHasItsCurvaturesAndANormalOnOneSideWhateverTheCellsSay) {
  const double r = 2.0;
  auto mesh = std::make_shared<Mesh>(generate({"sphere", {{"cells", {10}}, {"order", {3}}, {"radius", {r}}}, {}}));
  const std::vector<double> m = means(on(mesh));
  const double side = m[3] > 0 ? 1 : -1;
  EXPECT_NEAR(m[0], r * r, 1e-5);
  EXPECT_NEAR(m[1], -side * 2 / r, 3e-3);  // second derivatives of a cubic interpolant
  EXPECT_NEAR(m[2], 1 / (r * r), 3e-3);
  EXPECT_NEAR(m[3], side * r, 1e-5);
  EXPECT_NEAR(m[4], 0, 1e-28);
  EXPECT_EQ(m[5], 1);
}

TEST(ReferencePoint, OfAOneSidedSurfaceSaysSo) {
  for (const char* name : {"moebius", "klein-bottle"}) {
    auto mesh = std::make_shared<Mesh>(generate({name, {{"cells", {12, 6}}, {"order", {2}}}, {}}));
    EXPECT_EQ(means(on(mesh))[5], 0) << name;
  }
}

TEST(ReferencePoint, OfTheBoundaryOfASolidLooksOutwards) {
  auto mesh =
      std::make_shared<Mesh>(generate({"box", {{"cells", {2, 2, 2}}, {"lower", {-1, -1, -1}}, {"size", {2, 2, 2}}}, {{"shape", "tetrahedron"}}}));
  Region skin{"skin", 2, boundary_facets(*mesh)};
  for (std::size_t c = 0; c < skin.cells.size(); c += 2) std::swap(skin.cells[c].nodes[1], skin.cells[c].nodes[2]);
  mesh->regions["skin"] = skin;
  EXPECT_NEAR(means(on(mesh, "skin"))[3], 1, 1e-12);  // n . x = 1 on the cube [-1, 1]^3
}

TEST(ReferencePoint, IsThatOfTheStressFreeConfigurationWhereItIsNotTheMesh) {
  // A rectangle rolled to a cylinder of radius 2.
  MapProblem p = on(moved_mesh("rectangle", {{"cells", {8, 4}}, {"size", {2.0, 1.0}}}, "quadrilateral"));
  p.input.reference_position = [](const Point3& x) { return Point3{{2 * std::sin(x[0] / 2), x[1], 2 * std::cos(x[0] / 2)}}; };
  p.input.reference_order = 3;
  double area = 0;
  const std::vector<double> m = means(p, &area);
  EXPECT_NEAR(area, 2, 1e-7);
  EXPECT_NEAR(m[0], 4 + 1.0 / 3, 1e-6);
  EXPECT_NEAR(std::fabs(m[1]), 0.5, 1e-3);
  EXPECT_NEAR(m[2], 0, 1e-10);
}

TEST(ReferencePoint, IsNotThePlaceOfParametersWhichAreFunctionsOfTheMesh) {
  // The load x on u = 1, on the unit square and where the same square, moved away, is free of stress.
  MapProblem p = on(moved_mesh("rectangle", {{"cells", {4, 4}}}, "triangle"));
  p.u.values[0].assign(p.u.values[0].size(), 1.0);
  p.input.parameters["value[0]"].function = [](const Point3& x, double) { return x[0]; };
  for (const bool moved : {false, true}) {
    if (moved) p.input.reference_position = [](const Point3& x) { return Point3{{x[0] + 7, x[1], 3}}; };
    p.input.reference_order = 1;
    p.make("volume-load");
    EXPECT_NEAR(p.functional->energy(p.u).energy, -0.5, 1e-14) << moved;
  }
}

/// The shell's density on the generic kernel: jets and the surface of the seam, against the closed-form kernel.
TEST(ReferencePoint, LetsTheCosseratDensityRunInTheGenericKernelWithTheNumbersOfTheFastOne) {
  for (const Rule rule : {Rule::projection, Rule::geodesic})
    for (const char* shape : {"triangle", "quadrilateral"}) {
      auto mesh = std::make_shared<Mesh>(generate({"klein-bottle", {{"cells", {6, 4}}, {"order", {2}}}, {{"shape", shape}}}));
      Region part = mesh->region("all");
      part.cells.resize(11);
      part.name = "part";
      mesh->regions["part"] = part;
      TermInput input;
      input.mesh = mesh;
      input.region = part;
      input.all_fields = {{"m", &manifold_ops<Euclidean<3>>(), rule, std::make_shared<Space>(mesh, part, 2)},
                          {"Q", &manifold_ops<Rotation>(), rule, std::make_shared<Space>(mesh, part, 1)}};
      input.fields = {0, 1};
      input.parameters = {{"mu", 3.0}, {"lambda", 2.0}, {"mu_c", 1.5}, {"L_c", 0.02}, {"b[0]", 1.2}, {"b[1]", 0.7}, {"b[2]", 0.4}};
      input.parameters["thickness"].function = [](const Point3& x, double) { return 0.02 + 0.005 * x[0]; };
      input.quadrature_degree = {{CellKind::triangle, 4}, {CellKind::quadrilateral, 4}};
      Configuration u;
      u.values.resize(2);
      Random random(4);
      for (int i = 0; i < input.all_fields[0].space->node_count(); ++i)
        for (int c = 0; c < 3; ++c) u.values[0].push_back(input.all_fields[0].space->position(i)[c] + random.uniform(-0.02, 0.02));
      for (int i = 0; i < input.all_fields[1].space->node_count(); ++i) {
        const Point3 v{{random.uniform(-0.3, 0.3), 0.7 + random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)}};
        for (const double c : quaternion_of_rotation_vector(v).e) u.values[1].push_back(c);
      }
      const auto layout = std::make_shared<Layout>(input.all_fields, std::vector<std::vector<char>>(2), CellRanks(mesh->cells.size(), 0), 0, 1);
      const auto assemble = [&](std::unique_ptr<Term> term, std::vector<double>& g, BlockMatrix& h, std::vector<double>& parts) {
        parts = term->part_energies(u);
        std::vector<std::unique_ptr<Term>> terms;
        terms.push_back(std::move(term));
        const Functional functional(layout, std::move(terms));
        h = functional.make_matrix();
        g.resize(static_cast<std::size_t>(layout->local_dofs()));
        double energy = 0;
        testing::with_large_stack([&] { energy = functional.hessian(u, g, h).energy; });
        return energy;
      };
      const TermInfo info{"shell", {"membrane", "bending", "curvature"}, {}, false, {}};
      const std::vector<std::string> keys{"thickness", "mu", "lambda", "mu_c", "L_c", "b[0]", "b[1]", "b[2]"};
      auto generic = with_rule<Rotation, 2>(input.field(1), [&]<class I>() -> std::unique_ptr<Term> {
        using M = LinearInterpolation<Euclidean<3>, 2, NativeScalar>;
        return std::make_unique<DensityTerm<VaryingDensity<CosseratShell>, 2, M, I>>(info, input, VaryingDensity<CosseratShell>{}, keys);
      });
      std::vector<double> g, g_fast, parts, parts_fast;
      BlockMatrix h, h_fast;
      const double energy = assemble(std::move(generic), g, h, parts);
      const double fast = assemble(make_term("cosserat-shell", input), g_fast, h_fast, parts_fast);
      EXPECT_NEAR(energy, fast, 1e-12 * fast);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(parts[k], parts_fast[k], 1e-12 * fast) << k;
      double size = 0, largest = 0, difference = 0, h_difference = 0;
      for (std::size_t i = 0; i < g.size(); ++i) {
        size = std::max(size, std::fabs(g_fast[i]));
        difference = std::max(difference, std::fabs(g[i] - g_fast[i]));
      }
      for (std::size_t i = 0; i < h.values.size(); ++i) {
        largest = std::max(largest, std::fabs(h_fast.values[i]));
        h_difference = std::max(h_difference, std::fabs(h.values[i] - h_fast.values[i]));
      }
      EXPECT_LT(difference, 1e-11 * size) << shape;
      EXPECT_LT(h_difference, 1e-10 * largest) << shape;
    }
}

TEST(ChiralSkyrmion, TellsItsTopologicalCharge) {
  // The inverse stereographic map covers the sphere but for a cap: charge -(1 - the cap's part) with u(0) = -e3.
  const double radius = 6;
  auto mesh = std::make_shared<Mesh>(generate({"disc", {{"cells", {24}}, {"order", {2}}, {"radius", {radius}}}, {{"shape", "triangle"}}}));
  MapProblem p(mesh, manifold_ops<Sphere<2>>(), Rule::projection, 2);
  for (int i = 0; i < p.space().node_count(); ++i) {
    const Point3 x = p.space().position(i);
    const double s = x[0] * x[0] + x[1] * x[1];
    for (const double c : {2 * x[0] / (1 + s), 2 * x[1] / (1 + s), (s - 1) / (1 + s)}) p.u.values[0].push_back(c);
  }
  p.input.parameters = {{"kappa", 0.5}, {"h", 0.2}};
  p.make("chiral-skyrmion");
  const Term& term = *p.functional->terms().front();
  ASSERT_EQ(term.info().quantities.size(), 1u);
  EXPECT_EQ(term.info().quantities[0].name, "charge");
  double charge = 0;
  const ReferenceGeometry geometry(*mesh, {}, 1);
  for (int b = 0; b < term.batch_count(); ++b) {
    const auto quantities = term.batch_quantities(p.u, b);
    for (int lane = 0; lane < term.batch(b).cells_used; ++lane) {
      const Cell& cell = term.cell(term.batch(b).cells[static_cast<std::size_t>(lane)]);
      const Quadrature& rule = quadrature(cell.kind, 8);
      const auto jets = geometry.at(cell, rule.points);
      for (std::size_t q = 0; q < jets.size(); ++q)
        charge += rule.weights[q] * cell_frame(jets[q], 2).measure * quantities[0][static_cast<std::size_t>(lane)];
    }
  }
  EXPECT_NEAR(std::fabs(charge), radius * radius / (1 + radius * radius), 1e-3);
}

}  // namespace
}  // namespace karcher
