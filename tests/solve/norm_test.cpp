#include "karcher/solve/norm.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/solve/collectives.hpp"
#include "solve/small_problem.hpp"

namespace karcher {
namespace {

double total(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

TEST(LumpedMass, IsPositiveAndSumsToTheMeasure) {
  for (const char* shape : {"triangle", "quadrilateral"}) {
    GeneratorOptions options;
    options.name = "rectangle";
    options.numbers["size"] = {3, 2};
    options.numbers["cells"] = {3, 4};
    options.words["shape"] = shape;
    const auto mesh = std::make_shared<const Mesh>(generate(options));
    for (int order : {1, 2, 3}) {
      const auto mass = lumped_mass(Space(mesh, mesh->region("all"), order));
      for (double m : mass) EXPECT_GT(m, 0);
      EXPECT_NEAR(total(mass), 6, 1e-12);
    }
  }
}

TEST(LumpedMass, OfTheLinearTriangleIsAThirdOfItsAreaAtEachVertex) {
  auto mesh = std::make_shared<Mesh>();
  mesh->dim = 2;
  mesh->nodes = {{{0, 0, 0}}, {{2, 0, 0}}, {{0, 3, 0}}};
  Cell c;
  c.kind = CellKind::triangle;
  c.nodes = {0, 1, 2};
  mesh->cells = {c};
  mesh->regions["all"] = {"all", 2, {c}};
  for (double m : lumped_mass(Space(mesh, mesh->regions.at("all"), 1))) EXPECT_NEAR(m, 1, 1e-14);
  // Quadratic: the diagonal of the consistent mass is in the ratio 6 (vertices) to 32 (edges), Zienkiewicz and Taylor.
  const Space quadratic(mesh, mesh->regions.at("all"), 2);
  const auto mass = lumped_mass(quadratic);
  std::vector<double> in_cell;
  for (int node : quadratic.cell_nodes(0)) in_cell.push_back(mass[static_cast<std::size_t>(node)]);
  for (int v = 0; v < 3; ++v) EXPECT_NEAR(in_cell[static_cast<std::size_t>(v)], 3.0 * 6 / 114, 1e-13);
  for (int e = 3; e < 6; ++e) EXPECT_NEAR(in_cell[static_cast<std::size_t>(e)], 3.0 * 32 / 114, 1e-13);
}

/// Sum over the unknowns of all ranks.
double step_mass_of(const ManifoldOps& manifold, int cells) {
  const testing::SmallProblem p(cells, manifold, {}, std::vector<double>(static_cast<std::size_t>((cells + 1) * manifold.ambient)));
  std::vector<double> mass = step_mass(*p.layout);
  mass.resize(static_cast<std::size_t>(p.layout->owned_dofs()));
  return sum_over_ranks(total(mass));
}

TEST(StepMass, MeasuresStepsInRnByHalfTheSizeOfTheMeshAndAllOthersAsTheyAre) {
  EXPECT_NEAR(step_mass_of(manifold_ops<Euclidean<3>>(), 20), 3 / 100.0, 1e-15);
  EXPECT_NEAR(step_mass_of(manifold_ops<Rotation>(), 20), 3, 1e-14);
  EXPECT_NEAR(step_mass_of(manifold_ops<Product<Euclidean<3>, Rotation>>(), 20), 3 / 100.0 + 3, 1e-14);
  EXPECT_NEAR(step_mass_of(manifold_ops<Product<Rotation, Euclidean<1>>>(), 20), 1 / 100.0 + 3, 1e-14);
}

/// Positions of second order on a rectangle of 3 by 2, and directions of first order on its left edge, as one of `ranks` sees them.
Layout two_fields(int rank, int ranks) {
  GeneratorOptions options;
  options.name = "rectangle";
  options.numbers["size"] = {3, 2};
  options.numbers["cells"] = {3, 4};
  options.words["shape"] = "quadrilateral";
  const auto mesh = std::make_shared<const Mesh>(generate(options));
  const std::vector<Field> fields = {{"x", &manifold_by_name("R3"), Rule::projection, std::make_shared<Space>(mesh, mesh->region("all"), 2)},
                                     {"n", &manifold_by_name("S2"), Rule::projection, std::make_shared<Space>(mesh, mesh->region("left"), 1)}};
  return Layout(fields, {{}, {}}, partition_cells(*mesh, ranks), rank, ranks);
}

TEST(StepMass, MakesFieldsComparableAndFreeOfUnits) {
  for (const int ranks : {1, 2, 3}) {
    // A unit move of all nodes in one component: the mean square is 1, of positions in parts of half the diagonal sqrt(13).
    std::vector<std::vector<double>> sums(2, std::vector<double>(3, 0.0));
    for (int rank = 0; rank < ranks; ++rank) {
      const Layout layout = two_fields(rank, ranks);
      const std::vector<double> mass = step_mass(layout);
      ASSERT_EQ(mass.size(), static_cast<std::size_t>(layout.local_dofs()));
      for (int f : {0, 1}) {
        const std::vector<double> nodal = lumped_mass(*layout.fields()[static_cast<std::size_t>(f)].space);
        for (int node : layout.local_nodes(f))
          for (int k = 0; k < layout.fields()[static_cast<std::size_t>(f)].manifold->dim; ++k) {
            const double m = mass[static_cast<std::size_t>(layout.first_dof(f, node) + k)];
            EXPECT_NEAR(m, nodal[static_cast<std::size_t>(node)] / (f == 0 ? 6 * 13 / 4.0 : 2.0), 1e-15);
            if (layout.owns(f, node)) sums[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)] += m;
          }
      }
    }
    for (std::size_t k : {0, 1, 2}) EXPECT_NEAR(sums[0][k], 4 / 13.0, 1e-14);
    for (std::size_t k : {0, 1}) EXPECT_NEAR(sums[1][k], 1, 1e-14);
  }
}

TEST(StepMass, RefusesAMeshWhoseLengthsCannotBeSquaredOrWhoseCellsAreEmpty) {
  const auto layout_of = [](std::vector<double> x) {
    auto mesh = std::make_shared<Mesh>();
    mesh->dim = 1;
    Cell cell;
    cell.kind = CellKind::line;
    for (int i = 0; i < static_cast<int>(x.size()); ++i) {
      mesh->nodes.push_back({{x[static_cast<std::size_t>(i)], 0, 0}});
      cell.nodes = {i - 1, i};
      if (i > 0) mesh->cells.push_back(cell);
    }
    mesh->regions["all"] = {"all", 1, mesh->cells};
    const std::vector<Field> fields{{"u", &manifold_by_name("R1"), Rule::projection, std::make_shared<Space>(mesh, mesh->regions.at("all"), 1)}};
    return Layout(fields, std::vector<std::vector<char>>(1), partition_cells(*mesh, 1), 0, 1);
  };
  for (const std::vector<double>& x : {std::vector<double>{0, 1e160}, {0, 1, 1, 1}}) {
    try {
      step_mass(layout_of(x));
      FAIL();
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(") of the field \"u\" its cells have no"), std::string::npos) << e.what();
    }
  }
}

TEST(LumpedMass, OfAPointIsOne) {
  auto mesh = std::make_shared<Mesh>();
  mesh->dim = 1;
  mesh->nodes = {{{0, 0, 0}}, {{2, 0, 0}}};
  Cell line;
  line.kind = CellKind::line;
  line.nodes = {0, 1};
  mesh->cells = {line};
  Cell point;
  point.kind = CellKind::vertex;
  point.nodes = {1};
  mesh->regions["end"] = {"end", 0, {point}};
  EXPECT_EQ(lumped_mass(Space(mesh, mesh->regions.at("end"), 1)), std::vector<double>{1});
}

}  // namespace
}  // namespace karcher
