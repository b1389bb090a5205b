#include "lint/unused_materials.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "bodies/make_bodies.hpp"
#include "lint/all_stages.hpp"
#include "lint/small_changes.hpp"

namespace grit {
namespace {

/// Materials during a period of the run in which they do not change.
struct Materials {
  SceneDescription scene;  ///< only materials, interfaces, and the materials of bodies and walls
  std::size_t stages = 0;  ///< number of stages that have begun
};

SceneDescription materials_alone(const SceneDescription& now) {
  SceneDescription part(now.registry());
  part.materials = now.materials, part.interfaces = now.interfaces;
  for (const auto& [name, group] : now.bodies)
    part.bodies.try_emplace(name, now.registry()).first->second.material = group.material;
  for (const auto& [name, wall] : now.walls)
    part.walls.try_emplace(name, now.registry()).first->second.material = wall.material;
  return part;
}

std::vector<Materials> all_materials(const Scene& described) {
  std::vector<Materials> all;
  const auto of_walls = [](const SceneDescription& scene) {
    std::vector<std::string> materials;
    for (const auto& [name, wall] : scene.walls) materials.push_back(wall.material);
    return materials;
  };
  through_stages(
      *described.description, described.stages, [&](const SceneDescription& now, std::optional<std::size_t> stage) {
        if (!all.empty()) {
          const SceneDescription& last = all.back().scene;
          if (last.materials == now.materials && last.interfaces == now.interfaces && of_walls(last) == of_walls(now))
            return true;
        }
        all.push_back({materials_alone(now), stage ? *stage + 1 : 0});
        return true;
      });
  return all;
}

/// Appends the parameters of all possible contacts.
void add_mixed(const SceneDescription& scene, MixedLaw& mixed, std::vector<double>& all) {
  mixed.follow(scene);
  const auto names = material_names(scene);
  const auto number = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  std::set<std::size_t> bodies, walls;
  for (const auto& [name, group] : scene.bodies) bodies.insert(number(group.material));
  for (const auto& [name, wall] : scene.walls) walls.insert(number(wall.material));
  for (const std::size_t a : bodies) {
    for (const std::size_t b : bodies) std::ranges::copy(mixed.law().mixed(a, b, false), std::back_inserter(all));
    for (const std::size_t b : walls) std::ranges::copy(mixed.law().mixed(a, b, true), std::back_inserter(all));
  }
}

/// The number of stages begun before which a value keeps its initial value.
std::size_t stages_with(const Scene& described, const std::string& pointer) {
  const auto& stages = described.description->stages;
  const auto sets = [&](const StageDescription& stage) {
    // By a change of it, by null for a parent, or by a ramp.
    for (std::string at = pointer; !at.empty(); at.erase(at.rfind('/')))
      if (const Description::json_pointer parent(at); stage.change.contains(parent))
        if (at == pointer || stage.change.at(parent).is_null()) return true;
    return std::ranges::any_of(stage.ramps, [&](const RampDescription& ramp) { return ramp.pointer == pointer; });
  };
  return static_cast<std::size_t>(std::ranges::find_if(stages, sets) - stages.begin()) + 1;
}

/// The declaration of a law's parameter; null if there is none of this name.
const Parameter* declared(const Parameters& parameters, const std::string& key) {
  const auto found = std::ranges::find(parameters.entries(), key, &Parameter::name);
  return found == parameters.entries().end() ? nullptr : &*found;
}

}  // namespace

std::vector<UnusedSetting> unused_materials(const Scene& scene,
                                            const std::function<bool(const std::string&)>& is_written) {
  const SceneDescription& start = *scene.description;
  std::vector<Materials> all = all_materials(scene);
  MixedLaw mixed(start);
  const auto numbers = [&] {
    std::vector<double> found;
    for (const Materials& one : all) add_mixed(one.scene, mixed, found);
    return found;
  };
  const std::vector<double> now = numbers();
  std::vector<UnusedSetting> unused;

  // `value_in` returns the value in a scene; null if the scene does not have it.
  const auto inspect = [&](const std::string& section, const std::string& name, const std::string& key,
                           const Description& value, const Parameters& parameters, const auto& value_in) {
    const std::string pointer = fmt::format("/{}/{}/{}", section, pointer_token(name), pointer_token(key));
    const Parameter* const parameter = declared(parameters, key);
    if (!value.is_number() || parameter == nullptr || !is_written(pointer)) return;
    const std::size_t lasts = stages_with(scene, pointer);
    const auto same = [&](const std::string& other) {
      const Description tried = Description::parse(other);
      if (!parameter->allows(tried.get<double>())) throw Error("out of range");
      std::vector<std::pair<Description*, Description>> before;
      for (Materials& one : all)
        if (Description* const target = one.stages < lasts ? value_in(one.scene) : nullptr) {
          before.emplace_back(target, *target);
          *target = tried;
        }
      const bool is_same = numbers() == now;
      for (const auto& [target, old] : before) *target = old;
      return is_same;
    };
    if (changes_nothing(value, same))
      unused.push_back(
          {pointer,
           "no contact depends on it: contacts use the value of the other material, of an interface, or none"});
  };
  const auto in = [](Description& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? nullptr : &*found;
  };
  const auto law = start.contacts.make();
  for (const auto& [name, material] : start.materials) {
    Parameters parameters;
    law->declare_material(name, parameters);
    for (const auto& [key, value] : material.values.items())
      inspect("materials", name, key, value, parameters, [&, &name = name, &key = key](SceneDescription& one) {
        const auto found = one.materials.find(name);
        return found == one.materials.end() ? nullptr : in(found->second.values, key);
      });
  }
  for (const InterfaceDescription& interface : start.interfaces) {
    Parameters parameters;
    law->declare_interface(interface.a, interface.b, parameters);
    for (const auto& [key, value] : interface.values.items())
      inspect("interfaces", interface.name(), key, value, parameters, [&, &key = key](SceneDescription& one) {
        InterfaceDescription* const found = one.find_interface(interface.name());
        return found == nullptr ? nullptr : in(found->values, key);
      });
  }
  return unused;
}

}  // namespace grit
