#pragma once
/// \file
/// Thread CPU time and a low quantile of it over repetitions: what the code needs when nothing else disturbs it, also on a machine that is shared.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace karcher::bench {

inline double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The fifth smallest of a hundred: undisturbed by other programs, and not deceived by single samples that the kernel's accounting makes too short.
inline double low_quantile(std::vector<double> samples) {
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 20);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

/// Runs f as often as the benchmark wants, `repeat` times per sample. \returns thread CPU time of one call [s]
template <class F>
double least_time(benchmark::State& state, F f, int repeat = 1) {
  std::vector<double> samples;
  for (auto _ : state) {
    const double start = thread_seconds();
    for (int i = 0; i < repeat; ++i) f();
    samples.push_back((thread_seconds() - start) / repeat);
  }
  return low_quantile(std::move(samples));
}

/// Floating point operations per second that fused multiply-adds in packs of the native width reach on this core: the limit of every kernel.
double fma_peak();

}  // namespace karcher::bench
