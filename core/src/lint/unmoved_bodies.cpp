#include "lint/unmoved_bodies.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"
#include "run/conditions.hpp"

namespace grit {
namespace {

/// Groups whose motion is prescribed in all stages: contacts do not move them.
std::set<std::string> held_groups(const Scene& described) {
  std::set<std::string> held;
  for (const auto& [name, group] : described.description->bodies)
    if (always_by_engines(described, [&](const SceneDescription& now, const EngineMap& engines) {
          return settings_of(now, engines, name).prescribed.has_value();
        }))
      held.insert(name);
  return held;
}

/// Whether contacts of the first instant push bodies.
bool has_pushing_contacts(const World& world, const std::set<std::string>& held) {
  const auto is_held = [&](std::uint32_t body) { return held.contains(world.group_of(world.ids()[body])); };
  return std::ranges::any_of(world.contacts(), [&](const Contact& contact) {
    return !is_held(contact.a) || (!contact.with_wall && !is_held(contact.b));
  });
}

/// Whether the bodies of the first instant are at rest.
bool is_at_rest(const World& world) {
  const auto is_zero = [](const Row& row) { return xyz(row).isZero(0.0); };
  return std::ranges::all_of(world.velocities(), is_zero) && std::ranges::all_of(world.spins(), is_zero);
}

/// Whether a group has a velocity, or may appear in a stage with a velocity of its own or with overlaps.
bool may_move(const BodiesDescription& group) {
  const auto& source = group.source.value();
  const bool is_placed = std::holds_alternative<ListSource>(source) || std::holds_alternative<FileSource>(source) ||
                         std::holds_alternative<LatticeSource>(source);
  return !group.velocity.isZero(0.0) || (is_placed && !group.stage.empty());
}

bool has_walls_at_rest(const SceneDescription& now, const SceneDescription& start) {
  return std::ranges::all_of(now.walls, [&](const auto& wall) {
    const auto before = start.walls.find(wall.first);
    return stands_still(wall.second.motion) && before != start.walls.end() &&
           before->second.geometry == wall.second.geometry;
  });
}

/// Whether no force acts on bodies in any stage, no wall moves, and neither bodies nor the domain change their size.
bool nothing_pushes(const Scene& described) {
  const SceneDescription& start = *described.description;
  const auto grows = [](const StageDescription& stage) { return stage.growth.has_value(); };
  return std::ranges::none_of(start.stages, grows) &&
         always_by_engines(described, [&](const SceneDescription& now, const EngineMap& engines) {
           const auto is_unmoved = [](const MotionSettings& group) {
             return group.gravity.isZero(0.0) && (!group.prescribed || *group.prescribed == RigidMotion{});
           };
           return all_settings(now, engines, is_unmoved) && !has_forces(engines) && !now.domain.deforms() &&
                  has_walls_at_rest(now, start);
         });
}

bool is_stream(const BodiesDescription& group) { return std::holds_alternative<StreamSource>(group.source.value()); }

}  // namespace

std::optional<UnusedSetting> unmoved_bodies(const Scene& described, const World& world) {
  const SceneDescription& start = *described.description;
  const auto moves = [](const auto& group) { return may_move(group.second); };
  const auto enters = [](const auto& group) { return is_stream(group.second); };
  const auto waits = [](const StageDescription& stage) { return waits_for_contacts(stage.until); };
  const bool pushed = !world.contacts().empty() && has_pushing_contacts(world, held_groups(described));
  const bool still = !pushed && is_at_rest(world) && std::ranges::none_of(start.bodies, moves);
  const bool flows = std::ranges::any_of(start.bodies, enters);
  // A velocity alone has a use: in collisions. It does not make bodies rest on each other.
  const bool in_vain =
      flows || (!pushed && !start.begin && !bodies_come_later(start) && std::ranges::any_of(start.stages, waits));
  if (!(still || in_vain) || !nothing_pushes(described)) return std::nullopt;
  if (still)
    return UnusedSetting{
        "/engines",
        "nothing moves the bodies: they are at rest without contacts that push them, no wall moves, and there is "
        "neither gravity nor another force; add \"gravity\": {\"type\": \"gravity\"}, a velocity or a moving wall"};
  return UnusedSetting{"/engines", std::string("no force acts on the bodies: there is neither gravity nor another "
                                               "force, and no wall moves; ") +
                                       (flows ? "those of a stream keep their velocity until they hit something"
                                              : "a stage waits for contacts that carry them") +
                                       "; if they should fall, add \"gravity\": {\"type\": \"gravity\"}"};
}

}  // namespace grit
