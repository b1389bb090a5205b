#include "output/plugins_used.hpp"

#include <set>
#include <string>
#include <utility>

namespace grit {

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

}  // namespace grit
