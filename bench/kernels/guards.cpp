// The energy guard, and a step for comparison.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "dense.hpp"

namespace grit::bench {
namespace {

/// The dense grains as a scene without motion, on the given number of threads.
Kernel& kernel_of(const benchmark::State& state) {
  static std::map<std::int64_t, std::unique_ptr<test::Trial>> made;
  std::unique_ptr<test::Trial>& trial = made[state.range(0)];
  if (!trial) {
    Description d = test::description("linear-rolling", material("linear-rolling"), grains(10000));
    d["time_step"]["value"] = 1e-15;
    d["guards"] = {{"overlap", 1.0}};
    trial = std::make_unique<test::Trial>(d, static_cast<unsigned>(state.range(0)));
  }
  return trial->kernel();
}

void guard(benchmark::State& state) {
  Kernel& dense = kernel_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(dense.kinetic_energy_ratio());
}
BENCHMARK(guard)->Name("guards/energy")->Arg(1)->Arg(2)->UseRealTime();

void step(benchmark::State& state) {
  Kernel& dense = kernel_of(state);
  for (auto _ : state) dense.step_on();
}
BENCHMARK(step)->Name("guards/step")->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
}  // namespace grit::bench
