#include "kernel/settings.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "bodies/make_bodies.hpp"
#include "kernel/body_groups.hpp"

namespace grit {

namespace {

/// Sorts the engines by their phases; returns those of phase `settings`.
std::vector<ActingEngine> take_engines(const SceneDescription& scene, const Components& components, Settings& now) {
  std::vector<ActingEngine> of_settings;
  for (const auto& [name, engine] : components.engines) {
    const auto described = scene.engines.find(name);  // not if a program has added it
    GroupMask groups =
        described == scene.engines.end() ? GroupMask() : group_mask(described->second.groups, now.groups);
    const Phase phase = engine->phase();
    auto& engines = phase == Phase::settings ? of_settings
                    : phase == Phase::forces ? now.force_engines
                                             : now.removal_engines;
    engines.push_back({engine.get(), std::move(groups)});
  }
  return of_settings;
}

/// The settings of a group; without one, those by engines that act on all groups.
MotionSettings motion_of(const std::vector<ActingEngine>& engines, std::optional<std::size_t> group) {
  MotionSettings motion;
  for (const ActingEngine& one : engines)
    if (group ? one.acts_on(*group) : one.groups.empty()) one.engine->settings(motion);
  return motion;
}

}  // namespace

bool Settings::by_group() const {
  const auto limited = [](const GroupMask& mask) { return !mask.empty(); };
  return !motion_of_groups.empty() || std::ranges::any_of(force_engines, limited, &ActingEngine::groups) ||
         std::ranges::any_of(removal_engines, limited, &ActingEngine::groups) ||
         std::ranges::any_of(groups_of_walls, limited);
}

double growth_rate(const SceneDescription& scene, const std::string& stage) {
  const auto found = std::ranges::find(scene.stages, stage, &StageDescription::name);
  return found != scene.stages.end() && found->growth ? found->growth->rate : 0;
}

Settings settings_of(const SceneDescription& scene, const Components& components, const std::string& stage,
                     const std::vector<std::string>& materials) {
  Settings now;
  now.law = components.law;
  now.law->mix(materials_in_use(scene, materials), materials_of_bodies(scene));
  now.fields = now.law->state();
  now.engines = components.engines;
  now.groups = group_names(scene);
  const std::vector<ActingEngine> settings_engines = take_engines(scene, components, now);
  now.motion = motion_of(settings_engines, std::nullopt);
  if (std::ranges::any_of(settings_engines, [](const ActingEngine& one) { return !one.groups.empty(); }))
    for (std::size_t group = 0; group < now.groups.size(); ++group)
      now.motion_of_groups.push_back(motion_of(settings_engines, group));
  for (const auto& [name, wall] : scene.walls) now.groups_of_walls.push_back(group_mask(wall.groups, now.groups));
  now.strain_rate = scene.domain.strain_rate, now.shear_rate = scene.domain.shear_rate.vector();
  now.cell_servo = scene.domain.servo, now.open_sides = scene.domain.open_sides;
  now.specimen = scene.specimen, now.time_step = scene.time_step, now.guards = scene.guards;
  now.growth_rate = growth_rate(scene, stage);
  now.may_clump =
      std::ranges::any_of(components.body_kinds, [](const auto& kind) { return kind.second->clump() != nullptr; });
  return now;
}

}  // namespace grit
