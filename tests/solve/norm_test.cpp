#include "karcher/solve/norm.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/mesh/generators.hpp"
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

double step_mass_of(const ManifoldOps& manifold, int cells) {
  return total(
      step_mass(*testing::SmallProblem(cells, manifold, {}, std::vector<double>(static_cast<std::size_t>((cells + 1) * manifold.ambient))).layout));
}

TEST(StepMass, MeasuresStepsInRnByHalfTheSizeOfTheMeshAndAllOthersAsTheyAre) {
  EXPECT_NEAR(step_mass_of(manifold_ops<Euclidean<3>>(), 20), 3 / 100.0, 1e-15);
  EXPECT_NEAR(step_mass_of(manifold_ops<Rotation>(), 20), 3, 1e-14);
  EXPECT_NEAR(step_mass_of(manifold_ops<Product<Euclidean<3>, Rotation>>(), 20), 3 / 100.0 + 3, 1e-14);
  EXPECT_NEAR(step_mass_of(manifold_ops<Product<Rotation, Euclidean<1>>>(), 20), 1 / 100.0 + 3, 1e-14);
}

}  // namespace
}  // namespace karcher
