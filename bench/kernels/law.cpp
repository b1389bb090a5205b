// A contact law alone: one batch of touching pairs that fits into the first caches.
#include <benchmark/benchmark.h>

#include "dense.hpp"
#include "grit/testing/pairs.hpp"

namespace grit::bench {
namespace {

void law(benchmark::State& state, const std::string& name) {
  auto plain = test::description(name, material(name), grains(125));
  plain["time_step"] = {{"value", time_step}, {"allow_unstable", true}};  // nothing moves
  plain["guards"] = {{"overlap", 1.0}};
  const test::Trial trial(plain);
  const auto& world = trial.world();
  const auto own = LiveScene(trial.scene()).components().law;
  ContactLaw& law = *own;
  law.mix(std::array<std::string, 1>{"grain"}, 1);
  test::Pairs pairs(law, time_step);
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    test::Ball ball{.position = xyz(world.positions()[i]),
                    .radius = world.positions()[i].w,
                    .velocity = xyz(world.velocities()[i]),
                    .spin = xyz(world.spins()[i]),
                    .mass = 1 / world.velocities()[i].w};
    pairs.add(ball);
  }
  for (const Contact& contact : world.contacts()) pairs.pair(contact.a, contact.b);
  for (auto _ : state) pairs.evaluate();
  state.counters["contacts_per_s"] =
      benchmark::Counter(static_cast<double>(pairs.places()), benchmark::Counter::kIsIterationInvariantRate);
}

[[maybe_unused]] const bool registered = [] {
  for (const std::string name : {"linear-rolling", "linear-frictional", "hertz-mindlin"})
    benchmark::RegisterBenchmark(("law/" + name).c_str(), [name](benchmark::State& state) { law(state, name); });
  return true;
}();

}  // namespace
}  // namespace grit::bench
