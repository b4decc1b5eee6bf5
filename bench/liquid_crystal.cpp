/// \file
/// Assembly of a liquid crystal in a box on one core: energy, gradient and Hessian of frank-oseen on hexahedra (second order; first order beside it), scattered
/// into the global matrix. Counters: seconds of thread CPU time for one assembly, a low quantile over the repetitions, and the number of unknowns.

#include <benchmark/benchmark.h>

#include "assembly/map_problem.hpp"
#include "karcher/manifold/sphere.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using karcher::testing::MapProblem;

template <Rule rule, int order>
void assembly(benchmark::State& state) {
  constexpr double cells = order == 1 ? 46 : 23;  // 47^3 nodes, two unknowns each
  MapProblem p(karcher::testing::moved_mesh("box", {{"cells", {cells, cells, cells}}}, "hexahedron"), manifold_ops<Sphere<2>>(), rule, order);
  p.set_random({1, 0, 0}, 0.2);
  p.input.parameters = {{"K1", 1.2}, {"K2", 0.7}, {"K3", 1.9}, {"chi", 0.8}, {"H[0]", 0.3}, {"H[1]", -1.1}, {"H[2]", 0.6}};
  p.make("frank-oseen");
  std::vector<double> g(p.dofs());
  BlockMatrix h = p.functional->make_matrix();
  if (p.functional->hessian(p.u, g, h).failure) {
    state.SkipWithError("The interpolation is not defined.");
    return;
  }
  state.counters["seconds"] = least_time(state, [&] { benchmark::DoNotOptimize(p.functional->hessian(p.u, g, h)); });
  state.counters["unknowns"] = static_cast<double>(p.dofs());
}

BENCHMARK(assembly<Rule::projection, 2>)->Name("liquid_crystal_assembly")->Unit(benchmark::kMillisecond);
BENCHMARK(assembly<Rule::geodesic, 2>)->Name("liquid_crystal_assembly/geodesic")->Unit(benchmark::kMillisecond);
BENCHMARK(assembly<Rule::projection, 1>)->Name("liquid_crystal_assembly/order_1")->Unit(benchmark::kMillisecond);
BENCHMARK(assembly<Rule::geodesic, 1>)->Name("liquid_crystal_assembly/order_1/geodesic")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace karcher::bench
