#include "solve/evaluator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "karcher/solve/norm.hpp"
#include "solve/cell_functions.hpp"
#include "solve/few_unknowns.hpp"
#include "solve/tuning.hpp"

namespace karcher {
namespace {

using testing::Local;
using testing::Local2;
using testing::OneUnknown;
using testing::SmallProblem;
using testing::TwoUnknowns;
using testing::unit;

struct Setting {
  Exchange exchange;
  std::vector<char> fixed;
  std::vector<double> mass;
  WorkCounts work;
  PhaseSeconds phases;
  Evaluator evaluator;
  explicit Setting(SmallProblem& p)
      : exchange(*p.layout),
        fixed(flags(*p.layout)),
        mass(step_mass(*p.layout)),
        evaluator(*p.functional, exchange, fixed, mass, default_tuning.noise, work, phases) {}
  static std::vector<char> flags(const Layout& layout) {
    std::vector<char> f;
    for (int d = 0; d < layout.local_dofs(); ++d) f.push_back(layout.fixed(d));
    return f;
  }
};

TEST(Evaluator, GivesTheDualNormOfTheGradientOnFreeUnknowns) {
  TwoUnknowns p([](double a, double b) { return Local2{a - 2 * b, 3, 4, 0, 0, 0}; }, 1, 1);
  Setting s(p);
  Iterate x;
  x.u = p.u;
  s.evaluator.gradient(x);
  EXPECT_NEAR(x.gradient_norm, 5 / unit, 1e-15);
  EXPECT_EQ(x.energy, -1);
  EXPECT_EQ(x.terms, std::vector<double>{-1});
  EXPECT_EQ(x.noise, 4e-15);
  EXPECT_EQ(s.work.gradients, 1);
  // A fixed unknown has no gradient.
  OneUnknown q([](double at) { return Local{at, 2, 0}; }, 1);
  Setting t(q);
  Iterate y;
  y.u = q.u;
  t.evaluator.gradient(y);
  EXPECT_NEAR(y.gradient_norm, 2 / unit, 1e-15);
}

TEST(Evaluator, TellsAllRanksOfAFailure) {
  OneUnknown p([](double) { return Local{INFINITY, 0, 0}; });
  Setting s(p);
  Iterate x;
  x.u = p.u;
  s.evaluator.energy(x);
  EXPECT_NE(x.failure.find("test-term in the cell around (0.5, 0, 0)"), std::string::npos) << x.failure;
  EXPECT_EQ(x.energy, INFINITY);
  EXPECT_FALSE(x.ok());
}

TEST(Evaluator, AGradientWhoseSquareOverflowsIsAFailureThatNamesItsPlace) {
  for (double slope : {1e155, -1e300}) {
    TwoUnknowns p([=](double, double) { return Local2{0, 3, slope, 0, 0, 0}; });
    Setting s(p);
    Iterate x;
    x.u = p.u;
    s.evaluator.gradient(x);
    EXPECT_NE(x.failure.find("too large to be squared"), std::string::npos) << x.failure;
    EXPECT_NE(x.failure.find(slope > 0 ? "1e+155 at the node (1, 0, 0) of the field \"u\"" : "-1e+300 at the node (1, 0, 0)"), std::string::npos)
        << x.failure;
    EXPECT_EQ(x.energy, INFINITY);
    EXPECT_EQ(x.gradient_norm, INFINITY);
  }
  TwoUnknowns p([](double, double) { return Local2{0, 3, 1e150, 0, 0, 0}; });
  Setting s(p);
  Iterate x;
  x.u = p.u;
  s.evaluator.gradient(x);
  EXPECT_TRUE(x.ok()) << x.failure;
  EXPECT_NEAR(x.gradient_norm, 1e150 / unit, 1e136);
}

TEST(Evaluator, TheProximalTermIsTheSquaredDistanceToItsCentreWithTheLumpedMass) {
  // On the sphere from e1: nodes at angles 0.3 and 0.5 on the equator; lumped masses 1/2 each.
  const auto nothing = [](const std::vector<const double*>&, const Vec3<double>&, double, double*, double*) { return testing::CellValue{}; };
  const auto at = [](double angle) { return std::vector<double>{std::cos(angle), std::sin(angle), 0}; };
  std::vector<double> initial = at(0.3), other = at(0.5);
  initial.insert(initial.end(), other.begin(), other.end());
  SmallProblem p(1, manifold_by_name("S2"), nothing, initial), centre(1, manifold_by_name("S2"), nothing, {1, 0, 0, 1, 0, 0});
  Setting s(p);
  const double tau = 0.2;
  s.evaluator.set_proximal(centre.u, tau);
  Iterate x;
  x.u = p.u;
  BlockMatrix h = p.functional->make_matrix();
  s.evaluator.hessian(x, h);
  EXPECT_NEAR(x.energy, (0.3 * 0.3 + 0.5 * 0.5) * 0.5 / (2 * tau), 1e-14);
  // The gradient at a node is m / tau times its distance, the Hessian m / tau up to curvature; |g|_* divides by the mass 1/2 of the norm.
  EXPECT_NEAR(x.gradient_norm, std::sqrt((0.3 * 0.3 + 0.5 * 0.5) / 0.5) * 0.5 / tau, 1e-14);
  for (int node : p.layout->local_nodes(0)) {
    if (!p.layout->owns(0, node)) continue;
    const auto first = static_cast<std::size_t>(p.layout->first_dof(0, node));
    const double angle = p.field.space->position(node)[0] < 0.5 ? 0.3 : 0.5;
    double frame[6];
    const double place[] = {std::cos(angle), std::sin(angle), 0};
    p.field.manifold->frame(place, frame);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(x.g[first + k], 0.5 / tau * angle * (-place[1] * frame[k] + place[0] * frame[2 + k]), 1e-14);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<std::size_t>(h.row_begin[first / 2]);
      EXPECT_NEAR(h.values[row * 4 + k * 3], 0.5 / tau, 1e-14);
    }
  }
  s.evaluator.set_proximal(centre.u, 0);
  s.evaluator.energy(x);
  EXPECT_EQ(x.energy, 0);
}

}  // namespace
}  // namespace karcher
