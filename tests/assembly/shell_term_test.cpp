#include "karcher/assembly/shell_term.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "karcher/catalogue/catalogue.hpp"
#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/mesh/generators.hpp"

namespace karcher {
namespace {

using std::numbers::pi;
using Point3 = Vec3<double>;

struct Shell {
  TermInput input;
  Configuration u;  ///< fields: deformation, rotation
  std::unique_ptr<Term> term;

  /// Deformation = position of the nodes, rotation = identity.
  Shell(std::shared_ptr<const Mesh> mesh, int m_order, int r_order, Rule rule = Rule::projection, const Region* carrier = nullptr) {
    input.mesh = mesh;
    input.region = mesh->region("all");
    const Region& where = carrier ? *carrier : input.region;
    input.all_fields = {{"m", &manifold_ops<Euclidean<3>>(), rule, std::make_shared<Space>(mesh, where, m_order)},
                        {"R", &manifold_ops<Rotation>(), rule, std::make_shared<Space>(mesh, where, r_order)}};
    input.fields = {0, 1};
    input.parameters = {{"thickness", 0.01}, {"mu", 3.0}, {"lambda", 2.0}, {"mu_c", 1.5}, {"L_c", 0.02}, {"b[0]", 1.2}, {"b[1]", 0.7}, {"b[2]", 0.4}};
    input.choices = {{"coupling", "default"}};
    u.values.resize(2);
    set([](const Point3& x) { return x; }, [](const Point3&) { return Point3{}; });
  }
  const Space& space(std::size_t f) const { return *input.all_fields[f].space; }

