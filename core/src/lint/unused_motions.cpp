#include "lint/unused_motions.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"

namespace grit {
namespace {

/// Whether `is` holds for a wall's motion throughout the run.
template <class Is>
bool always_of(const Scene& described, const std::string& wall, Is is) {
  return always(described, [&](const SceneDescription& scene) { return is(scene, scene.walls.at(wall).motion); });
}

bool has_speed(const MotionDescription& motion) {
  return !motion.velocity.isZero(0.0) || !motion.spin.isZero(0.0) || motion.oscillation || motion.surface_moves();
}

/// A message naming the first stage in which the wall moves, if the wall's ramp is longer than all such stages.
std::optional<std::string> never_at_full_speed(const Scene& described, const std::string& wall) {
  std::string message;
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
        if (message.empty())
          message = fmt::format("the ramp takes {:g} s, the stage \"{}\" at most {:g} s", ramp, stage.name, lasts);
        return true;
      });
  return !never || message.empty() ? std::nullopt : std::optional(message);
}

}  // namespace

std::vector<UnusedSetting> unused_motions(const Scene& described) {
  std::vector<UnusedSetting> unused;
  for (const auto& [name, wall] : described.description->walls) {
    const MotionDescription& motion = wall.motion;
    const auto say = [&unused, at = "/walls/" + pointer_token(name) + "/motion/"](const char* key,
                                                                                  const std::string& why) {
      unused.push_back({at + key, why});
    };
    const std::string& wall_name = name;
    if (motion.ramp_time > 0 &&
        always_of(described, name, [](const auto&, const MotionDescription& now) { return !has_speed(now); }))
      say("ramp_time", "neither the wall nor its surface has a velocity, spin or oscillation");
    else if (const auto message = never_at_full_speed(described, name))
      say("ramp_time", "the wall never reaches its full speed: " + *message + "; it starts again with each stage");
    using Vector = Vec3 OscillationDescription::*;
    const auto check_phase = [&](Vector phase, Vector of, const char* key, const char* what) {
      for (const char axis : {'x', 'y', 'z'}) {
        const int k = axis - 'x';
        if (((*motion.oscillation).*phase)[k] != 0 && always_of(described, name, [&](const auto&, const auto& now) {
              return !now.oscillation || ((*now.oscillation).*of)[k] == 0;
            }))
          say(key, fmt::format("it has a component along {}, where {} is 0", axis, what));
      }
    };
    if (motion.oscillation) {
      check_phase(&OscillationDescription::amplitude_phase, &OscillationDescription::amplitude,
                  "oscillation/amplitude_phase", "amplitude");
      check_phase(&OscillationDescription::angle_phase, &OscillationDescription::angle, "oscillation/angle_phase",
                  "angle");
    }
    if (motion.free)
      for (const char axis : {'x', 'y', 'z'})
        if (motion.free->load[axis - 'x'] != 0 && always_of(described, name, [axis](const auto&, const auto& now) {
              return !now.free || now.free->axes.find(axis) == std::string::npos;
            }))
          say("free/load", std::string("it has a component along ") + axis + ", along which the wall is not free");
    if (motion.follow && always_of(described, name, [&](const SceneDescription& scene, const MotionDescription& now) {
          return !now.follow || std::ranges::all_of(now.follow->axes, [&](char axis) {
            return ways(scene.walls, wall_name, axis).none();
          });
        }))
      say("follow", "the wall \"" + motion.follow->wall + "\" does not move along " + motion.follow->axes +
                        "; rotation is not followed");
  }
  return unused;
}

}  // namespace grit
