// The passes of a step, each alone, on one thread.
#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <utility>

#include "dense.hpp"

namespace grit::bench {
namespace {

const char* const laws[] = {"linear-rolling", "linear-frictional", "hertz-mindlin"};

/// The grains of a benchmark, shared by its repetitions.
Dense& dense(benchmark::State& state, const std::string& law) {
  static std::map<std::pair<std::string, std::int64_t>, Dense> made;
  return made.try_emplace({law, state.range(0)}, law, static_cast<std::size_t>(state.range(0))).first->second;
}

void rate(benchmark::State& state, const char* what, std::size_t each) {
  state.counters[what] = benchmark::Counter(static_cast<double>(each), benchmark::Counter::kIsIterationInvariantRate);
}

/// Contacts per grain, and the fraction of them between chunks.
void describe(benchmark::State& state, const Dense& grains) {
  state.counters["contacts_per_grain"] =
      2 * static_cast<double>(grains.touching()) / static_cast<double>(grains.count());
  state.counters["across_fraction"] = grains.across();
}

void contacts(benchmark::State& state, const std::string& law) {
  Dense& grains = dense(state, law);
  for (auto _ : state) grains.contacts();
  rate(state, "contacts_per_s", grains.touching());
  describe(state, grains);
}

void motion(benchmark::State& state) {
  Dense& grains = dense(state, laws[0]);
  for (auto _ : state) grains.motion();
  rate(state, "grains_per_s", grains.count());
  describe(state, grains);
}

void gather(benchmark::State& state) {
  Dense& grains = dense(state, laws[0]);
  for (auto _ : state) grains.gather();
  rate(state, "grains_per_s", grains.count());
  describe(state, grains);
}

void search(benchmark::State& state) {
  Dense& grains = dense(state, laws[0]);
  for (auto _ : state) grains.search();
  rate(state, "grains_per_s", grains.count());
}

/// Without the search for pairs, the first half of each update, which is not timed.
void rebuild(benchmark::State& state) {
  Dense& grains = dense(state, laws[0]);
  for (auto _ : state) {
    state.PauseTiming();
    grains.find();
    state.ResumeTiming();
    grains.rebuild();
  }
  rate(state, "grains_per_s", grains.count());
}

[[maybe_unused]] const bool registered = [] {
  for (const std::string law : laws)
    benchmark::RegisterBenchmark(("contacts/" + law).c_str(), [law](benchmark::State& state) { contacts(state, law); })
        ->Arg(216)
        ->Arg(10000)
        ->Arg(125000);
  benchmark::RegisterBenchmark("motion", motion)->Arg(216)->Arg(10000)->Arg(125000);
  benchmark::RegisterBenchmark("gather", gather)->Arg(10000)->Arg(125000);
  benchmark::RegisterBenchmark("search", search)->Arg(10000)->Arg(125000);
  benchmark::RegisterBenchmark("rebuild", rebuild)->Arg(10000)->Arg(125000);
  return true;
}();

}  // namespace
}  // namespace grit::bench

BENCHMARK_MAIN();
