#include "kernel/settings.hpp"

#include <algorithm>

#include "bodies/make_bodies.hpp"

namespace grit {

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
  for (const auto& [name, engine] : components.engines) {
    if (engine->phase() == Phase::settings) engine->settings(now.motion);
    else now.force_engines.push_back(engine.get());
  }
  now.strain_rate = scene.domain.strain_rate, now.shear_rate = scene.domain.shear_rate.vector();
  now.cell_servo = scene.domain.servo, now.open_sides = scene.domain.open_sides;
  now.specimen = scene.specimen, now.time_step = scene.time_step, now.guards = scene.guards;
  now.growth_rate = growth_rate(scene, stage);
  now.may_clump =
      std::ranges::any_of(components.body_kinds, [](const auto& kind) { return kind.second->clump() != nullptr; });
  return now;
}

}  // namespace grit
