#include "lint/unused_motions.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"

namespace grit {
namespace {

/// Whether a wall's motion is so in all that a run goes by.
template <class Is>
bool always_of(const Scene& described, const std::string& wall, Is is) {
  return always(described, [&](const SceneDescription& scene) { return is(scene, scene.walls.at(wall).motion); });
}

bool has_speed(const MotionDescription& motion) {
  return !motion.velocity.isZero(0.0) || !motion.spin.isZero(0.0) || motion.oscillation;
}

/// The first stage that a wall's ramp is longer than, if it is longer than all in which the wall moves.
std::optional<std::string> never_at_full_speed(const Scene& described, const std::string& wall) {
  std::string told;
  std::optional<std::size_t> present;
  double ramp = 0;  // as the present stage begins
  const bool never = through_stages(
      *described.description, described.stages, [&](const SceneDescription& now, std::optional<std::size_t> number) {
        const MotionDescription& motion = now.walls.at(wall).motion;
        if (number != present) ramp = motion.ramp_time;
        present = number;
        if (!number || !has_speed(motion)) return true;
        const StageDescription& stage = described.description->stages[*number];
        const double lasts = longest(stage);
        if (ramp <= lasts) return false;
        if (told.empty())
          told = fmt::format("the ramp takes {:g} s, and the stage \"{}\" {:g} s at most", ramp, stage.name, lasts);
        return true;
      });
  return !never || told.empty() ? std::nullopt : std::optional(told);
}

}  // namespace

std::vector<std::string> unused_motions(const Scene& described) {
  std::vector<std::string> lines;
  for (const auto& [name, wall] : described.description->walls) {
    const MotionDescription& motion = wall.motion;
    const auto say = [&lines, at = "/walls/" + pointer_token(name) + "/motion/"](
                         const char* key, const std::string& why) { lines.push_back(at + key + ": " + why); };
    const std::string& wall_name = name;
    if (motion.ramp_time > 0 &&
        always_of(described, name, [](const auto&, const MotionDescription& now) { return !has_speed(now); }))
      say("ramp_time", "the wall has no velocity, spin or oscillation that could rise");
    else if (const auto told = never_at_full_speed(described, name))
      say("ramp_time", "the wall never comes to its full speed: " + *told + ", and it begins anew with each stage");
    if (motion.free)
      for (const char axis : {'x', 'y', 'z'})
        if (motion.free->load[axis - 'x'] != 0 && always_of(described, name, [axis](const auto&, const auto& now) {
              return !now.free || now.free->axes.find(axis) == std::string::npos;
            }))
          say("free/load", std::string("it has a part along ") + axis + ", along which the wall is not free");
    if (motion.follow && always_of(described, name, [&](const SceneDescription& scene, const MotionDescription& now) {
          return !now.follow || std::ranges::all_of(now.follow->axes, [&](char axis) {
            return ways(scene.walls, wall_name, axis).none();
          });
        }))
      say("follow", "the wall \"" + motion.follow->wall + "\" does not move along " + motion.follow->axes +
                        "; a turn is not followed");
  }
  return lines;
}

}  // namespace grit
