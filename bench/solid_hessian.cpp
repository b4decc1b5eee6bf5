/// \file
/// Energies with their derivatives of hyperelastic solids on hexahedra of order 2 with 27 points, by the kernel and by ADOL-C on the same elements in the same run. Counter
/// time_per_element: seconds of thread CPU time, a low quantile over the repetitions.

#include <benchmark/benchmark.h>

#include "assembly/adolc_comparison.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using karcher::testing::MapProblem;

const MapProblem& problem(const std::string& material) {
  static std::map<std::string, std::unique_ptr<MapProblem>> all;
  auto& p = all[material];
  if (!p) {
    p = std::make_unique<MapProblem>(karcher::testing::moved_mesh("box", {{"cells", {4, 4, 4}}, {"order", {1}}}, "hexahedron", 0.02, 3),
                                     manifold_ops<Euclidean<3>>(), Rule::projection, 2);
    karcher::Random random(3);
    for (int i = 0; i < p->space().node_count(); ++i)
      for (const double x : p->space().position(i).e) p->u.values[0].push_back(x + random.uniform(-0.01, 0.01));
    p->input.choices = {{"material", material}, {"normalised", "true"}};
    p->input.parameters = {{"mu", 1.0}, {"lambda", 1.0}, {"k", 0.5}, {"k_hat", 0.5}, {"a", 1.0}, {"b", 1.0}, {"c", 1.0}};
    p->make("hyperelastic");
  }
  return *p;
}

void kernel(benchmark::State& state, const std::string& material, Want want) {
  const MapProblem& p = problem(material);
  const Term& term = *p.functional->terms().front();
  BatchResult out;
  out.gradient.resize(81 * native_width);
  out.hessian.resize(81 * 81 * native_width);
  const double seconds = least_time(state, [&] {
    for (int b = 0; b < term.batch_count(); ++b) term.evaluate(p.u, b, want, out);
    benchmark::ClobberMemory();
  });
  state.counters["time_per_element"] = seconds / static_cast<double>(p.input.region.cells.size());
}

void by_tape(benchmark::State& state) {
  const MapProblem& p = problem("neo-hooke");
  auto e = density_oracle::element<3>(*p.input.mesh, p.input.region.cells[0], 2, 5);
  e.dim = 3;
  for (const int node : p.space().entity_nodes(p.input.region.cells[0])) {
    const double* x = p.u.at(0, node, 3);
    e.nodes.emplace_back(x, x + 3);
    e.frames.emplace_back(std::initializer_list<double>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  }
  const auto density = [](const auto&, const auto& d, const Vec3<double>&) {
    using S = std::decay_t<decltype(d[0][0])>;
    S squares = -3.0, det = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t a = 0; a < 3; ++a) squares += d[a][i] * d[a][i];
      det += d[0][i] * (d[1][(i + 1) % 3] * d[2][(i + 2) % 3] - d[1][(i + 2) % 3] * d[2][(i + 1) % 3]);
    }
    const S log_det = log(det);
    return 0.5 * (squares - 2.0 * log_det) + 0.5 * log_det * log_det;
  };
  state.counters["time_per_element"] = least_time(state, [&] {
    benchmark::DoNotOptimize(adolc::differentiate(
        e.unknowns(), [&](const adouble* v) { return density_oracle::energy<density_oracle::Linear<3>, 3, adouble>(e, v, density); }));
  });
}

const bool registered = [] {
  for (const std::string material : {"neo-hooke", "saint-venant-kirchhoff", "mooney-rivlin", "hencky", "exp-hencky"})
    for (const Want want : {Want::hessian, Want::gradient, Want::energy})
      benchmark::RegisterBenchmark(("solid_" +
                                    std::string(want == Want::hessian    ? "hessian"
                                                : want == Want::gradient ? "gradient"
                                                                         : "energy") +
                                    "/karcher/" + material)
                                       .c_str(),
                                   [=](benchmark::State& state) { kernel(state, material, want); });
  benchmark::RegisterBenchmark("solid_hessian/adolc/neo-hooke", by_tape)->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace karcher::bench
