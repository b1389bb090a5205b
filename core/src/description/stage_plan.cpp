#include "description/stage_plan.hpp"

#include <algorithm>

namespace grit {
namespace {

std::string unescaped(std::string token) {
  for (const auto& [code, character] : {std::pair("~1", "/"), std::pair("~0", "~")})
    for (auto at = token.find(code); at != std::string::npos; at = token.find(code, at + 1))
      token.replace(at, 2, character);
  return token;
}

template <class T>
void apply_each(const std::map<std::string, std::optional<T>>& changes, std::map<std::string, T>& entries) {
  for (const auto& [name, value] : changes) {
    if (value) entries.insert_or_assign(name, *value);
    else entries.erase(name);
  }
}

template <class T>
void add_one(const std::map<std::string, T>& entries, const std::string& name,
             std::map<std::string, std::optional<T>>& changes) {
  const auto found = entries.find(name);
  changes.insert_or_assign(name, found == entries.end() ? std::nullopt : std::optional<T>(found->second));
}

}  // namespace

std::optional<NumberPointer> NumberPointer::of(const std::string& pointer) {
  if (pointer.empty() || pointer.front() != '/') return std::nullopt;
  std::vector<std::string> tokens;
  for (std::size_t begin = 1; begin <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', begin), pointer.size());
    tokens.push_back(unescaped(pointer.substr(begin, end - begin)));
    begin = end + 1;
  }
  NumberPointer number;
  if (tokens.empty()) return std::nullopt;
  number.section = tokens.front();
  const std::size_t above = SceneDescription::has_names(number.section) ? 2 : 1;
  if (tokens.size() <= above) return std::nullopt;
  if (above == 2) number.name = tokens[1];
  number.keys.assign(tokens.begin() + static_cast<std::ptrdiff_t>(above), tokens.end());
  return number;
}

void SettingsChange::apply_to(SceneDescription& scene) const {
  apply_each(materials, scene.materials);
  for (const auto& [name, value] : interfaces) {
    InterfaceDescription* const known = scene.find_interface(name);
    if (known == nullptr && value) scene.interfaces.push_back(*value);
    else if (known != nullptr && value) *known = *value;
    else std::erase_if(scene.interfaces, [&](const InterfaceDescription& one) { return one.name() == name; });
  }
  apply_each(walls, scene.walls);
  apply_each(engines, scene.engines);
  if (domain) scene.domain = *domain;
  if (time_step) scene.time_step = *time_step;
  if (guards) scene.guards = *guards;
}

SettingsChange SettingsChange::reverse(const SceneDescription& scene) const {
  SettingsChange before;
  for (const auto& [name, value] : materials) before.add(scene, "materials", name);
  for (const auto& [name, value] : interfaces) before.add(scene, "interfaces", name);
  for (const auto& [name, value] : walls) before.add(scene, "walls", name);
  for (const auto& [name, value] : engines) before.add(scene, "engines", name);
  if (domain) before.domain = scene.domain;
  if (time_step) before.time_step = scene.time_step;
  if (guards) before.guards = scene.guards;
  return before;
}

void SettingsChange::add(const SceneDescription& scene, const std::string& section, const std::string& name) {
  if (section == "materials") add_one(scene.materials, name, materials);
  if (section == "interfaces") {
    const auto found = std::ranges::find(scene.interfaces, name, &InterfaceDescription::name);
    interfaces.emplace_back(name, found == scene.interfaces.end() ? std::nullopt : std::optional(*found));
  }
  if (section == "walls") add_one(scene.walls, name, walls);
  if (section == "engines") add_one(scene.engines, name, engines);
  if (section == "domain") domain = scene.domain;
  if (section == "time_step") time_step = scene.time_step;
  if (section == "guards") guards = scene.guards;
}

}  // namespace grit
