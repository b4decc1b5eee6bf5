/// \file
/// The element kernels of the Cosserat shell on random curved P2 triangles with 7 quadrature points, against ADOL-C on the same elements, and the
/// assembly of
/// a whole mesh. Counter time_per_element: seconds of thread CPU time, a low quantile over the repetitions.
///
/// ADOL-C's side is written to its advantage: the energy is taped in the 36 tangent coordinates (not in the 42 coordinates of the nodal values),
/// geometry and
/// constants are passive doubles, value and derivative of the polar factor share one iteration, and hessian2 is its vector mode, the fastest driver
/// here. As
/// the branches of the energy depend on the point, every evaluation tapes anew; taping is about a twentieth of the time.

#include <benchmark/benchmark.h>

#include <cmath>

#include "assembly/shell_adolc.hpp"
#include "assembly/shell_geodesic.hpp"
#include "assembly/shell_kernel_impl.hpp"
#include "assembly/shell_projection.hpp"
#include "counted.hpp"
#include "karcher/assembly/functional.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/mesh/generators.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using shell_oracle::Element;
using shell_oracle::Lanes;

constexpr int batches = 8;

const std::vector<Element>& elements(Rule rule) {
  static std::map<Rule, std::vector<Element>> all;
  std::vector<Element>& list = all[rule];
  if (list.empty()) {
    std::mt19937 generator(2024);
    for (int i = 0; i < batches * 8; ++i) {  // the same for every width of the packs
      list.push_back(shell_oracle::random_element(CellKind::triangle, 2, 2, generator));
      list.back().rule = rule;
    }
  }
  return list;
}

/// Additions, multiplications, divisions and roots for one element.
template <template <class> class RotationRule, Want want>
long operations(const Element& e) {
  const Lanes lanes({e});
  const auto first_lane = [](const AlignedVector<double>& x) {
    std::vector<double> y;
    for (std::size_t i = 0; i < x.size(); i += native_width) y.push_back(x[i]);
    return y;
  };
  const auto points = first_lane(lanes.points), m = first_lane(lanes.m), q = first_lane(lanes.q);
  const auto n = static_cast<std::size_t>(e.unknowns());
  std::vector<double> gradient(n), hessian(n * n);
  double energy = 0;
  Trouble trouble = Trouble::none;
  Counted::reset();
  shell::evaluate_batch<Counted, RotationRule, want>(e.tables, points.data(), m.data(), q.data(),
                                                     {&energy, &trouble, gradient.data(), hessian.data()});
  return Counted::operations();
}

/// Largest difference of the kernel's Hessian from ADOL-C's, relative to its largest entry.
double difference_from_adolc(const std::vector<Element>& list) {
  const Element& e = list.front();
  const auto d = shell_oracle::by_adolc(e);
  const BatchResult k = shell_oracle::evaluate(e, Lanes({e}), Want::hessian);
  const auto n = static_cast<std::size_t>(e.unknowns());
  double largest = 0, difference = 0;
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = r; c < n; ++c) {
      largest = std::max(largest, std::fabs(d.hessian[c][r]));
      difference = std::max(difference, std::fabs(d.hessian[c][r] - k.hessian[(r * n + c) * native_width]));
    }
  return difference / largest;
}

template <Rule rule, template <class> class RotationRule, Want want>
void kernel(benchmark::State& state) {
  const auto& list = elements(rule);
  if (want == Want::hessian && !(difference_from_adolc(list) < 1e-10)) {
    state.SkipWithError("The kernel and ADOL-C do not agree.");
    return;
  }
  std::vector<Lanes> lanes;
  for (std::size_t i = 0; i < list.size(); i += native_width)
    lanes.emplace_back(
        std::vector<Element>(list.begin() + static_cast<std::ptrdiff_t>(i), list.begin() + static_cast<std::ptrdiff_t>(i + native_width)));
  const auto n = static_cast<std::size_t>(list.front().unknowns());
  BatchResult out;
  out.gradient.resize(n * native_width);
  out.hessian.resize(n * n * native_width);
  const shell::Output where{out.energy.data(), out.trouble.data(), out.gradient.data(), out.hessian.data()};
  const shell::Kernel run = shell::kernel(rule, want);
  const double seconds = least_time(
      state,
      [&] {
        for (const Lanes& l : lanes) run(list.front().tables, l.points.data(), l.m.data(), l.q.data(), where);
        benchmark::ClobberMemory();
      },
      want == Want::hessian ? 4 : 20);
  const double per_element = seconds / static_cast<double>(list.size());
  const auto count = static_cast<double>(operations<RotationRule, want>(list.front()));
  state.counters["time_per_element"] = per_element;
  state.counters["flop_per_element"] = count;
  state.counters["share_of_peak"] = count / per_element / fma_peak();
}

