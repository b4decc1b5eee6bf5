#include "solve/boundary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/norm.hpp"
#include "solve/cell_functions.hpp"

namespace karcher {
namespace {

using testing::SmallProblem;

/// Points of the sphere at angles from e1 towards e2, node after node in the order of x.
std::vector<double> on_equator(const std::vector<double>& angles) {
  std::vector<double> values;
  for (const double a : angles) values.insert(values.end(), {std::cos(a), std::sin(a), 0.0});
  return values;
}

testing::CellValue nothing(const std::vector<const double*>&, const Vec3<double>&, double, double*, double*) { return {}; }

/// Fixed tangent components of S^2 on [0, 2], by x and component.
std::vector<char> fixed_at(int cells, const std::function<bool(int x, int component)>& fixed) {
  const auto mesh = testing::line_mesh(cells);
  const Space space(mesh, mesh->regions.at("all"), 1);
  std::vector<char> flags;
  for (int node = 0; node <= cells; ++node)
    for (int k = 0; k < 2; ++k) flags.push_back(fixed(static_cast<int>(space.position(node)[0] + 0.5), k));
  return flags;
}

struct Equator : SmallProblem {
  explicit Equator(const std::function<bool(int, int)>& fixed)
      : SmallProblem(2, manifold_by_name("S2"), nothing, on_equator({0, 0.1, 0.2}), fixed_at(2, fixed)) {}
  Configuration turned(const std::vector<double>& angles) const { return SmallProblem(2, manifold_by_name("S2"), nothing, on_equator(angles)).u; }
  /// f(x, first local dof) at the nodes that this rank sees
  void for_nodes(const std::function<void(int x, std::size_t first)>& f) const {
    for (int node : layout->local_nodes(0))
      f(static_cast<int>(field.space->position(node)[0] + 0.5), static_cast<std::size_t>(layout->first_dof(0, node)));
  }
};

TEST(Boundary, TheIncrementIsTheLogarithmInFixedComponentsOnly) {
  // At x = 0 all is fixed, at 1 the second component, at 2 nothing.
  const Equator p([](int x, int k) { return x == 0 || (x == 1 && k == 1); });
  const Configuration target = p.turned({0.5, 0.8, 0.9});
  const std::vector<double> delta = boundary_increment(*p.layout, p.u, target);
  const ManifoldOps& sphere = *p.field.manifold;
  p.for_nodes([&](int x, std::size_t first) {
    const double angle = x == 0 ? 0.5 : x == 1 ? 0.7 : 0;
    double frame[6];
    const double place[] = {std::cos(0.1 * x), std::sin(0.1 * x), 0};
    sphere.frame(place, frame);
    for (std::size_t k = 0; k < 2; ++k) {
      // log = angle * (-sin, cos, 0) in the frame's columns
      const double expected = angle * (-place[1] * frame[k] + place[0] * frame[2 + k]);
      EXPECT_NEAR(delta[first + k], x == 2 || (x == 1 && k == 0) ? 0 : expected, 1e-15) << x << k;
    }
  });
}

TEST(Boundary, TheUniformNormIsThatOfMovingAllNodesAsFarAsTheFarthest) {
  const Equator p([](int, int) { return true; });
  // The masses of a field of angles sum to 1.
  for (const int farthest : {0, 1, 2}) {
    std::vector<double> s(static_cast<std::size_t>(p.layout->local_dofs()), 0.0);
    p.for_nodes([&](int x, std::size_t first) {
      const double length = x == farthest ? 2 : 1;
      s[first] = 0.3 * length, s[first + 1] = 0.4 * length;
    });
    EXPECT_NEAR(uniform_norm(*p.layout, step_mass(*p.layout), s), 1, 1e-14) << farthest;
  }
}

TEST(Boundary, TheUniformNormCountsLengthsInHalvesOfTheDomainAndAnglesInRadiansAlsoInOneField) {
  const int cells = 8;
  std::vector<double> start;
  for (int i = 0; i <= cells; ++i) start.insert(start.end(), {1.0 * i, 0, 0, 1, 0, 0, 0});
  const SmallProblem p(cells, manifold_ops<Product<Euclidean<3>, Rotation>>(), nothing, start);
  std::vector<double> s(static_cast<std::size_t>(p.layout->local_dofs()), 0.0);
  for (int node : p.layout->local_nodes(0)) {
    const auto first = static_cast<std::size_t>(p.layout->first_dof(0, node));
    s[first + 1] = 2, s[first + 3] = 0.75;
  }
  EXPECT_NEAR(uniform_norm(*p.layout, step_mass(*p.layout), s), std::hypot(2.0 / 4, 0.75), 1e-14);
}

TEST(Boundary, NodesThatAreWhollyFixedGetTheValuesThemselves) {
  Equator p([](int x, int k) { return x == 0 || (x == 1 && k == 1); });
  const Configuration target = p.turned({0.5, 0.8, 0.9});
  std::vector<double> delta = boundary_increment(*p.layout, p.u, target);
  p.for_nodes([&](int x, std::size_t first) {
    if (x == 2) delta[first] = 0.25;  // free components move by the step
  });
  Configuration to = p.u;
  retract_to_boundary(*p.layout, p.u, delta, target, to);
  const ManifoldOps& sphere = *p.field.manifold;
  for (int node : p.layout->local_nodes(0)) {
    const int x = static_cast<int>(p.field.space->position(node)[0] + 0.5);
    double expected[3];
    sphere.retract(p.u.at(0, node, 3), delta.data() + p.layout->first_dof(0, node), expected);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(to.at(0, node, 3)[k], x == 0 ? target.at(0, node, 3)[k] : expected[k]) << x;
  }
  Configuration copied = p.u;
  copy_fixed_nodes(*p.layout, target, copied);
  for (int node : p.layout->local_nodes(0)) {
    const int x = static_cast<int>(p.field.space->position(node)[0] + 0.5);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(copied.at(0, node, 3)[k], (x == 0 ? target : p.u).at(0, node, 3)[k]) << x;
  }
}

}  // namespace
}  // namespace karcher
