#include "lint/endless_fall.hpp"

#include <algorithm>

#include "lint/all_stages.hpp"

namespace grit {

std::optional<UnusedSetting> endless_fall(const Scene& described) {
  const bool stopped = always_by_engines(described, [](const SceneDescription& now, const EngineMap& engines) {
    const auto falls = [](const MotionSettings& group) {
      return !group.gravity.cwiseProduct(group.free_translation()).isZero(0.0);
    };
    const auto& periodic = now.domain.periodic;
    return !std::ranges::all_of(periodic, [](bool one) { return one; }) || !now.walls.empty() || has_forces(engines) ||
           !all_settings(now, engines, falls);
  });
  if (stopped) return std::nullopt;
  return UnusedSetting{"/engines",
                       "gravity acts in a domain that is periodic along all axes, without walls: nothing stops the "
                       "bodies; remove gravity, or make an axis not periodic and add a wall"};
}

}  // namespace grit
