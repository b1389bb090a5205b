// Whether a condition holds throughout a run.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "description/current_scene.hpp"
#include "input/scene.hpp"
#include "simulation/live_components.hpp"
#include "simulation/mixed_law.hpp"

namespace grit {

/// Whether `is` holds for a scene throughout: as described, at the start of each stage, and at both ends of each ramp.
template <class Is>
bool always(const Scene& described, Is is) {
  return through_stages(*described.description, described.stages,
                        [&](const SceneDescription& now, std::optional<std::size_t>) { return is(now); });
}

using EngineMap = std::map<std::string, std::shared_ptr<Engine>>;

/// The same of a scene and its engines.
template <class Is>
bool always_by_engines(const Scene& described, Is is) {
  LiveEngines engines;
  return always(described, [&](const SceneDescription& now) {
    engines.follow(now);
    return is(now, engines.all());
  });
}

/// The same of a scene and its contact law.
template <class Is>
bool always_by_law(const Scene& described, Is is) {
  MixedLaw mixed(*described.description);
  return always(described, [&](const SceneDescription& now) {
    mixed.follow(now);
    return is(now, std::as_const(mixed.law()));
  });
}

/// Whether an engine adds forces to those of contacts; gravity is none of them.
inline bool has_forces(const EngineMap& engines) {
  return std::ranges::any_of(engines, [](const auto& one) { return one.second->phase() == Phase::forces; });
}

/// Whether bodies appear after the first instant.
inline bool bodies_come_later(const SceneDescription& start) {
  return std::ranges::any_of(start.bodies, [](const auto& group) {
    return !group.second.stage.empty() || std::holds_alternative<StreamSource>(group.second.source.value());
  });
}

/// Maximum duration of a stage [s].
inline double longest(const StageDescription& stage) {
  const auto* time = std::get_if<TimeCondition>(&stage.until.is.value());
  return time != nullptr ? std::min(time->value, stage.limit) : stage.limit;
}

/// Motion settings of a group of bodies, from all engines except the one of this name.
inline MotionSettings settings_of(const SceneDescription& scene, const EngineMap& engines, const std::string& group,
                                  const std::string& excluded = "") {
  MotionSettings settings;
  for (const auto& [name, engine] : engines)
    if (name != excluded && scene.engines.at(name).acts_on(group)) engine->settings(settings);
  return settings;
}

/// Whether `is` holds for the motion settings of all groups.
template <class Is>
bool all_settings(const SceneDescription& scene, const EngineMap& engines, Is is) {
  return std::ranges::all_of(scene.bodies,
                             [&](const auto& group) { return is(settings_of(scene, engines, group.first)); });
}

}  // namespace grit
