// What holds from the start of a run to its end.
#pragma once

#include <algorithm>
#include <string>
#include <variant>

#include "input/scene.hpp"
#include "scene/make_bodies.hpp"

namespace grit {

/// Whether all that a run goes by is so: the description, each stage with its changes, each increment of its ramps.
template <class Is>
bool always(const Scene& described, Is is) {
  return is(*described.description) && std::ranges::all_of(described.stages, [&](const StagePlan& stage) {
           return is(*stage.start) &&
                  std::ranges::all_of(stage.ramp, [&](const auto& increment) { return is(*increment); });
         });
}

/// The same of what the law of contacts makes of the materials; the law is left as the run begins with it.
template <class Is>
bool always_by_law(const Scene& described, Is is) {
  const auto mixed = [&](const SceneDescription& scene) -> ContactLaw& {
    ContactLaw& law = *scene.contacts.get();
    law.mix(materials_in_use(scene, material_names(scene)), materials_of_bodies(scene));
    return law;
  };
  const bool so = always(described, [&](const SceneDescription& scene) { return is(scene, mixed(scene)); });
  mixed(*described.description);
  return so;
}

/// Longest time that a stage can take [s].
inline double longest(const StageDescription& stage) {
  const auto* time = std::get_if<TimeCondition>(&stage.until.is.value());
  return time != nullptr ? std::min(time->value, stage.limit) : stage.limit;
}

/// How bodies move by all engines, but for the one of this name.
inline MotionSettings settings_of(const SceneDescription& scene, const std::string& left_out = "") {
  MotionSettings settings;
  for (const auto& [name, engine] : scene.engines)
    if (name != left_out) engine.engine->settings(settings);
  return settings;
}

}  // namespace grit
