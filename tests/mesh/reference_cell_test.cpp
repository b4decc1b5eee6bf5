#include "karcher/mesh/reference_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "karcher/error.hpp"
#include "mesh/cells.hpp"

namespace karcher {
namespace {

TEST(ReferenceCell, NumbersOfNodesAreThoseOfThePolynomialSpaces) {
  for (CellKind kind : all_kinds)
    for (int p = 1; p <= 3; ++p) {
      EXPECT_EQ(node_count(kind, p), static_cast<int>(exponents(kind, p).size())) << name(kind) << p;
      EXPECT_EQ(lagrange_nodes(kind, p).size(), exponents(kind, p).size()) << name(kind) << p;
    }
}

TEST(ReferenceCell, VerticesComeFirstAndEdgesRunFromTheirFirstToTheirSecondVertex) {
  for (CellKind kind : all_kinds)
    for (int p = 2; p <= 3; ++p) {
      const auto& nodes = lagrange_nodes(kind, p);
      auto next = static_cast<std::size_t>(vertex_count(kind));
      for (const auto& [a, b] : edges(kind))
        for (int k = 1; k < p; ++k, ++next) {
          const Vec3<double> expected = nodes[static_cast<std::size_t>(a)] +
                                        (static_cast<double>(k) / p) * (nodes[static_cast<std::size_t>(b)] - nodes[static_cast<std::size_t>(a)]);
          EXPECT_LT(norm2(nodes[next] - expected), 1e-30) << name(kind) << p;
        }
    }
}

TEST(ReferenceCell, InteriorNodesOfAQuadrilateralRunAlongItsFirstCoordinate) {
  const auto& nodes = lagrange_nodes(CellKind::quadrilateral, 3);
  const std::array<std::array<double, 2>, 4> expected = {{{1. / 3, 1. / 3}, {2. / 3, 1. / 3}, {1. / 3, 2. / 3}, {2. / 3, 2. / 3}}};
  for (std::size_t i = 0; i < 4; ++i)
    for (int a = 0; a < 2; ++a) EXPECT_DOUBLE_EQ(nodes[12 + i][a], expected[i][static_cast<std::size_t>(a)]);
}

TEST(ReferenceCell, FacesAreSeenCounterClockwiseFromOutside) {
  for (CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
    const auto& x = lagrange_nodes(kind, 1);
    Vec3<double> centre;
    for (const auto& v : x) centre += (1.0 / static_cast<double>(x.size())) * v;
    for (const ReferenceFace& f : faces(kind)) {
      const auto at = [&](std::size_t i) { return x[static_cast<std::size_t>(f.vertices[i])]; };
      EXPECT_GT(dot(cross(at(1) - at(0), at(2) - at(0)), at(0) - centre), 0.01) << name(kind);
    }
  }
}

TEST(ReferenceCell, EveryEdgeOfASolidLiesInTwoFaces) {
  for (CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron})
    for (const auto& [a, b] : edges(kind)) {
      int count = 0;
      for (const ReferenceFace& f : faces(kind)) {
        const std::set<int> v(f.vertices.begin(), f.vertices.end());
        for (std::size_t i = 0; i < f.vertices.size(); ++i) {
          const int c = f.vertices[i], d = f.vertices[(i + 1) % f.vertices.size()];
          count += (c == a && d == b) || (c == b && d == a);
        }
      }
      EXPECT_EQ(count, 2) << name(kind);
    }
}

TEST(ReferenceCell, NodesOfAFacetLieWhereTheFacetsOwnNodesAre) {
  for (CellKind kind : all_kinds)
    for (int p = 1; p <= 3; ++p)
      for (std::size_t f = 0; f < facets(kind).size(); ++f) {
        const ReferenceFace& facet = facets(kind)[f];
        const auto& in_cell = lagrange_nodes(kind, p);
        const auto& in_facet = lagrange_nodes(facet.kind, p);
        const auto& numbers = facet_nodes(kind, p, static_cast<int>(f));
        ASSERT_EQ(numbers.size(), in_facet.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
          const Shape corner = lagrange(facet.kind, 1, in_facet[i]);
          Vec3<double> expected;
          for (std::size_t v = 0; v < facet.vertices.size(); ++v) expected += corner.value[v] * in_cell[static_cast<std::size_t>(facet.vertices[v])];
          EXPECT_LT(norm2(in_cell[static_cast<std::size_t>(numbers[i])] - expected), 1e-30) << name(kind) << p;
        }
      }
}

TEST(Lagrange, FunctionsAreOneAtTheirNodeAndZeroAtAllOthers) {
  for (CellKind kind : all_kinds)
    for (int p = 1; p <= 3; ++p) {
      const auto& nodes = lagrange_nodes(kind, p);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Shape shape = lagrange(kind, p, nodes[i]);
        for (std::size_t j = 0; j < nodes.size(); ++j) EXPECT_NEAR(shape.value[j], i == j ? 1.0 : 0.0, 1e-14) << name(kind) << p;
      }
    }
}

double power(double x, int n) { return n < 0 ? 0.0 : std::pow(x, n); }

TEST(Lagrange, ReproducesPolynomialsWithTheirFirstAndSecondDerivatives) {
  std::mt19937 random(1);
  constexpr std::array<std::array<std::size_t, 2>, 6> pairs = {{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
  for (CellKind kind : all_kinds)
    for (int p = 1; p <= 3; ++p)
      for (const auto& e : exponents(kind, p)) {
        const auto monomial = [&](const Vec3<double>& x, std::array<int, 3> derivative) {
          double value = 1;
          for (std::size_t i = 0; i < 3; ++i) {
            int n = e[i];
            for (int k = 0; k < derivative[i]; ++k, --n) value *= n;
            value *= power(x[static_cast<int>(i)], n);
          }
          return value;
        };
        const Vec3<double> x = random_point(kind, random);
        const Shape shape = lagrange(kind, p, x);
        double value = 0;
        std::array<double, 3> gradient{};
        std::array<double, 6> hessian{};
        for (std::size_t i = 0; i < shape.value.size(); ++i) {
          const double nodal = monomial(lagrange_nodes(kind, p)[i], {0, 0, 0});
          value += shape.value[i] * nodal;
          for (std::size_t a = 0; a < 3; ++a) gradient[a] += shape.gradient[i][a] * nodal;
          for (std::size_t a = 0; a < 6; ++a) hessian[a] += shape.hessian[i][a] * nodal;
        }
        EXPECT_NEAR(value, monomial(x, {0, 0, 0}), 1e-13);
        for (std::size_t a = 0; a < 3; ++a) {
          std::array<int, 3> d{};
          ++d[a];
          EXPECT_NEAR(gradient[a], monomial(x, d), 1e-12) << name(kind) << p;
        }
        for (std::size_t a = 0; a < 6; ++a) {
          std::array<int, 3> d{};
          ++d[pairs[a][0]];
          ++d[pairs[a][1]];
          EXPECT_NEAR(hessian[a], monomial(x, d), 1e-11) << name(kind) << p;
        }
      }
}

TEST(Lagrange, RefusesOrdersBeyondThree) {
  EXPECT_THROW(lagrange(CellKind::triangle, 4, {}), InputError);
  EXPECT_THROW(lagrange(CellKind::hexahedron, 0, {}), InputError);
}

}  // namespace
}  // namespace karcher
