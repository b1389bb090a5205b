// Simulations of scenes made by hand, with a recorder.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "bodies/make_bodies.hpp"
#include "simulation/parts.hpp"
#include "simulation/recorded_run.hpp"
#include "support/scene.hpp"

namespace grit::test {

/// With the state of bodies that components ask for, or this one. The recorder must outlive it.
inline Simulation recorded(Scene scene, Recorder& recorder, unsigned threads = 1,
                           std::optional<StateRequest> state = {}) {
  const std::shared_ptr<const Registry> registry(std::shared_ptr<void>(), &installed());  // lives on
  const auto opened = std::make_shared<OpenedScene>(registry, std::move(scene));
  const LiveScene& live = opened->live;
  Bodies bodies = make_bodies(live.now(), live.components(), state.value_or(requested_state(live.components())));
  return Simulation(std::make_unique<Simulation::Parts>(opened, std::move(bodies), threads, &recorder));
}

inline const Kernel& kernel_of(Simulation& simulation) { return simulation.parts().kernel; }
inline const LiveScene& live_of(Simulation& simulation) { return simulation.parts().opened->live; }

}  // namespace grit::test
