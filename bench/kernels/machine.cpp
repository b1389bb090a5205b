// Limits of one thread: memory traffic, arithmetic.
#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>

#include "bodies/large_array.hpp"

namespace grit::bench {
namespace {

/// a = b + s c. Bytes: two arrays read, one loaded and written back.
void triad(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0)) / (3 * sizeof(double));
  LargeArray<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
  double* __restrict to = a.data();
  const double *from_b = b.data(), *from_c = c.data();
  double scale = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(scale);
    for (std::size_t i = 0; i < count; ++i) to[i] = from_b[i] + scale * from_c[i];
    benchmark::ClobberMemory();
  }
  state.counters["bytes_per_s"] =
      benchmark::Counter(static_cast<double>(4 * count * sizeof(double)), benchmark::Counter::kIsIterationInvariantRate,
                         benchmark::Counter::kIs1000);
}
BENCHMARK(triad)->Name("machine/triad")->Arg(24 << 10)->Arg(4 << 20)->Arg(600 << 20);

/// Independent fused multiply-adds.
void multiply_add(benchmark::State& state) {
#if defined(__AVX512F__)
  constexpr std::size_t width = 8;
#else
  constexpr std::size_t width = 4;
#endif
  using Lane [[gnu::vector_size(width * sizeof(double))]] = double;
  constexpr int chains = 12, rounds = 1000;  // two units of latency 4 need 8 chains; 16 registers hold 12
  double factor = 0.999, more = 1e-3;
  benchmark::DoNotOptimize(factor), benchmark::DoNotOptimize(more);
  const Lane times = factor - Lane{}, plus = more - Lane{};
  std::array<Lane, chains> sums{};
  for (auto _ : state) {
    for (int round = 0; round < rounds; ++round)
#pragma GCC unroll 12
      for (int i = 0; i < chains; ++i)
        sums[static_cast<std::size_t>(i)] = sums[static_cast<std::size_t>(i)] * times + plus;
  }
  Lane total{};
  for (const Lane& sum : sums) total += sum;
  benchmark::DoNotOptimize(total);
  state.counters["flops_per_s"] =
      benchmark::Counter(2.0 * width * chains * rounds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(multiply_add)->Name("machine/multiply-add");

}  // namespace
}  // namespace grit::bench
