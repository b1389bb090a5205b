// What a run will take, estimated from its description and its first instant.
#pragma once

#include <vector>

#include "description/components.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "plugins/registry.hpp"
#include "simulation/expected_stages.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

struct Estimate {
  double dt = 0;  ///< expected time step [s]
  std::vector<ExpectedStage> stages;
  double most_bodies = 0;
  /// Particle-steps: with the known and typical durations of stages, and if stages run to their limits.
  double least_body_steps = 0, most_body_steps = 0;
  bool all_known = true;                    ///< whether each stage has a known or typical duration
  double memory_now = 0, memory_dense = 0;  ///< at the first instant, and with the contacts of a dense packing [bytes]
};

/// Particle-steps/s of so many threads.
double planning_speed(unsigned threads);

/// `kernel`: at the first instant, with forces.
Estimate estimate(const Scene& scene, const Components& components, const Kernel& kernel);

/// The same, with bodies placed for it. Throws as a run does before its first step.
Estimate estimate(const LiveScene& live, const Scene& scene, const Registry& registry);

}  // namespace grit
