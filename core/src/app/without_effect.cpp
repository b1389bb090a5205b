#include "app/without_effect.hpp"

#include <algorithm>

namespace grit {
namespace {

bool same(const MotionSettings& a, const MotionSettings& b) {
  return a.gravity == b.gravity && a.local_damping == b.local_damping && a.hold_rotation == b.hold_rotation &&
         a.hold_translation == b.hold_translation && a.flat == b.flat;
}

bool is_changed(const SceneDescription& scene, const std::string& section, const std::string& name) {
  return std::ranges::any_of(scene.stages, [&](const StageDescription& stage) {
    const bool changed = stage.change.contains(section) && stage.change.at(section).contains(name);
    return changed || std::ranges::any_of(stage.ramps, [&](const RampDescription& ramp) {
             return ramp.pointer.starts_with('/' + section + '/' + name + '/');
           });
  });
}

}  // namespace

std::vector<std::string> without_effect(const SceneDescription& scene, const Simulation& world) {
  std::vector<std::string> lines;
  const auto say = [&](const std::string& pointer, const std::string& why) { lines.push_back(pointer + ": " + why); };

  MotionSettings all;
  for (const auto& [name, engine] : scene.engines) {
    MotionSettings own;
    engine.engine->settings(own), engine.engine->settings(all);
    if (engine.engine->phase() == Phase::settings && same(own, {}) && !is_changed(scene, "engines", name))
      say("/engines/" + name, "with these values it does nothing");
  }
  const bool never_turn = all.hold_rotation && std::ranges::none_of(scene.engines, [&](const auto& engine) {
                            return is_changed(scene, "engines", engine.first);
                          });
  const bool spun = std::ranges::any_of(world.spins(), [](const Row& w) { return !xyz(w).isZero(0.0); });
  if (never_turn && !spun) {
    if (scene.output.picture && scene.output.picture->color == "rotation")
      say("/output/picture/color", "rotations are held, so that all are 0; another colour would show something");
    for (const auto& [name, probe] : scene.probes)
      if (probe.probe->needs().has(BodyState::rotation))
        say("/probes/" + name, "it looks at rotations, which are held: all are 0");
  }

  const bool random = std::ranges::any_of(
      scene.bodies, [](const auto& group) { return std::holds_alternative<CloudGrains>(group.second.grains.value()); });
  if (!random && scene.seed != 1) say("/seed", "nothing is random: all grains are given");
  const auto radii = world.positions();
  const auto smallest = std::ranges::min_element(radii, {}, &Row::w);
  for (const auto& [name, group] : scene.bodies)
    if (group.stage.empty() && group.heavier_below > 0 && smallest != radii.end() &&
        group.heavier_below <= 2 * smallest->w)
      say("/bodies/" + name + "/heavier_below", "no grain is smaller");
  for (const auto& [name, group] : scene.bodies)
    if (group.stage.empty() && group.overlap != BodiesDescription::usual_overlap)
      say("/bodies/" + name + "/overlap", "it is looked at where bodies appear in a stage, and these are there before");

  if (scene.time_step.value && scene.time_step.safety != TimeStepDescription().safety)
    say("/time_step/safety", "the step is given by /time_step/value");
  for (const auto& [name, material] : scene.materials) {
    const bool used =
        std::ranges::any_of(scene.bodies, [&](const auto& group) { return group.second.material == name; }) ||
        std::ranges::any_of(scene.walls, [&](const auto& wall) { return wall.second.material == name; });
    const bool later = std::ranges::any_of(scene.stages, [&](const StageDescription& stage) {
      return stage.change.dump().find('"' + name + '"') != std::string::npos;
    });
    if (!used && !later) say("/materials/" + name, "no body and no wall is of it");
  }
  for (const auto& [name, probe] : scene.probes)
    if (probe.cadence.never())
      say("/probes/" + name,
          "it never looks: it has none of every_time, every_steps, every_displacement and every_left");
  return lines;
}

}  // namespace grit
