// What an input reaches: g++ calls __sanitizer_cov_trace_pc in every block of what reads files, and libFuzzer looks into counters of this section.

#include <cstddef>
#include <cstdint>

namespace {
constexpr int bits = 17;
__attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t counters[std::size_t{1} << bits];
}  // namespace

extern "C" void __sanitizer_cov_trace_pc() {
  // Differences of addresses are the same in every run; the multiplier (2^64 over the golden ratio) spreads them.
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) - reinterpret_cast<std::uintptr_t>(&__sanitizer_cov_trace_pc);
  std::uint8_t& counter = counters[place * 0x9E3779B97F4A7C15u >> (64 - bits)];
  if (counter < 255) ++counter;
}
