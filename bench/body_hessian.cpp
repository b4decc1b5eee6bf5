/// \file
/// Hessians of rods, plates and Reissner-Mindlin shells on P2 elements, by the generic kernel with closed strains; beside them the shell kernel on the same flat
/// triangles. Counter time_per_element: seconds of thread CPU time, a low quantile over the repetitions, with the default quadrature of each energy.

#include <benchmark/benchmark.h>

#include "assembly/body_problem.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/sphere.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

using karcher::testing::BodyProblem;

void kernel(benchmark::State& state, const std::string& type, Rule rule) {
  const bool rod = type == "cosserat-rod", director = type == "reissner-mindlin";
  GeneratorOptions options{rod ? "interval" : "rectangle", {}, {}};
  if (rod) {
    options.numbers["cells"] = {64};
    options.words["axis"] = "z";
  } else {
    options.numbers["cells"] = {8, 4};
    options.words["shape"] = "triangle";
  }
  BodyProblem p(std::make_shared<const Mesh>(generate(options)), director ? manifold_ops<Sphere<2>>() : manifold_ops<Rotation>(), rule, 2);
  p.input.parameters = {{"thickness", 0.02}, {"mu", 1.0}, {"lambda", 1.0},        {"shear_correction", 1.0}, {"mu_c", 1.0},
                        {"L_c", 1e-3},       {"p", 1.0},  {"prestretch[0]", 1.0}, {"prestretch[1]", 1.0}};
  for (const char* name : {"A[0]", "A[1]", "A[2]", "K[0]", "K[1]", "K[2]", "b[0]", "b[1]", "b[2]"}) p.input.parameters[name] = 1.0;
  p.input.choices = {{"coupling", "default"}};
  p.make(type);
  p.perturb(1e-3, 0.1);
  const Term& term = p.term();
  std::size_t unknowns = 0;
  for (const LocalBlock& block : *term.batch(0).blocks) unknowns += static_cast<std::size_t>(block.dim);
  BatchResult out;
  out.gradient.resize(unknowns * native_width);
  out.hessian.resize(unknowns * unknowns * native_width);
  const double seconds = least_time(state, [&] {
    for (int b = 0; b < term.batch_count(); ++b) term.evaluate(p.u, b, Want::hessian, out);
    benchmark::ClobberMemory();
  });
  state.counters["time_per_element"] = seconds / static_cast<double>(p.input.region.cells.size());
}

const bool registered = [] {
  for (const std::string type : {"cosserat-rod", "cosserat-plate", "cosserat-shell", "reissner-mindlin"})
    for (const Rule rule : {Rule::projection, Rule::geodesic})
      benchmark::RegisterBenchmark(("body_hessian/" + type + (rule == Rule::projection ? "/projection" : "/geodesic")).c_str(),
                                   [=](benchmark::State& state) { kernel(state, type, rule); });
  return true;
}();

}  // namespace
}  // namespace karcher::bench
