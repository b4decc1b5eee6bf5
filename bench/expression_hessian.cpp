/// \file
/// Hessians of densities that are formulas of a problem file beside those of the same densities compiled: harmonic maps into S^2 and nematic liquid crystals on P2
/// triangles, projection rule, in the same run. Counter time_per_element: seconds of thread CPU time, a low quantile over the repetitions.

#include <benchmark/benchmark.h>

#include "app/density.hpp"
#include "assembly/map_problem.hpp"
#include "karcher/manifold/sphere.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using karcher::testing::MapProblem;

const std::vector<std::string> gradient_let{"g = (u[0].x^2 + u[0].y^2 + u[0].z^2 + u[1].x^2 + u[1].y^2 + u[1].z^2 + u[2].x^2 + u[2].y^2 + u[2].z^2)"};
const std::vector<std::string> frank_oseen_let{"c0 = u[2].y - u[1].z", "c1 = u[0].z - u[2].x", "c2 = u[1].x - u[0].y"};
const char* const frank_oseen =
    "1.2/2*(u[0].x + u[1].y + u[2].z)^2 + 0.7/2*(u[0]*c0 + u[1]*c1 + u[2]*c2)^2"
    "+ 1.9/2*((u[1]*c2 - u[2]*c1)^2 + (u[2]*c0 - u[0]*c2)^2 + (u[0]*c1 - u[1]*c0)^2) - 0.8/2*(0.3*u[0] - 1.1*u[1] + 0.6*u[2])^2";

MapProblem problem() {
  MapProblem p(karcher::testing::moved_mesh("rectangle", {{"cells", {8, 4}}, {"order", {1}}}, "triangle", 0.02, 2), manifold_ops<Sphere<2>>(),
               Rule::projection, 2);
  p.set_random({0, 0, 1}, 0.3);
  p.input.parameters = {{"scale", 1.0}, {"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.8}, {"H[0]", 0.3}, {"H[1]", -1.1}, {"H[2]", 0.6}};
  return p;
}

void measure(benchmark::State& state, const MapProblem& p) {
  const Term& term = *p.functional->terms().front();
  BatchResult out;
  out.gradient.resize(12 * native_width);
  out.hessian.resize(144 * native_width);
  const double seconds = least_time(state, [&] {
    for (int b = 0; b < term.batch_count(); ++b) term.evaluate(p.u, b, Want::hessian, out);
    benchmark::ClobberMemory();
  });
  state.counters["time_per_element"] = seconds / static_cast<double>(p.input.region.cells.size());
}

void compiled(benchmark::State& state, const std::string& type) {
  MapProblem p = problem();
  p.make(type);
  measure(state, p);
}

void formula(benchmark::State& state, const std::vector<std::string>& let, const std::string& density) {
  MapProblem p = problem();
  std::vector<app::Density::Text> definitions;
  for (const std::string& d : let) definitions.push_back({"let", app::Value::of(d)});
  const app::Density written(app::Scope(), {{"u", &p.manifold()}}, {}, definitions, {"density", app::Value::of(density)});
  p.input.formula = std::make_shared<const DensityFormula>(written.formula(2));
  p.make("expression");
  measure(state, p);
}

BENCHMARK_CAPTURE(compiled, harmonic, "harmonic")->Name("expression_hessian/harmonic/compiled");
BENCHMARK_CAPTURE(formula, harmonic, gradient_let, "g/2")->Name("expression_hessian/harmonic/formula");
BENCHMARK_CAPTURE(compiled, frank_oseen, "frank-oseen")->Name("expression_hessian/frank-oseen/compiled");
BENCHMARK_CAPTURE(formula, frank_oseen, frank_oseen_let, frank_oseen)->Name("expression_hessian/frank-oseen/formula");

}  // namespace
}  // namespace karcher::bench