template <Rule rule>
void adolc(benchmark::State& state) {
  const auto& list = elements(rule);
  std::size_t next = 0;
  state.counters["time_per_element"] = least_time(state, [&] { benchmark::DoNotOptimize(shell_oracle::by_adolc(list[next++ % list.size()])); });
}

BENCHMARK(kernel<Rule::projection, shell::ProjectionRule, Want::hessian>)->Name("shell_hessian/karcher");
BENCHMARK(adolc<Rule::projection>)->Name("shell_hessian/adolc")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Rule::projection, shell::ProjectionRule, Want::gradient>)->Name("shell_gradient/karcher");
BENCHMARK(kernel<Rule::projection, shell::ProjectionRule, Want::energy>)->Name("shell_energy/karcher");
BENCHMARK(kernel<Rule::geodesic, shell::GeodesicRule, Want::hessian>)->Name("shell_hessian_geodesic/karcher");
BENCHMARK(adolc<Rule::geodesic>)->Name("shell_hessian_geodesic/adolc")->Unit(benchmark::kMillisecond);
BENCHMARK(kernel<Rule::geodesic, shell::GeodesicRule, Want::gradient>)->Name("shell_gradient_geodesic/karcher");
BENCHMARK(kernel<Rule::geodesic, shell::GeodesicRule, Want::energy>)->Name("shell_energy_geodesic/karcher");

/// A Klein bottle of P2 triangles with its layout and matrix.
struct Bottle {
  std::vector<Field> fields;
  Configuration u;
  std::shared_ptr<Layout> layout;
  std::unique_ptr<Functional> functional;
  std::size_t cells = 0;

  Bottle() {
    auto mesh = std::make_shared<Mesh>(generate({"klein-bottle", {{"order", {2}}, {"cells", {48, 32}}}, {{"shape", "triangle"}}}));
    cells = mesh->cells.size();
    TermInput input;
    input.mesh = mesh;
    input.region = mesh->region("all");
    fields = {{"m", &manifold_ops<Euclidean<3>>(), Rule::projection, std::make_shared<Space>(mesh, input.region, 2)},
              {"R", &manifold_ops<Rotation>(), Rule::projection, std::make_shared<Space>(mesh, input.region, 2)}};
    input.all_fields = fields;
    input.fields = {0, 1};
    input.parameters = {{"thickness", 0.02}, {"mu", 1.0}, {"lambda", 1.0}, {"mu_c", 1.0}, {"L_c", 1e-3}, {"b[0]", 1.0}, {"b[1]", 1.0}, {"b[2]", 1.0}};
    std::mt19937 generator(1);
    std::normal_distribution<double> normal;
    u.values.resize(2);
    std::vector<std::vector<char>> fixed(2);
    for (std::size_t f = 0; f < 2; ++f) fixed[f].assign(static_cast<std::size_t>(fields[f].space->node_count()) * 3, 0);
    for (int i = 0; i < fields[0].space->node_count(); ++i)
      for (double x : fields[0].space->position(i).e) u.values[0].push_back(x + 1e-3 * normal(generator));
    for (int i = 0; i < fields[1].space->node_count(); ++i)
      for (double x : shell_oracle::quaternion_of({{0.05 * normal(generator), 0.05 * normal(generator), 0.05 * normal(generator)}}).e)
        u.values[1].push_back(x);
    layout = std::make_shared<Layout>(fields, fixed, CellRanks(mesh->cells.size(), 0), 0, 1);
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(make_term("cosserat-shell", input));
    functional = std::make_unique<Functional>(layout, std::move(terms));
  }
};

/// Kernel and scatter into the global matrix, 6 x 6 blocks.
template <Want want>
void assembly(benchmark::State& state) {
  static Bottle bottle;
  std::vector<double> g(static_cast<std::size_t>(bottle.layout->local_dofs()));
  BlockMatrix h;
  if (want == Want::hessian) h = bottle.functional->make_matrix();
  const double seconds = least_time(state, [&] {
    if constexpr (want == Want::hessian) {
      benchmark::DoNotOptimize(bottle.functional->hessian(bottle.u, g, h));
    } else if constexpr (want == Want::gradient) {
      benchmark::DoNotOptimize(bottle.functional->gradient(bottle.u, g));
    } else {
      benchmark::DoNotOptimize(bottle.functional->energy(bottle.u));
    }
  });
  state.counters["time_per_element"] = seconds / static_cast<double>(bottle.cells);
  state.counters["elements"] = static_cast<double>(bottle.cells);
}
BENCHMARK(assembly<Want::hessian>)->Name("shell_assembly/hessian")->Unit(benchmark::kMillisecond);
BENCHMARK(assembly<Want::gradient>)->Name("shell_assembly/gradient")->Unit(benchmark::kMillisecond);
BENCHMARK(assembly<Want::energy>)->Name("shell_assembly/energy")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace karcher::bench
