#include "app/run_setup.hpp"

#include <tuple>

#include "bodies/make_bodies.hpp"

namespace grit {

StateRequest picture_state(const SceneDescription& scene) {
  if (!scene.output.picture) return {};
  if (scene.output.picture->color == "rotation") return BodyState::rotation;
  if (scene.output.picture->color == "displacement") return BodyState::displacement;
  return {};
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
