// What it costs to ask a wall's geometry which of 4096 spheres near it touch. A new geometry needs a line in `walls`.
#include <benchmark/benchmark.h>

#include "dense.hpp"

namespace grit::bench {
namespace {

void touch(benchmark::State& state, const Description& wall) {
  auto plain = test::description("linear-rolling", {{"contact_modulus", 1e8}}, {{Vec3::Zero(), 1e-3}});
  plain["walls"]["wall"] = wall;
  plain["walls"]["wall"]["material"] = "grain";
  const Scene scene = test::scene_of(plain);
  const Geometry& geometry = *scene.description->walls.at("wall").geometry;
  // A layer about z = 0, of which half overlaps the face, over somewhat more than the square [0, 1] × [0, 1] m.
  Random random(1);
  std::vector<Sphere> spheres;
  for (std::uint32_t i = 0; i < 4096; ++i)
    spheres.push_back(
        {Vec3(1.1 * random.uniform() - 0.05, 1.1 * random.uniform() - 0.05, 0.008 + 0.004 * random.uniform()), 0.01,
         i});
  std::vector<Touch> touches;
  for (auto _ : state) {
    touches.clear();
    geometry.touch({}, spheres, touches);
    benchmark::DoNotOptimize(touches.data());
  }
  state.counters["spheres_per_s"] =
      benchmark::Counter(static_cast<double>(spheres.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["touching_share"] = static_cast<double>(touches.size()) / static_cast<double>(spheres.size());
}

[[maybe_unused]] const bool registered = [] {
  const std::pair<const char*, Description> walls[] = {
      {"plane", {{"type", "plane"}}},
      {"rectangle", {{"type", "rectangle"}, {"corner", {0, 0, 0}}, {"edge_a", {1, 0, 0}}, {"edge_b", {0, 1, 0}}}},
      {"saw-tooth",
       {{"type", "saw-tooth"},
        {"corner", {0, 0, 0}},
        {"edge_a", {1, 0, 0}},
        {"edge_b", {0, 1, 0}},
        {"depth", 0.01},
        {"spacing", 0.02}}},
      {"sinusoidal",
       {{"type", "sinusoidal"},
        {"corner", {0, 0, 0}},
        {"edge_a", {1, 0, 0}},
        {"edge_b", {0, 1, 0}},
        {"depth", 0.01},
        {"wavelength", 0.1}}},
      // Its lowest line is y = 0.5, z = 0; the layer leaves it 0.035 m to either side.
      {"cylinder", {{"type", "cylinder"}, {"start", {0, 0.5, 0.1}}, {"end", {1, 0.5, 0.1}}, {"radius", 0.1}}},
      {"container", {{"type", "box"}, {"low", {0, 0, 0}}, {"high", {1, 1, 1}}}},
      {"block", {{"type", "box"}, {"low", {0, 0, -1}}, {"high", {1, 1, 0}}, {"inside", false}}},
  };
  for (const auto& [name, wall] : walls)
    benchmark::RegisterBenchmark((std::string("touch/") + name).c_str(),
                                 [wall = wall](benchmark::State& state) { touch(state, wall); });
  return true;
}();

}  // namespace
}  // namespace grit::bench
