// Somebody else's program: a law suite for an installed manifold, a mesh, and what PETSc and METIS have to be linked for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/testing/manifold_laws.hpp"
#include "karcher/version.hpp"

KARCHER_MANIFOLD_LAWS(InstalledSphere, karcher::Sphere<2>)

TEST(InstalledLibrary, TellsTheVersionOfItsPackageInWordsAndNumbers) {
  EXPECT_EQ(karcher::version_string, PACKAGE_VERSION);
  const auto text = [](int number) { return std::to_string(number); };
  EXPECT_EQ(karcher::version_string, text(karcher::version_major) + "." + text(karcher::version_minor) + "." + text(karcher::version_patch));
}

TEST(InstalledLibrary, StartsPetscOnOneRank) { EXPECT_EQ(karcher::world_size(), 1); }

TEST(InstalledLibrary, PartitionsAMesh) {
  karcher::GeneratorOptions options;
  options.name = "interval";
  options.numbers = {{"cells", {10}}};
  const std::vector<int> parts = karcher::partition_cells(karcher::generate(options), 2);
  EXPECT_EQ(std::count(parts.begin(), parts.end(), 0), 5);
}

TEST(InstalledLibrary, MeshOfASphereHasItsArea) {
  karcher::GeneratorOptions options;
  options.name = "sphere";
  options.numbers = {{"radius", {2.0}}, {"cells", {4}}, {"order", {2}}};
  const karcher::Mesh mesh = karcher::generate(options);
  double area = 0;
  for (const karcher::Cell& cell : mesh.cells) {
    const karcher::Quadrature& rule = karcher::quadrature(cell.kind, 6);
    for (std::size_t k = 0; k < rule.weights.size(); ++k) {
      const karcher::GeometryJet jet = karcher::geometry(mesh, cell, rule.points[k]);
      area += rule.weights[k] * std::sqrt(karcher::norm2(karcher::cross(jet.d[0], jet.d[1])));
    }
  }
  EXPECT_NEAR(area, 16 * std::numbers::pi, 1e-3 * 16 * std::numbers::pi);
}
