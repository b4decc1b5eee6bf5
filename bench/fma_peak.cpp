#include <benchmark/benchmark.h>

#include "karcher/math/pack.hpp"
#include "timing.hpp"

namespace karcher::bench {
namespace {

/// Twelve chains hide the latency of a multiply-add and fit any register file; their starts differ, so that no two are the same computation.
constexpr int chains = 12, rounds = 200000;

NativeScalar multiply_add(NativeScalar start) {
  const NativeScalar factor = NativeScalar(0.9999), term = NativeScalar(1e-4);
  NativeScalar a0 = start, a1 = start + a0, a2 = start + a1, a3 = start + a2, a4 = start + a3, a5 = start + a4, a6 = start + a5, a7 = start + a6,
               a8 = start + a7, a9 = start + a8, a10 = start + a9, a11 = start + a10;
  for (int i = 0; i < rounds; ++i) {
    a0 = a0 * factor + term;
    a1 = a1 * factor + term;
    a2 = a2 * factor + term;
    a3 = a3 * factor + term;
    a4 = a4 * factor + term;
    a5 = a5 * factor + term;
    a6 = a6 * factor + term;
    a7 = a7 * factor + term;
    a8 = a8 * factor + term;
    a9 = a9 * factor + term;
    a10 = a10 * factor + term;
    a11 = a11 * factor + term;
  }
  return a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + a8 + a9 + a10 + a11;
}

constexpr double operations = 2.0 * chains * rounds * native_width;

void run(benchmark::State& state) {
  const double seconds = least_time(state, [] { benchmark::DoNotOptimize(multiply_add(NativeScalar(1.0))); });
  state.counters["flops"] = operations / seconds;
  state.counters["lanes"] = native_width;
}
BENCHMARK(run)->Name("fma_peak");

}  // namespace

double fma_peak() {
  static const double peak = [] {
    std::vector<double> samples;
    for (int i = 0; i < 300; ++i) {
      const double start = thread_seconds();
      benchmark::DoNotOptimize(multiply_add(NativeScalar(1.0)));
      samples.push_back(thread_seconds() - start);
    }
    return operations / low_quantile(std::move(samples));
  }();
  return peak;
}

}  // namespace karcher::bench
