#include "solve/path_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "karcher/solve/norm.hpp"
#include "solve/cell_functions.hpp"

namespace karcher {
namespace {

using testing::SmallProblem;

testing::CellValue nothing(const std::vector<const double*>&, const Vec3<double>&, double, double*, double*) { return {}; }

/// What the watch says at the loads t on the path x u(t), x the place on [0, 2].
std::vector<std::string> sentences(const std::vector<double>& loads, const std::function<double(double)>& u) {
  SmallProblem p(2, manifold_by_name("R1"), nothing, {0, 0, 0});
  PathWatch watch(*p.layout, step_mass(*p.layout), default_tuning);
  std::vector<std::string> result;
  for (const double t : loads) {
    p.u.t = t;
    for (const int node : p.layout->local_nodes(0)) p.u.values[0][static_cast<std::size_t>(node)] = p.field.space->position(node)[0] * u(t);
    result.push_back(watch.next(p.u));
  }
  return result;
}
/// The loads at which it speaks.
std::vector<double> told(const std::vector<double>& loads, const std::function<double(double)>& u) {
  const std::vector<std::string> said = sentences(loads, u);
  std::vector<double> result;
  for (std::size_t k = 0; k < loads.size(); ++k)
    if (!said[k].empty()) result.push_back(loads[k]);
  return result;
}

const std::vector<double> even{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

TEST(PathWatch, TellsAJumpOnce) {
  EXPECT_EQ(told(even, [](double t) { return t + 0.05 * t * t + (t > 5.5 ? 40 : 0); }), std::vector<double>{6});
}

TEST(PathWatch, SaysHowFarAndHasWordsForAJumpAfterAStraightPath) {
  const auto bent = sentences(even, [](double t) { return t + 0.05 * t * t + (t > 5.5 ? 40 : 0); });
  EXPECT_NE(bent[6].find("the state is 401 times as far from where the load steps before point as any of theirs was."), std::string::npos) << bent[6];
  const auto straight = sentences(even, [](double t) { return 2 * t + (t > 5.5 ? 64 : 0); });
  EXPECT_NE(straight[6].find("the state is not where the load steps before, on a straight path, point."), std::string::npos) << straight[6];
}

TEST(PathWatch, IsSilentWhereALoadSetsInAfterSomeLoadSteps) {
  EXPECT_TRUE(told(even, [](double t) { return std::max(t - 3, 0.0); }).empty());
}

TEST(PathWatch, TellsEveryOfTwoJumps) {
  EXPECT_EQ(told(even, [](double t) { return t + 0.05 * t * t + (t > 3.5 ? 40 : 0) + (t > 7.5 ? 40 : 0); }), (std::vector<double>{4, 8}));
}

TEST(PathWatch, IsSilentOnSmoothPathsThatBend) {
  EXPECT_TRUE(told(even, [](double t) { return 3 * t; }).empty());
  EXPECT_TRUE(told(even, [](double t) { return std::sin(t); }).empty());
  EXPECT_TRUE(told(even, [](double t) { return std::exp(0.5 * t); }).empty());
  EXPECT_TRUE(told(even, [](double t) { return std::sqrt(11 - t); }).empty());  // steep before a limit point
}

TEST(PathWatch, TellsAStateThatIsTenTimesAsFarFromItsExtrapolationAsThoseBefore) {
  // Second differences 1 and then 9 or 11.
  for (const double last : {11.0, 13.0})
    EXPECT_EQ(told({0, 1, 2, 3}, [&](double t) { return t < 1.5 ? 0 : t < 2.5 ? 1 : last; }).size(), last > 12 ? 1u : 0u) << last;
}

TEST(PathWatch, IsSilentWhereLoadStepsAreUneven) {
  EXPECT_TRUE(told({0, 0.1, 0.2, 5.2}, [](double t) { return t * t; }).empty());
  EXPECT_TRUE(told({0, 0.1, 0.2, 1.2, 1.3, 3.3, 3.4, 3.5, 5.5}, [](double t) { return t * t; }).empty());
}

}  // namespace
}  // namespace karcher