  /// Nodal values from functions of the place: position, and rotation vector.
  template <class M, class R>
  void set(M position, R rotation) {
    u.values[0].clear();
    u.values[1].clear();
    for (int i = 0; i < space(0).node_count(); ++i)
      for (double x : position(space(0).position(i)).e) u.values[0].push_back(x);
    for (int i = 0; i < space(1).node_count(); ++i)
      for (double x : quaternion_of_rotation_vector(Point3(rotation(space(1).position(i)))).e) u.values[1].push_back(x);
  }
  void perturb(double m_scale, double r_scale, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (double& x : u.values[0]) x += m_scale * normal(generator);
    for (std::size_t i = 0; i < u.values[1].size(); i += 4) {
      Quaternion<double> q{{u.values[1][i], u.values[1][i + 1], u.values[1][i + 2], u.values[1][i + 3]}};
      q = quaternion_product(
          q, quaternion_of_rotation_vector(Point3{{r_scale * normal(generator), r_scale * normal(generator), r_scale * normal(generator)}}));
      for (std::size_t c = 0; c < 4; ++c) u.values[1][i + c] = q[static_cast<int>(c)];
    }
  }
  Term& make() {
    term = make_term("cosserat-shell", input);
    return *term;
  }
  double number(const std::string& parameter) const { return input.parameters.at(parameter).constant; }
};

struct Sum {
  double energy = 0, largest_gradient = 0;
};
Sum evaluate(const Term& term, const Configuration& u) {
  Sum sum;
  BatchResult out;
  for (int b = 0; b < term.batch_count(); ++b) {
    std::size_t n = 0;
    for (const LocalBlock& block : *term.batch(b).blocks) n += static_cast<std::size_t>(block.dim);
    out.gradient.resize(n * native_width);
    term.evaluate(u, b, Want::gradient, out);
    for (int lane = 0; lane < term.batch(b).cells_used; ++lane) {
      EXPECT_EQ(out.trouble[static_cast<std::size_t>(lane)], Trouble::none);
      sum.energy += out.energy[static_cast<std::size_t>(lane)];
    }
    for (double g : out.gradient) sum.largest_gradient = std::max(sum.largest_gradient, std::fabs(g));
  }
  return sum;
}

std::shared_ptr<const Mesh> mesh_of(const std::string& name, std::map<std::string, std::vector<double>> numbers, const std::string& shape = "") {
  GeneratorOptions options{name, std::move(numbers), {}};
  if (!shape.empty()) options.words["shape"] = shape;
  return std::make_shared<Mesh>(generate(options));
}

double plane_stress(const Shell& s) {  // lambda mu / (lambda + 2 mu)
  return s.number("lambda") * s.number("mu") / (s.number("lambda") + 2 * s.number("mu"));
}
double half_curvature_modulus(const Shell& s) { return s.number("mu") * std::pow(s.number("L_c"), 2) * (s.number("b[0]") + s.number("b[1]")) / 2; }

TEST(ShellTerm, HasNoEnergyAndNoForcesInTheReferenceOfEveryGeneratedSurface) {
  for (const GeneratorInfo& info : generators())
    for (int order : {1, 2, 3}) {
      for (const std::string shape : {"triangle", "quadrilateral"}) {
        GeneratorOptions options{info.name, {{"order", {static_cast<double>(order)}}}, {}};
        if (std::ranges::any_of(info.arguments, [](const GeneratorArgument& a) { return a.name == "shape"; })) {
          const auto& words = std::ranges::find(info.arguments, "shape", &GeneratorArgument::name)->words;
          if (std::ranges::find(words, shape) == words.end()) continue;
          options.words["shape"] = shape;
        } else if (shape == "quadrilateral") {
          continue;
        }
        const auto mesh = std::make_shared<Mesh>(generate(options));
        if (mesh->dim != 2) continue;
        Shell s(mesh, order, 2);
        const Sum sum = evaluate(s.make(), s.u);
        EXPECT_LT(std::fabs(sum.energy), 1e-26) << info.name << " " << shape << " " << order;
        EXPECT_LT(sum.largest_gradient, 1e-14) << info.name << " " << shape << " " << order;
      }
    }
}

TEST(ShellTerm, IsInvariantUnderRigidMotionsOfAMoebiusStrip) {
  for (Rule rule : {Rule::projection, Rule::geodesic}) {
    Shell s(mesh_of("moebius", {{"order", {2}}, {"cells", {12, 2}}}), 2, 2, rule);
    s.perturb(0.02, 0.1, 1);
    const double before = evaluate(s.make(), s.u).energy;
    const Quaternion<double> turn = quaternion_of_rotation_vector(Point3{{0.3, 1.2, -2.0}});
    const Mat3<double> a = rotation_matrix(turn);
    for (std::size_t i = 0; i < s.u.values[0].size(); i += 3) {
      const Point3 x = a * Point3{{s.u.values[0][i], s.u.values[0][i + 1], s.u.values[0][i + 2]}};
      for (std::size_t c = 0; c < 3; ++c) s.u.values[0][i + c] = x[static_cast<int>(c)] + 0.1;
    }
    for (std::size_t i = 0; i < s.u.values[1].size(); i += 4) {
      const auto q =
          quaternion_product(turn, Quaternion<double>{{s.u.values[1][i], s.u.values[1][i + 1], s.u.values[1][i + 2], s.u.values[1][i + 3]}});
      for (std::size_t c = 0; c < 4; ++c) s.u.values[1][i + c] = -q[static_cast<int>(c)];  // the other sign is the same rotation
    }
    EXPECT_NEAR(evaluate(*s.term, s.u).energy, before, 1e-12 * before);
  }
}

TEST(ShellTerm, DoesNotSeeTheOrientationOfTheCellsOfAKleinBottle) {
  for (const std::string coupling : {"default", "birsan-2021"}) {
    Shell s(mesh_of("klein-bottle", {{"order", {2}}, {"cells", {24, 12}}}), 2, 2);
    s.input.choices["coupling"] = coupling;
    s.input.parameters["thickness"] = 0.03;
    s.perturb(0.02, 0.2, 7);
    const double before = evaluate(s.make(), s.u).energy;
    std::mt19937 generator(3);
    int flipped = 0;
    for (Cell& c : s.input.region.cells) {
      if (generator() % 2 == 0) continue;
      std::swap(c.nodes[1], c.nodes[2]);
      std::swap(c.nodes[3], c.nodes[5]);
      ++flipped;
    }
    EXPECT_GT(flipped, 100);
    EXPECT_NEAR(evaluate(s.make(), s.u).energy, before, 1e-13 * before);
  }
}

/// Energies on meshes that are finer by factors of two, the exact value: the observed order of the last two.
double order_of(const std::vector<double>& energies, double exact) {
  const std::size_t n = energies.size();
  return std::log2(std::fabs(energies[n - 2] - exact) / std::fabs(energies[n - 1] - exact));
}

TEST(ShellTerm, GivesTheExactEnergyOfAStripRolledIntoACylinder) {
  // m = (sin kx/k, y, (1 - cos kx)/k), R about e_2 by -kx: density [h^3/12 (mu + lambda mu/(lambda + 2 mu)) + h C] k^2, C = mu L_c^2 (b1 + b2)/2.
  const double k = 1.3, length = 2, width = 0.5;
  for (const std::string shape : {"triangle", "quadrilateral"})
    for (Rule rule : {Rule::projection, Rule::geodesic})
      for (int order : {1, 2, 3}) {
        std::vector<double> energies;
        double exact = 0;
        for (int n : {4, 8, 16}) {
          Shell s(mesh_of("rectangle", {{"size", {length, width}}, {"cells", {static_cast<double>(n), 2}}}, shape), order, order, rule);
          s.input.parameters["thickness"] = 0.1;
          s.set(
              [&](const Point3& x) {
                return Point3{{std::sin(k * x[0]) / k, x[1], (1 - std::cos(k * x[0])) / k}};
              },
              [&](const Point3& x) {
                return Point3{{0, -k * x[0], 0}};
              });
          energies.push_back(evaluate(s.make(), s.u).energy);
          const double h = s.number("thickness");
          exact = (h * h * h / 12 * (s.number("mu") + plane_stress(s)) + h * half_curvature_modulus(s)) * k * k * length * width;
        }
        EXPECT_GT(order_of(energies, exact), 2 * order - 0.2) << shape << order;
        EXPECT_NEAR(energies.back(), exact, (order == 1 ? 1 : order == 2 ? 1e-3 : 1e-6) * exact) << shape << order;
      }
}

TEST(ShellTerm, GivesTheExactEnergyOfACylinderThatIsWidenedAndClosed) {
  // The sector phi -> alpha phi, r -> r' (benchmarks of the theory): s = r' alpha/r, kappa = (alpha - 1)/r, chi = (alpha - s)/r, density
  // h M (s-1)^2 + h^3/12 M chi^2 + h^5/80 (mu + lambda/2) (chi/r)^2 + C kappa^2 (h + h^3/(12 r^2) + h^5/(80 r^4)), M = mu + lambda mu/(lambda + 2
  // mu).
  // The stress-free cylinder is given as a function on a flat sheet, as the interpolant of order 3.
  const double r = 0.8, r1 = 1.0, alpha = 1.2, angle = 1.5, height = 0.4;
  for (const std::string shape : {"triangle", "quadrilateral"}) {
    std::vector<double> energies;
    double exact = 0;
    for (int n : {4, 8, 16}) {
      Shell s(mesh_of("rectangle", {{"size", {angle, height}}, {"cells", {static_cast<double>(n), 2}}}, shape), 3, 3);
      s.input.parameters["thickness"] = 0.2;
      s.input.reference_position = [&](const Point3& x) { return Point3{{r * std::cos(x[0]), r * std::sin(x[0]), x[1]}}; };
      s.input.reference_order = 3;
      s.set(
          [&](const Point3& x) {
            return Point3{{r1 * std::cos(alpha * x[0]), r1 * std::sin(alpha * x[0]), x[1]}};
          },
          [&](const Point3& x) {
            return Point3{{0, 0, (alpha - 1) * x[0]}};
          });
      energies.push_back(evaluate(s.make(), s.u).energy);
      const double h = s.number("thickness"), m = s.number("mu") + plane_stress(s);
      const double stretch = r1 * alpha / r, kappa = (alpha - 1) / r, chi = (alpha - stretch) / r;
      const double density = h * m * std::pow(stretch - 1, 2) + std::pow(h, 3) / 12 * m * chi * chi +
                             std::pow(h, 5) / 80 * (s.number("mu") + s.number("lambda") / 2) * std::pow(chi / r, 2) +
                             half_curvature_modulus(s) * kappa * kappa * (h + std::pow(h, 3) / (12 * r * r) + std::pow(h, 5) / (80 * std::pow(r, 4)));
      exact = density * angle * r * height;
    }
    EXPECT_GT(order_of(energies, exact), 1.9) << shape;  // b of a cubic surface is exact to second order
    EXPECT_NEAR(energies.back(), exact, 1e-5 * exact) << shape;
  }
}

TEST(ShellTerm, GivesTheExactEnergyOfAnInflatedSphere) {
  // m = s x, R = I: E = (s - 1) a, K = 0, b = -a/r. Density (s-1)^2 [(h - h^3/(12 r^2)) + (h^3/12 - h^5/(80 r^2))/r^2] (2 mu + 4 lambda mu/(lambda +
  // 2 mu))
  // + (s-1)^2 h^5/(80 r^4) (2 mu + 2 lambda); with the refined form the last bracket is the same as the first.
  const double r = 1.5, stretch = 1.1;
  for (const std::string coupling : {"default", "birsan-2021"}) {
    std::vector<double> energies;
    double exact = 0;
    for (int n : {2, 4, 8}) {
      Shell s(mesh_of("sphere", {{"radius", {r}}, {"cells", {static_cast<double>(n)}}, {"order", {3}}}), 3, 1);
      s.input.parameters["thickness"] = 0.3;
      s.input.choices["coupling"] = coupling;
      s.set([&](const Point3& x) { return stretch * x; }, [](const Point3&) { return Point3{}; });
      energies.push_back(evaluate(s.make(), s.u).energy);
      const double h = s.number("thickness"), r2 = r * r, first = 2 * s.number("mu") + 4 * plane_stress(s);
      const double last = coupling == "default" ? 2 * s.number("mu") + 2 * s.number("lambda") : first;
      const double h3 = std::pow(h, 3) / 12, h5 = std::pow(h, 5) / 80;
      exact = 4 * pi * r2 * std::pow(stretch - 1, 2) * (((h - h3 / r2) + (h3 - h5 / r2) / r2) * first + h5 / (r2 * r2) * last);
    }
    EXPECT_GT(order_of(energies, exact), 1.9);
    EXPECT_NEAR(energies.back(), exact, 1e-5 * exact);
  }
}

TEST(ShellTerm, SplitsTheEnergyIntoItsParts) {
  Shell s(mesh_of("torus", {{"order", {2}}, {"cells", {12, 6}}}), 2, 1);
  s.input.parameters["thickness"] = 0.1;
  s.perturb(0.02, 0.1, 2);
  const double total = evaluate(s.make(), s.u).energy;
  const auto parts = s.term->part_energies(s.u);
  ASSERT_EQ(s.term->part_names(), (std::vector<std::string>{"membrane", "bending", "curvature"}));
  EXPECT_NEAR(parts[0] + parts[1] + parts[2], total, 1e-13 * total);
  for (double p : parts) EXPECT_GT(p, 1e-6 * total);
  // A flat sheet that is stretched in its plane has membrane energy alone, one whose directors turn about its normal no bending energy.
  Shell sheet(mesh_of("rectangle", {}), 1, 1);
  sheet.set([](const Point3& x) { return Point3{{1.1 * x[0], x[1], 0}}; }, [](const Point3&) { return Point3{}; });
  const auto stretched = sheet.make().part_energies(sheet.u);
  EXPECT_NEAR(stretched[0], 0.01 * 0.01 * (sheet.number("mu") + plane_stress(sheet)), 1e-16);
  EXPECT_EQ(stretched[1], 0);
  EXPECT_EQ(stretched[2], 0);
}

TEST(ShellTerm, SharesTheDeformationOfASolidWhoseBoundaryItCovers) {
  const auto mesh = mesh_of("box", {{"size", {2, 1, 1}}, {"cells", {3, 2, 2}}, {"order", {2}}}, "hexahedron");
  const Region top = mesh->region("back");  // z = 1
  Shell film(mesh, 2, 1, Rule::projection, &mesh->region("all"));
  Shell alone(mesh, 2, 1, Rule::projection, &top);
  film.input.region = alone.input.region = top;
  film.input.all_fields[1].space = alone.input.all_fields[1].space;
  const auto bend = [](const Point3& x) { return Point3{{x[0] + 0.1 * x[1] * x[2], x[1], x[2] + 0.2 * x[0] * x[0]}}; };
  const auto turn = [](const Point3& x) { return Point3{{0.1, 0.2 * x[0], 0.3 * x[1]}}; };
  film.set(bend, turn);
  alone.set(bend, turn);
  const double energy = evaluate(alone.make(), alone.u).energy;
  EXPECT_GT(energy, 1e-5);
  EXPECT_NEAR(evaluate(film.make(), film.u).energy, energy, 1e-14 * energy);

  // ... and a field that does not cover the film is an error that names both regions.
  const Region bottom = mesh->region("front");
  film.input.all_fields[0].space = std::make_shared<Space>(mesh, bottom, 2);
  try {
    film.make();
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("\"front\""), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("\"back\""), std::string::npos) << e.what();
  }
}

TEST(ShellTerm, AddsUpOverTrianglesAndQuadrilaterals) {
  // Two unit squares, one of each kind, far apart.
  Mesh mixed = generate({"rectangle", {{"cells", {3, 3}}}, {{"shape", "triangle"}}});
  const Mesh second = generate({"rectangle", {{"cells", {2, 3}}, {"lower", {5, 0}}}, {{"shape", "quadrilateral"}}});
  const int shift = static_cast<int>(mixed.nodes.size());
  mixed.nodes.insert(mixed.nodes.end(), second.nodes.begin(), second.nodes.end());
  for (Cell c : second.cells) {
    for (int& n : c.nodes) n += shift;
    mixed.cells.push_back(c);
  }
  mixed.regions.clear();
  mixed.regions["all"] = {"all", 2, mixed.cells};
  const auto deform = [](const Point3& x) { return Point3{{x[0] + 0.1 * x[1] * x[1], 1.2 * x[1], 0.1 * std::sin(x[0])}}; };
  const auto turn = [](const Point3& x) { return Point3{{0.1 * x[1], std::sin(x[0]), 0.2}}; };
  double sum = 0;
  for (const auto& [name, mesh] : std::map<std::string, std::shared_ptr<const Mesh>>{
           {"mixed", std::make_shared<Mesh>(mixed)},
           {"triangles", mesh_of("rectangle", {{"cells", {3, 3}}}, "triangle")},
           {"quadrilaterals", mesh_of("rectangle", {{"cells", {2, 3}}, {"lower", {5, 0}}}, "quadrilateral")}}) {
    Shell s(mesh, 2, 2);
    s.set(deform, turn);
    const double energy = evaluate(s.make(), s.u).energy;
    EXPECT_GT(energy, 1e-4);
    sum += name == "mixed" ? energy : -energy;
  }
  EXPECT_NEAR(sum, 0, 1e-14);
}

TEST(ShellTerm, TakesExpressionsOfPlaceAndLoadParameter) {
  Shell s(mesh_of("rectangle", {{"cells", {8, 2}}}, "quadrilateral"), 1, 1);
  s.set([](const Point3& x) { return Point3{{1.1 * x[0], x[1], 0}}; }, [](const Point3&) { return Point3{}; });
  ParameterValue thickness;
  thickness.function = [](const Point3& x, double t) { return 0.1 * (1 + x[0]) * (1 + t); };
  thickness.depends_on_t = true;
  s.input.parameters["thickness"] = thickness;
  s.make();
  // membrane energy of a homogeneous stretch: int h M 0.01
  const double m = s.number("mu") + plane_stress(s);
  EXPECT_NEAR(evaluate(*s.term, s.u).energy, 0.15 * m * 0.01, 1e-15);
  s.term->set_load_parameter(1);
  EXPECT_NEAR(evaluate(*s.term, s.u).energy, 0.30 * m * 0.01, 1e-15);
  s.term->set_load_parameter(0);
  EXPECT_NEAR(evaluate(*s.term, s.u).energy, 0.15 * m * 0.01, 1e-15);
  // the place is that on the mesh, also where the stress-free configuration is another
  s.input.reference_position = [](const Point3& x) { return Point3{{x[0] + 7, x[1], 3}}; };
  s.input.reference_order = 1;
  EXPECT_NEAR(evaluate(s.make(), s.u).energy, 0.15 * m * 0.01, 1e-15);
}

std::string message_of(Shell& s) {
  try {
    s.make();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ShellTerm, RefusesAThicknessTooLargeForTheCurvature) {
  Shell s(mesh_of("cylinder", {{"radius", {0.5}}, {"order", {3}}}), 3, 2);
  s.input.parameters["thickness"] = 0.9;
  EXPECT_EQ(message_of(s), "");
  s.input.parameters["thickness"] = 1.1;
  const std::string message = message_of(s);
  EXPECT_NE(message.find("thickness 1.1 times principal curvature -2"), std::string::npos) << message;
  EXPECT_NE(message.find("must be less than 2"), std::string::npos) << message;
}

TEST(ShellTerm, WarnsWhereTheDensityIsNotPositiveDefinite) {
  Shell thin(mesh_of("sphere", {{"radius", {1}}, {"order", {2}}}), 2, 2);
  thin.input.parameters["mu_c"] = 0.0;
  EXPECT_TRUE(thin.make().warnings().empty());
  // As mu_c falls to 0 the twisting block loses a positive eigenvalue at about h kappa = 1.4 where the curvatures are as 1 to 2.
  Shell bowl(mesh_of("rectangle", {{"lower", {-0.01, -0.01}}, {"size", {0.02, 0.02}}, {"cells", {1, 3}}}), 2, 2);
  bowl.input.reference_position = [](const Point3& x) { return Point3{{x[0], x[1], 0.27 * x[0] * x[0] + 0.5 * x[1] * x[1]}}; };
  bowl.input.parameters["mu_c"] = 1e-12;
  bowl.input.parameters["L_c"] = 1e-3;
  bowl.input.parameters["thickness"] = 1.0;
  EXPECT_TRUE(bowl.make().warnings().empty());
  bowl.input.parameters["thickness"] = 1.9;
  bowl.make();
  ASSERT_EQ(bowl.term->warnings().size(), 1u);
  EXPECT_NE(bowl.term->warnings()[0].find("not positive definite in 6 cells"), std::string::npos) << bowl.term->warnings()[0];
}

TEST(ShellTerm, WarnsWhereHardlyAnythingHoldsTheDrillingRotation) {
  Shell s(mesh_of("rectangle", {}), 1, 1);
  s.input.parameters["mu_c"] = 0.0;
  EXPECT_TRUE(s.make().warnings().empty());  // L_c is twice the thickness
  s.input.parameters["L_c"] = 0.005;
  ASSERT_EQ(s.make().warnings().size(), 1u);
  EXPECT_NE(s.term->warnings()[0].find("A classical shell has mu_c = mu."), std::string::npos) << s.term->warnings()[0];
}

TEST(ShellTerm, TellsTheStrainsOfStretchingAndOfBending) {
  constexpr double h = 0.02, R = 0.5;
  Shell s(mesh_of("rectangle", {{"cells", {8, 2}}}), 3, 3);
  s.input.parameters["thickness"] = h;
  const Term& term = s.make();
  ASSERT_EQ(term.info().quantities.size(), 1u);
  const auto strains = [&] {
    std::vector<double> all;
    for (int b = 0; b < term.batch_count(); ++b)
      for (int lane = 0; lane < term.batch(b).cells_used; ++lane) all.push_back(term.batch_quantities(s.u, b)[0][static_cast<std::size_t>(lane)]);
    return all;
  };
  s.set([](const Point3& x) { return Point3{{1.1 * x[0], 0.8 * x[1], 0.0}}; }, [](const Point3&) { return Point3{}; });
  for (const double strain : strains()) EXPECT_NEAR(strain, std::hypot(0.1, 0.2), 1e-14);
  // Rolled up to a cylinder, the faces are strained by h / (2 R).
  s.set(
      [](const Point3& x) {
        return Point3{{R * std::sin(x[0] / R), x[1], R * (1 - std::cos(x[0] / R))}};
      },
      [](const Point3& x) {
        return Point3{{0, -x[0] / R, 0}};
      });
  for (const double strain : strains()) EXPECT_NEAR(strain, 0.5 * h / R, 1e-4);
}

TEST(ShellTerm, RefusesDataThatMakeNoSense) {
  const auto mesh = mesh_of("rectangle", {{"cells", {2, 2}}});
  const auto with = [&](const std::string& name, ParameterValue value) {
    Shell s(mesh, 1, 1);
    s.input.parameters[name] = std::move(value);
    return message_of(s);
  };
  EXPECT_NE(with("thickness", -1.0).find("thickness = -1"), std::string::npos);
  EXPECT_NE(with("mu", std::nan("")).find("mu = nan"), std::string::npos);
  EXPECT_NE(with("lambda", -2.1).find("3 lambda + 2 mu"), std::string::npos);
  EXPECT_NE(with("mu_c", -0.1).find("mu_c"), std::string::npos);
  EXPECT_NE(with("L_c", 0.0).find("L_c"), std::string::npos);
  EXPECT_NE(with("b[1]", -1.0).find("b"), std::string::npos);
  ParameterValue hole;
  hole.function = [](const Point3& x, double) { return x[0] > 0.5 ? 1.0 / 0.0 : 0.1; };
  EXPECT_NE(with("thickness", hole).find("thickness = inf at ("), std::string::npos);

  Shell swapped(mesh, 1, 1);
  std::swap(swapped.input.fields[0], swapped.input.fields[1]);
  EXPECT_NE(message_of(swapped).find("must have values in R3"), std::string::npos);
  Shell edge(mesh, 1, 1);
  edge.input.region = mesh->region("left");
  EXPECT_NE(message_of(edge).find("has dimension 1"), std::string::npos);
  Shell folded(mesh, 1, 1);
  folded.input.reference_position = [](const Point3& x) { return Point3{{x[0], 2 * x[0], 0}}; };
  EXPECT_NE(message_of(folded).find("degenerate"), std::string::npos);
}

TEST(ShellTerm, UsesTheQuadratureThatIsAskedFor) {
  Shell s(mesh_of("rectangle", {{"cells", {1, 1}}}, "quadrilateral"), 2, 2);
  s.perturb(0.1, 0.5, 4);
  const double standard = evaluate(s.make(), s.u).energy;
  s.input.quadrature_degree[CellKind::quadrilateral] = default_shell_degree(CellKind::quadrilateral, 2);
  EXPECT_EQ(evaluate(s.make(), s.u).energy, standard);
  std::vector<double> errors;
  s.input.quadrature_degree[CellKind::quadrilateral] = 39;
  const double exact = evaluate(s.make(), s.u).energy;
  for (int degree : {3, 7, 15}) {
    s.input.quadrature_degree[CellKind::quadrilateral] = degree;
    errors.push_back(std::fabs(evaluate(s.make(), s.u).energy - exact));
  }
  EXPECT_LT(errors[1], 0.2 * errors[0]);
  EXPECT_LT(errors[2], 0.05 * errors[1]);
}

}  // namespace
}  // namespace karcher
