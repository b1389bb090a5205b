#include "lint/repeated_geometry.hpp"

#include <map>
#include <optional>

#include "description/current_scene.hpp"

namespace grit {

std::vector<UnusedSetting> repeated_geometry(const Scene& described,
                                             const std::function<bool(const std::string&)>& is_written) {
  const SceneDescription& start = *described.description;
  std::vector<UnusedSetting> repeated;
  const auto inspect = [&](std::size_t stage, const std::string& name, const Component<Geometry>& before,
                           const Component<Geometry>& now) {
    const Description::json_pointer wall("/walls/" + pointer_token(name));
    const Description& change = start.stages[stage].change;
    if (before.type() != now.type() || !change.contains(wall)) return;
    for (const auto& entry : change.at(wall).items()) {
      const auto then = before.values().find(entry.key()), here = now.values().find(entry.key());
      if (then == before.values().end() || here == now.values().end() || *then != *here) continue;
      const std::string pointer =
          "/stages/" + std::to_string(stage) + "/change" + wall.to_string() + '/' + pointer_token(entry.key());
      if (is_written(pointer))
        repeated.push_back(
            {pointer,
             "the wall has this value already; its motion so far is added, so that this does not put it back"});
    }
  };
  std::map<std::string, Component<Geometry>> known;
  for (const auto& [name, wall] : start.walls) known.emplace(name, wall.geometry);
  std::optional<std::size_t> present;
  const auto visit = [&](const SceneDescription& now, std::optional<std::size_t> stage) {
    const bool begins = stage != present;
    present = stage;
    // Other stages change no wall: many of them cost nothing.
    if (!stage || (start.stages[*stage].ramps.empty() && !start.stages[*stage].change.contains("walls"))) return true;
    for (const auto& [name, wall] : now.walls) {
      if (begins) inspect(*stage, name, known.at(name), wall.geometry);
      known.insert_or_assign(name, wall.geometry);
    }
    return true;
  };
  through_stages(start, described.stages, visit);
  return repeated;
}

}  // namespace grit
