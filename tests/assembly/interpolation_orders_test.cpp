// Interpolation of smooth maps: error in L2 of the order p + 1, in H1 of the order p.
#include <gtest/gtest.h>

#include "assembly/map_error.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/mesh/generators.hpp"

namespace karcher {
namespace {

struct SmoothRotation {
  template <class S>
  Vec<S, 4> operator()(const Vec<S, 2>& x) const {
    return Rotation::from_rotation_vector(Vec3<S>{{0.8 * x[0] + 0.3 * x[1] * x[1], 0.9 * x[1] - 0.4 * x[0] * x[0] * x[1], 0.5 + 0.7 * x[0] * x[1]}});
  }
};
/// L L^T for a lower triangular matrix function.
struct SmoothTensor {
  template <class S>
  Vec<S, 9> operator()(const Vec<S, 2>& x) const {
    Mat3<S> l;
    l(0, 0) = 1.2 + 0.4 * x[0] + 0.3 * x[1] * x[1];
    l(1, 1) = 1.0 - 0.3 * x[1] + 0.2 * x[0] * x[0];
    l(2, 2) = 0.9 + 0.3 * x[0] * x[1];
    l(1, 0) = 0.5 * x[0] * x[0] - 0.4 * x[1];
    l(2, 0) = 0.3 * x[0] * x[1] * x[1];
    l(2, 1) = 0.4 * x[0] + 0.2 * x[1];
    return Spd<3>::point(l * transpose(l));
  }
};

template <class M, class Map>
void expect_optimal_orders(Rule rule, const Map& map, double cells = 4) {
  for (const std::string shape : {"triangle", "quadrilateral"})
    for (int order : {1, 2, 3}) {
      std::vector<testing::MapError> errors;
      for (double n : {cells, 2 * cells}) {
        const auto mesh =
            std::make_shared<Mesh>(generate({"rectangle", {{"lower", {-1, -1}}, {"size", {2, 2}}, {"cells", {n, n}}}, {{"shape", shape}}}));
        const Field field{"u", &manifold_ops<M>(), rule, std::make_shared<Space>(mesh, mesh->region("all"), order)};
        errors.push_back(testing::error_of(field, testing::nodal_values(*field.space, map), map));
      }
      EXPECT_NEAR(std::log2(errors[0].l2 / errors[1].l2), order + 1, 0.15) << M::name << " " << shape << " " << order;
      EXPECT_NEAR(std::log2(errors[0].h1 / errors[1].h1), order, 0.15) << M::name << " " << shape << " " << order;
    }
}

}  // namespace

TEST(InterpolationOrders, AreOptimalOnTheSphereForBothRules) {
  expect_optimal_orders<Sphere<2>>(Rule::projection, testing::InverseStereographic{}, 6);
  expect_optimal_orders<Sphere<2>>(Rule::geodesic, testing::InverseStereographic{}, 6);
}
TEST(InterpolationOrders, AreOptimalForRotationsForBothRules) {
  expect_optimal_orders<Rotation>(Rule::projection, SmoothRotation{});
  expect_optimal_orders<Rotation>(Rule::geodesic, SmoothRotation{});
}
TEST(InterpolationOrders, AreOptimalForPositiveDefiniteMatrices) { expect_optimal_orders<Spd<3>>(Rule::geodesic, SmoothTensor{}, 3); }

}  // namespace karcher
