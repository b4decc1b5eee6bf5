// Discrete harmonic maps into the sphere against the inverse stereographic map on [-1, 1]^2, its own boundary values given: errors in L2 of the order p + 1, in
// H1 of the order p, and energies.
#include <gtest/gtest.h>

#include "assembly/map_error.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/minimize.hpp"
#include "karcher/solve/petsc.hpp"

namespace karcher {
namespace {

constexpr double exact_energy = 6.963358010936825580;

struct Solution {
  double energy = 0;
  testing::MapError error;
};

/// \param degree  of quadrature; 0: the default of the energy
Solution solve(const std::string& shape, int n, int order, Rule rule, int degree = 0) {
  const testing::InverseStereographic map;
  const double cells = n;
  const auto mesh =
      std::make_shared<Mesh>(generate({"rectangle", {{"lower", {-1, -1}}, {"size", {2, 2}}, {"cells", {cells, cells}}}, {{"shape", shape}}}));
  TermInput input;
  input.mesh = mesh;
  input.all_fields = {{"u", &manifold_ops<Sphere<2>>(), rule, std::make_shared<Space>(mesh, mesh->region("all"), order)}};
  input.fields = {0};
  input.parameters["scale"] = 1.0;
  if (degree > 0) input.quadrature_degree[mesh->cells.front().kind] = degree;
  const Space& space = *input.all_fields[0].space;
  std::vector<std::vector<char>> fixed(1);
  for (int i = 0; i < space.node_count(); ++i) {
    const auto& x = space.position(i);
    const char on_edge = std::fabs(x[0]) > 1 - 1e-9 || std::fabs(x[1]) > 1 - 1e-9;
    fixed[0].insert(fixed[0].end(), 2, on_edge);
  }
  const auto layout = std::make_shared<Layout>(input.all_fields, fixed, partition_cells(*mesh, world_size()), world_rank(), world_size());
  input.region = mesh->region("all");
  std::erase_if(input.region.cells, [&](const Cell& c) { return layout->cell_rank(c) != layout->rank(); });
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(make_term("harmonic", input));
  Functional functional(layout, std::move(terms));
  Configuration u;
  u.values.push_back(testing::nodal_values(space, map));
  const StepReport report = minimize(functional, u, {}, {});
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_EQ(report.negative_eigenvalues, 0);
  complete(*layout, u);
  return {report.energy, testing::error_of(input.all_fields[0], u.values[0], map)};
}

}  // namespace

TEST(HarmonicMaps, ConvergeWithOptimalOrdersForBothRulesOnTrianglesAndQuadrilaterals) {
  for (const std::string shape : {"triangle", "quadrilateral"})
    for (Rule rule : {Rule::projection, Rule::geodesic})
      for (int order : {1, 2, 3}) {
        const int n = order == 1 ? 12 : 6;
        const Solution coarse = solve(shape, n, order, rule), fine = solve(shape, 2 * n, order, rule);
        EXPECT_NEAR(std::log2(coarse.error.l2 / fine.error.l2), order + 1, 0.15)
            << shape << " " << order << (rule == Rule::geodesic ? " geodesic" : "");
        EXPECT_NEAR(std::log2(coarse.error.h1 / fine.error.h1), order, 0.15) << shape << " " << order << (rule == Rule::geodesic ? " geodesic" : "");
        // Interpolated boundary values cost the energy the order p + 1, which is felt from p = 3 on.
        if (order < 3) {
          EXPECT_NEAR(std::log2((coarse.energy - exact_energy) / (fine.energy - exact_energy)), 2 * order, 0.35) << shape << " " << order;
        }
      }
}

TEST(HarmonicMaps, HaveTheTabulatedEnergiesAndErrors) {
  const Solution q1 = solve("quadrilateral", 8, 1, Rule::projection, 14), q1_fine = solve("quadrilateral", 16, 1, Rule::projection, 14);
  EXPECT_NEAR(q1.energy, 7.0171138772, 1e-8);
  EXPECT_NEAR(q1.error.l2, 9.511377e-3, 1e-7);
  EXPECT_NEAR(q1.error.h1, 2.248390e-1, 1e-6);
  EXPECT_NEAR(q1_fine.energy, 6.9768307949, 1e-8);
  const Solution q2 = solve("quadrilateral", 8, 2, Rule::projection, 14), q2_fine = solve("quadrilateral", 16, 2, Rule::projection, 14);
  EXPECT_NEAR(q2.energy, 6.9639263964, 1e-9);
  EXPECT_NEAR(q2.error.l2, 1.263650e-3, 1e-8);
  EXPECT_NEAR(q2.error.h1, 3.221167e-2, 1e-7);
  EXPECT_NEAR(q2_fine.energy, 6.9633942890, 1e-9);
}

}  // namespace karcher
