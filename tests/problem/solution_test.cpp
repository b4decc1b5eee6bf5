// Problems that C++ code states: fields of any manifolds, densities over them, data as functions, load steps, files.
#include "karcher/problem/solution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "karcher/io/atomic_file.hpp"
#include "karcher/io/summary.hpp"
#include "karcher/karcher.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

std::string refusal(const Problem& problem) {
  try {
    solve(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

struct HalfSquare {
  template <class Jet>
  auto operator()(const Jet& u) const {
    return 0.5 * norm2(u.d[0]);
  }
};

/// A string on [0, 1] whose right end is pulled to t.
Problem pulled_string() {
  Problem p(generate({"interval", {{"cells", {7}}}, {}}), "string");
  const auto u = p.field<Euclidean<1>>("u", {.order = 2}, [](const Vec3<double>&) { return Vec<double, 1>{}; });
  p.add(integral<1>(HalfSquare{}, u));
  p.fix(u, "left");
  p.prescribe(u, "right", [](const MeshPoint&, double t) { return Vec<double, 1>{{t}}; });
  p.continuation.steps = 4;
  return p;
}

TEST(Solution, FollowsBoundaryDataThroughTheLoadSteps) {
  const Solution s = solve(pulled_string());
  ASSERT_TRUE(s.converged());
  ASSERT_EQ(s.states().size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const double t = 0.25 * static_cast<double>(k);
    EXPECT_EQ(s.states()[k].t, t);
    for (int node = 0; node < s.fields()[0].space->node_count(); ++node)
      EXPECT_NEAR(*s.states()[k].at(0, node, 1), t * s.fields()[0].space->position(node)[0], 1e-12);
    EXPECT_NEAR(k > 0 ? s.report().steps[k - 1].energy : 0.0, 0.5 * t * t, 1e-12);
  }
  EXPECT_NEAR(s.at(FieldOf<Euclidean<1>>{}, {{0.3, 0, 0}})[0], 0.3, 1e-12);
}

TEST(Solution, OfADeadLoadIsTheParabola) {
  Problem p(generate({"interval", {{"cells", {4}}}, {}}));
  const auto u = p.field<Euclidean<1>>("u", {.order = 2}, [](const Vec3<double>&) { return Vec<double, 1>{}; });
  p.add(integral<1>(HalfSquare{}, u));
  p.add(load(u, "all", [](const Vec3<double>&, double t) { return Vec<double, 1>{{8 * t}}; }));
  p.add(load(u, "middle", [](const Vec3<double>&, double t) { return Vec<double, 1>{{2 * t}}; }));
  p.regions.push_back({.name = "middle", .dim = 0, .where = [](const Vec3<double>& x) { return std::fabs(x[0] - 0.5) < 1e-9; }});
  p.fix(u, "boundary");
  const Solution s = solve(p);
  // -u'' = 8 + 2 delta(x - 1/2): u = 4 x (1 - x) + min(x, 1 - x)
  for (const double x : {0.25, 0.5, 0.8}) EXPECT_NEAR(s.at(u, {{x, 0, 0}})[0], 4 * x * (1 - x) + std::min(x, 1 - x), 1e-12) << x;
}

TEST(Solution, OfAMapIsThatOfTheFrontDoorForOneField) {
  const Mesh mesh = generate({"rectangle", {{"cells", {6, 6}}, {"lower", {-1, -1}}, {"size", {2, 2}}}, {{"shape", "quadrilateral"}}});
  const auto start = [](const Vec3<double>& x) {
    const double bump = (1 - x[0] * x[0]) * (1 - x[1] * x[1]);
    return Sphere<2>::project(Vec3<double>{{2 * x[0] + bump, 2 * x[1], norm2(x) - 1}});
  };
  const GeometricSpace<Sphere<2>, 2> space(mesh, 2);
  auto v = space.interpolate(start);
  v.fix("boundary");
  const StepReport expected = minimize(integral(space, Harmonic<double>{1.0}), v, {.gradient_tolerance = 1e-10});

  Problem p(mesh);
  const auto u = p.field<Sphere<2>>("u", {.order = 2}, start);
  p.add(integral<2>(Harmonic<double>{1.0}, u));
  p.fix(u, "boundary");
  const Solution s = solve(p, {}, {.gradient_tolerance = 1e-10});
  EXPECT_TRUE(s.converged());
  EXPECT_EQ(s.report().steps.back().energy, expected.energy);
  EXPECT_EQ(s.states().back().values, v.values().values);
}

struct Telling : HalfSquare {
  static std::vector<QuantityInfo> quantity_infos() { return {{"slope", "1", 1, "slope of the string"}}; }
  template <class Jet>
  auto quantities(const Jet& u) const {
    return std::array{u.d[0][0]};
  }
};

TEST(Solution, WritesWhatADensityTellsBesidesItsEnergy) {
  const TemporaryDirectory directory;
  Problem p = pulled_string();
  p.terms = {integral<1>(Telling{}, FieldOf<Euclidean<1>>{})};
  const Solution s = solve(p);
  const auto& term = *s.functional().terms().front();
  ASSERT_EQ(term.info().quantities.size(), 1u);
  for (int b = 0; b < term.batch_count(); ++b)
    for (int lane = 0; lane < term.batch(b).cells_used; ++lane)
      EXPECT_NEAR(term.batch_quantities(s.states().back(), b)[0][static_cast<std::size_t>(lane)], 1, 1e-12);
  s.save(directory.path());
  EXPECT_NE(read_whole(directory / "solution_0004.vtu").find("slope.integral"), std::string::npos);
}

TEST(Solution, WritesWhatTheProgramWrites) {
  const TemporaryDirectory directory;
  Problem p = pulled_string();
  p.probe("middle", FieldOf<Euclidean<1>>{}, {{0.5, 0, 0}});
  const Solution s = solve(p);
  s.save(directory.path());
  const Summary summary = read_summary(directory / "summary.json");
  EXPECT_EQ(summary.title, "string");
  EXPECT_EQ(summary.status, Status::converged);
  ASSERT_EQ(summary.load_steps.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(summary.load_steps[k].energy, s.report().steps[k].energy);
    EXPECT_NEAR(summary.load_steps[k].probes.at("middle")[0], 0.125 * static_cast<double>(k + 1), 1e-12);
  }
  for (const char* file : {"solution.pvd", "solution_0000.vtu", "solution_0004.vtu", "report.html", "iterations.csv"})
    EXPECT_TRUE(std::filesystem::exists(directory / file)) << file;
}

TEST(Solution, GivesInitialValuesTheNormalOfTheSurface) {
  const double r = 1.5;
  Problem p(generate({"sphere", {{"cells", {6}}, {"order", {3}}, {"radius", {r}}}, {}}));
  const auto n = p.field<Sphere<2>>("n", {.order = 2}, [](const MeshPoint& s) { return s.normal; });
  p.add(integral<2>(Harmonic<double>{1.0}, n));
  p.solver.max_iterations = 0;
  const Solution s = solve(p);
  const Configuration& u = s.states().front();
  double side = 0;
  for (int node = 0; node < s.fields()[0].space->node_count(); ++node) {
    const Vec3<double>& x = s.fields()[0].space->position(node);
    const double* v = u.at(0, node, 3);
    const double along = (v[0] * x[0] + v[1] * x[1] + v[2] * x[2]) / r;
    if (side == 0) side = along > 0 ? 1 : -1;
    EXPECT_NEAR(side * along, 1, 1e-3) << node;
  }
}

TEST(Solution, RefusesWhatMakesNoSenseWithASentence) {
  Problem unused = pulled_string();
  unused.field<Sphere<2>>("n");
  EXPECT_EQ(refusal(unused), "no energy uses the field \"n\".");

  Problem nothing(generate({"interval", {}, {}}));
  nothing.field<Euclidean<1>>("u");
  EXPECT_EQ(refusal(nothing), "there are no energies, so there is nothing to minimise.");

  Problem nowhere = pulled_string();
  nowhere.fix(FieldOf<Euclidean<1>>{}, "lft");
  EXPECT_NE(refusal(nowhere).find("Did you mean \"left\"?"), std::string::npos) << refusal(nowhere);

  Problem no_point(generate({"interval", {{"cells", {3}}}, {}}));
  const auto n = no_point.field<Sphere<2>>("n", {}, [](const Vec3<double>&) { return Vec3<double>{}; });
  no_point.add(integral<1>(Harmonic<double>{1.0}, n));
  EXPECT_EQ(refusal(no_point), "The value at (0, 0, 0) is no point of S2.");

  Problem other_dimension(generate({"rectangle", {{"cells", {2, 2}}}, {}}));
  const auto u = other_dimension.field<Euclidean<1>>("u");
  other_dimension.add(integral<1>(HalfSquare{}, u));
  EXPECT_NE(refusal(other_dimension).find("is an integral over a region of dimension 1, but \"all\" has dimension 2."), std::string::npos)
      << refusal(other_dimension);

  Problem conflict = pulled_string();
  conflict.prescribe(FieldOf<Euclidean<1>>{}, "left", [](const MeshPoint&, double) { return Vec<double, 1>{{0.5}}; });
  EXPECT_NE(refusal(conflict).find("give the field \"u\" different values at (0, 0, 0)"), std::string::npos) << refusal(conflict);
}

}  // namespace
}  // namespace karcher
