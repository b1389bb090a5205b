#include "app/run_setup.hpp"

#include <set>
#include <utility>

#include "bodies/make_bodies.hpp"

namespace grit {

StateRequest picture_state(const SceneDescription& scene) {
  if (!scene.output.picture) return {};
  if (scene.output.picture->color == "rotation") return BodyState::rotation;
  if (scene.output.picture->color == "displacement") return BodyState::displacement;
  return {};
}

std::vector<PluginUsed> plugins_used(const SceneDescription& scene, const Registry& registry) {
  std::set<std::pair<std::string, std::string>> names{{"contact", scene.contacts.type()}};
  for (const auto& [name, bodies] : scene.bodies) names.emplace("body", bodies.kind.type());
  for (const auto& [name, wall] : scene.walls) names.emplace("geometry", wall.geometry.type());
  for (const auto& [name, engine] : scene.engines) names.emplace("engine", engine.engine.type());
  for (const auto& [name, probe] : scene.probes) names.emplace("probe", probe.probe.type());
  std::vector<PluginUsed> used;
  for (const auto& [kind, name] : names) {
    const PluginInfo& info = registry.info(kind, name);
    used.push_back({kind, name, info.version, registry.file(kind, name), info.tag});
  }
  return used;
}

std::map<std::string, ClumpFacts> clumps_of(const Components& components) {
  std::map<std::string, ClumpFacts> clumps;
  for (const auto& [name, kind] : components.body_kinds)
    if (const ClumpShape* clump = kind->clump()) clumps[name] = {clump->spheres.size(), clump->errors};
  return clumps;
}

StateRequest run_state(const SceneDescription& scene, const Components& components) {
  return requested_state(components, picture_state(scene));
}

std::vector<std::string> state_by_component(const SceneDescription& scene, const Components& components) {
  std::vector<std::string> lines;
  for (const auto& [state, name, bytes] : {std::tuple(BodyState::rotation, "rotation", sizeof(Vec3)),
                                           std::tuple(BodyState::displacement, "displacement", sizeof(Vec3)),
                                           std::tuple(BodyState::energy, "energies", std::size_t{0})}) {
    std::string who;
    const auto add = [&](const std::string& one) { who += (who.empty() ? "" : ", ") + one; };
    for (const auto& [probe_name, probe] : components.probes)
      if (probe->needs().has(state)) add("probe " + probe_name);
    for (const auto& [engine_name, engine] : components.engines)
      if (engine->needs().has(state)) add("engine " + engine_name);
    if (picture_state(scene).has(state)) add("the picture");
    lines.push_back(std::string(name) + (who.empty()  ? ": off"
                                         : bytes == 0 ? ": kept, for " + who
                                                      : ": " + std::to_string(bytes) + " bytes a body, for " + who));
  }
  for (const StateField& field : components.law->state())
    lines.push_back(field.name + ": 8 bytes a contact, for contact law " + scene.contacts.type() + " (" + field.doc +
                    ")");
  return lines;
}

}  // namespace grit
