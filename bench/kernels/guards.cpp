// What the guard of energies does every so many steps, beside a step.
#include <benchmark/benchmark.h>

#include "dense.hpp"

namespace grit::bench {
namespace {

/// The dense grains as a scene, whose steps take them nowhere.
Simulation& world() {
  static test::Trial trial = [] {
    Description d = test::description("linear-rolling", material("linear-rolling"), grains(10000));
    d["time_step"]["value"] = 1e-15;
    d["guards"] = {{"overlap", 1.0}};
    return test::Trial(d);
  }();
  return trial.world();
}

void guard(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(world().kinetic_energy_ratio());
}
BENCHMARK(guard)->Name("guards/energy");

void step(benchmark::State& state) {
  for (auto _ : state) world().step_on();
}
BENCHMARK(step)->Name("guards/step");

}  // namespace
}  // namespace grit::bench
