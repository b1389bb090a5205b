#include "lint/late_densities.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "description/current_scene.hpp"

namespace grit {
namespace {

/// A change of the density of a material.
struct Change {
  std::size_t stage;
  bool at_start;  ///< before the bodies of the stage are made
  std::string pointer;
  bool used = false;
};

using Changes = std::map<std::string, std::vector<Change>>;  // by material, in the order of time

void add_ramps(const StageDescription& stage, std::size_t number, Changes& changes) {
  for (std::size_t i = 0; i < stage.ramps.size(); ++i)
    for (auto& [name, all] : changes)
      if (stage.ramps[i].pointer == "/materials/" + pointer_token(name) + "/density")
        all.push_back({number, false, fmt::format("/stages/{}/ramps/{}", number, i)});
}

Changes changes_of(const Scene& scene) {
  const SceneDescription& start = *scene.description;
  Changes changes;
  std::map<std::string, double> before;
  for (const auto& [name, material] : start.materials) changes[name], before[name] = material.density;
  std::optional<std::size_t> present;
  through_stages(start, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> stage) {
    const bool begins = stage != present;
    for (const auto& [name, material] : now.materials)
      if (const auto known = before.find(name); known != before.end()) {
        if (begins && material.density != known->second)
          changes[name].push_back(
              {*stage, true, fmt::format("/stages/{}/change/materials/{}/density", *stage, pointer_token(name))});
        known->second = material.density;
      }
    if (begins) add_ramps(start.stages[*stage], *stage, changes);
    present = stage;
    return true;
  });
  return changes;
}

}  // namespace

std::vector<UnusedSetting> late_densities(const Scene& scene) {
  const SceneDescription& start = *scene.description;
  Changes changes = changes_of(scene);
  for (const auto& [name, group] : start.bodies) {
    if (group.stage.empty() || std::holds_alternative<StreamSource>(group.source.value())) continue;
    const auto made = static_cast<std::size_t>(std::ranges::find(start.stages, group.stage, &StageDescription::name) -
                                               start.stages.begin());
    auto& all = changes[group.material];
    const auto later = std::ranges::find_if(
        all, [&](const Change& one) { return one.stage > made || (one.stage == made && !one.at_start); });
    if (later != all.begin()) (later - 1)->used = true;
  }
  std::vector<UnusedSetting> late;
  for (const auto& [name, all] : changes)
    for (const Change& one : all)
      if (!one.used)
        late.push_back(
            {one.pointer, fmt::format("bodies keep the mass that they were made with, streams the density of the "
                                      "description, and no body of \"{}\" is made with this density; set "
                                      "/materials/{}/density, or let bodies appear in this stage or later",
                                      name, pointer_token(name))});
  return late;
}

}  // namespace grit
