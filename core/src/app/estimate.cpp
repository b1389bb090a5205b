#include "app/estimate.hpp"

#include <algorithm>

#include "app/run_setup.hpp"
#include "bodies/body_memory.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {
namespace {

// Particle-steps/s of one thread: quick simulations reach 12 to 31 million, dense packings of 10 000 to 50 000 grains
// 19 to 23 million on an AMD EPYC (Zen 4), see docs/evidence/estimates.md. Without AVX-512 they are about 1.5 times
// slower.
#ifdef __AVX512F__
constexpr double speed_of_a_thread = 18e6;
#else
constexpr double speed_of_a_thread = 12e6;
#endif
// A cloud has no contacts yet; in a dense packing the critical step of the same grains is about this fraction of the
// cloud's.
constexpr double dense_step_fraction = 0.6;

}  // namespace

double planning_speed(unsigned threads) { return speed_of_a_thread * threads; }

Estimate estimate(const Scene& scene, const Components& components, const Kernel& kernel) {
  const SceneDescription& description = *scene.description;
  const std::size_t bodies = kernel.world().positions().size();
  const TimeStepDescription& wish = description.time_step;
  const double safe = wish.safety * kernel.critical_time_step();
  const bool cloud = kernel.contact_count() * 2 < bodies;
  Estimate all;
  all.dt = cloud && !wish.value ? std::min(kernel.world().dt(), dense_step_fraction * safe) : kernel.world().dt();
  all.stages = expected_stages(scene, components, bodies, all.dt);
  all.most_bodies = static_cast<double>(bodies);
  for (const ExpectedStage& stage : all.stages) {
    all.most_bodies = std::max(all.most_bodies, stage.bodies);
    all.least_body_steps += stage.least_body_time / stage.dt, all.most_body_steps += stage.most_body_time / stage.dt;
    all.all_known = all.all_known && (stage.known || stage.usual);
  }
  all.memory_now = static_cast<double>(kernel.state().bytes());
  all.memory_dense = bytes_per_body * all.most_bodies;
  return all;
}

Estimate estimate(const LiveScene& live, const Scene& scene, const Registry& registry) {
  const Components& components = live.components();
  Kernel kernel(*scene.description, components, prepare(live, registry, run_state(*scene.description, components)), 1);
  kernel.find_forces();
  return estimate(scene, components, kernel);
}

}  // namespace grit
