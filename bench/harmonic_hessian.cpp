/// \file
/// Hessians of harmonic maps into S^2 and SO(3) on P2 triangles, by the generic kernel and by ADOL-C on the same elements in the same run. Counter
/// time_per_element: seconds of thread CPU time, a low quantile over the repetitions; both sides use the default quadrature of the energy (16 points).

#include <benchmark/benchmark.h>

#include <cmath>

#include "assembly/adolc.hpp"
#include "assembly/density_oracle.hpp"
#include "assembly/map_problem.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using karcher::testing::MapProblem;

constexpr int degree = 8;

template <class M>
const MapProblem& problem(Rule rule) {
  static std::map<Rule, std::unique_ptr<MapProblem>> all;
  auto& p = all[rule];
  if (!p) {
    p = std::make_unique<MapProblem>(karcher::testing::moved_mesh("rectangle", {{"cells", {8, 4}}, {"order", {1}}}, "triangle", 0.02, 2),
                                     manifold_ops<M>(), rule, 2);
    const auto origin = M::origin();
    p->set_random({origin.e.begin(), origin.e.end()}, 0.3);
    p->input.parameters["scale"] = 1.0;
    p->make("harmonic");
  }
  return *p;
}

template <class M>
density_oracle::Element<2> element(const MapProblem& p, const Cell& cell) {
  auto e = density_oracle::element<2>(*p.input.mesh, cell, p.space().order(), degree);
  e.rule = p.input.all_fields.front().rule;
  e.dim = M::dim;
  for (int node : p.space().entity_nodes(cell)) {
    const double* x = p.u.at(0, node, M::ambient);
    e.nodes.emplace_back(x, x + M::ambient);
    e.frames.emplace_back(static_cast<std::size_t>(M::ambient * M::dim));
    p.manifold().frame(x, e.frames.back().data());
  }
  return e;
}

template <class G>
adolc::Derivatives by_adolc(const density_oracle::Element<2>& e) {
  return adolc::differentiate(e.unknowns(), [&](const adouble* v) {
    return density_oracle::energy<G, 2, adouble>(
        e, v, [](const auto& u, const auto& d, const Vec3<double>&) { return 0.5 * (G::square(u, d[0]) + G::square(u, d[1])); });
  });
}

BatchResult room_for(std::size_t unknowns) {
  BatchResult out;
  out.gradient.resize(unknowns * native_width);
  out.hessian.resize(unknowns * unknowns * native_width);
  return out;
}

/// Largest difference of the kernel's Hessian from ADOL-C's on the first cell, relative to the largest entry.
template <class M, class G>
double difference_from_adolc(const MapProblem& p) {
  const Term& term = *p.functional->terms().front();
  const auto d = by_adolc<G>(element<M>(p, term.cell(term.batch(0).cells[0])));
  const std::size_t n = d.gradient.size();
  BatchResult out = room_for(n);
  term.evaluate(p.u, 0, Want::hessian, out);
  double largest = 0, difference = 0;
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = r; c < n; ++c) {
      largest = std::max(largest, std::fabs(d.hessian[c][r]));
      difference = std::max(difference, std::fabs(d.hessian[c][r] - out.hessian[(r * n + c) * native_width]));
    }
  return difference / largest;
}

template <class M, class G, Rule rule, bool compared = true>
void kernel(benchmark::State& state) {
  const MapProblem& p = problem<M>(rule);
  if constexpr (compared) {
    if (!(difference_from_adolc<M, G>(p) < 1e-10)) {
      state.SkipWithError("The kernel and ADOL-C do not agree.");
      return;
    }
  }
  const Term& term = *p.functional->terms().front();
  BatchResult out = room_for(6 * M::dim);
  const double seconds = least_time(state, [&] {
    for (int b = 0; b < term.batch_count(); ++b) term.evaluate(p.u, b, Want::hessian, out);
    benchmark::ClobberMemory();
  });
  state.counters["time_per_element"] = seconds / static_cast<double>(p.input.region.cells.size());
}

template <class M, class G, Rule rule>
void by_tape(benchmark::State& state) {
  const MapProblem& p = problem<M>(rule);
  std::vector<density_oracle::Element<2>> elements;
  for (const Cell& cell : p.input.region.cells) elements.push_back(element<M>(p, cell));
  std::size_t next = 0;
  state.counters["time_per_element"] = least_time(state, [&] { benchmark::DoNotOptimize(by_adolc<G>(elements[next++ % elements.size()])); });
}

using OnSphere = density_oracle::UnitVectors<3>;
using OnRotations = density_oracle::Rotations;

BENCHMARK(kernel<Sphere<2>, OnSphere, Rule::projection>)->Name("harmonic_hessian/karcher/S2/projection");
BENCHMARK(by_tape<Sphere<2>, OnSphere, Rule::projection>)->Name("harmonic_hessian/adolc/S2/projection")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Sphere<2>, OnSphere, Rule::geodesic>)->Name("harmonic_hessian/karcher/S2/geodesic");
BENCHMARK(by_tape<Sphere<2>, OnSphere, Rule::geodesic>)->Name("harmonic_hessian/adolc/S2/geodesic")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Rotation, OnRotations, Rule::projection>)->Name("harmonic_hessian/karcher/SO3/projection");
BENCHMARK(by_tape<Rotation, OnRotations, Rule::projection>)->Name("harmonic_hessian/adolc/SO3/projection")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Rotation, OnRotations, Rule::geodesic>)->Name("harmonic_hessian/karcher/SO3/geodesic");
BENCHMARK(by_tape<Rotation, OnRotations, Rule::geodesic>)->Name("harmonic_hessian/adolc/SO3/geodesic")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Spd<3>, void, Rule::geodesic, false>)->Name("harmonic_hessian/karcher/SPD3/geodesic");

}  // namespace
}  // namespace karcher::bench
